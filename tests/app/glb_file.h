#pragma once

#include <cstdint>
#include <cstring>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/support/scratch_folder.h"

namespace lobe::test {

/// A .glb taken apart and put together again, so that tests can break it. Assumes what the test scenes
/// are: one JSON and one binary chunk.
struct GlbFile {
  nlohmann::json document;
  std::string binary;

  explicit GlbFile(const std::string& path) {
    const std::string bytes = ReadWholeFile(path);
    const uint32_t length = Word(bytes, 12);
    document = nlohmann::json::parse(bytes.substr(20, length));
    binary = bytes.substr(28 + length);
  }

  void Save(const std::string& path) const {
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string bytes = "glTF" + Bytes(2) + Bytes(28 + text.size() + binary.size());
    bytes += Bytes(text.size()) + "JSON" + text + Bytes(binary.size()) + std::string("BIN\0", 4) + binary;
    WriteWholeFile(path, bytes);
  }

  /// Overwrites a float of an accessor.
  void SetFloat(int accessor, size_t index, float value) {
    const auto& a = document["accessors"][accessor];
    const auto& view = document["bufferViews"][a["bufferView"].get<int>()];
    const size_t at = view.value("byteOffset", 0u) + a.value("byteOffset", 0u) + 4 * index;
    std::memcpy(&binary.at(at), &value, 4);
  }

  int PositionAccessor() const {
    return document["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<int>();
  }

  nlohmann::json& Material(const std::string& name) {
    for (auto& m : document["materials"]) {
      if (m.value("name", "") == name) return m;
    }
    throw std::runtime_error("no material " + name);
  }

 private:
  static uint32_t Word(const std::string& bytes, size_t at) {
    uint32_t word;
    std::memcpy(&word, &bytes.at(at), 4);
    return word;
  }
  static std::string Bytes(size_t value) {
    const auto word = static_cast<uint32_t>(value);
    return std::string(reinterpret_cast<const char*>(&word), 4);
  }
};

}  // namespace lobe::test
