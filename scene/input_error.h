#pragma once

#include <stdexcept>
#include <string>

namespace lobe {

/// Something from outside is wrong. The message is one sentence naming file, element, value found and
/// value expected; app/ prints it and exits with 1.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace lobe
