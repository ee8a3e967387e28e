#pragma once

#include <initializer_list>
#include <string>

#include <gtest/gtest.h>

#include "scene/input_error.h"

namespace lobe::test {

/// Runs `act`, expects an InputError whose message is one line that contains every one of `words`.
template <typename Act>
void ExpectInputError(const Act& act, std::initializer_list<std::string> words) {
  try {
    act();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& word : words) {
      EXPECT_NE(message.find(word), std::string::npos) << "expected '" << word << "' in: " << message;
    }
    return;
  }
  ADD_FAILURE() << "no InputError was thrown";
}

}  // namespace lobe::test
