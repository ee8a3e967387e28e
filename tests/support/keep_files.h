#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace lobe::test {

/// The Khronos validator is run over what these tests write: tests/gltf-validator.
inline void KeepForValidator(const std::string& path) {
  const char* folder = std::getenv("LOBE_KEEP_FILES");
  if (!folder) return;
  const auto from = std::filesystem::path(path);
  const auto overwrite = std::filesystem::copy_options::overwrite_existing;
  std::filesystem::copy_file(from, folder / from.filename(), overwrite);
  auto binary = from;
  if (from.extension() == ".gltf") {
    binary.replace_extension(".bin");
    std::filesystem::copy_file(binary, folder / binary.filename(), overwrite);
  }
}

}  // namespace lobe::test
