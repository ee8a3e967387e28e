#pragma once

#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace lobe {

using Topics = std::vector<std::pair<std::string, std::function<void()>>>;

/// Prints the topic that the only argument names; without one, or another, lists them. Returns the exit code.
inline int PrintTopic(const char* program, const Topics& topics, int argc, char** argv) {
  for (const auto& [name, print] : topics) {
    if (argc == 2 && name == argv[1]) {
      print();
      return 0;
    }
  }
  std::fprintf(stderr, "usage, from the project's root: %s TOPIC, with TOPIC one of", program);
  for (const auto& topic : topics) std::fprintf(stderr, " %s", topic.first.c_str());
  std::fprintf(stderr, "\n");
  return 2;
}

}  // namespace lobe
