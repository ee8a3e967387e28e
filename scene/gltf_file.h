#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace lobe {

/// A glTF 2.0 container, .glb or .gltf with its buffers: parsed JSON and typed accessor reads. The one
/// place that knows tinygltf. Says nothing about what the content means (gltf_scene.h,
/// solver/solution_file.h).
class GltfFile {
 public:
  /// Throws InputError with one sentence for anything unreadable: missing, truncated, wrong magic,
  /// malformed JSON, missing buffers, accessors outside their buffers.
  explicit GltfFile(const std::string& path);
  /// The same from what such a file holds; `path` serves messages and finds buffers beside it.
  GltfFile(const std::string& path, std::vector<uint8_t> bytes);
  ~GltfFile();
  GltfFile(GltfFile&&) noexcept;

  const std::string& path() const;
  /// The document's JSON, for materials, extensions and names.
  const nlohmann::json& json() const;

  int AccessorCount(int accessor) const;  ///< number of elements
  /// Any component type; normalised integers become floats, sparse overrides are applied.
  /// `components` per element expected (3 for VEC3); element-major result.
  /// Throws InputError naming `what` when type or range is wrong.
  std::vector<float> ReadFloats(int accessor, int components, const std::string& what) const;
  /// SCALAR of any unsigned integer type.
  std::vector<uint32_t> ReadIndices(int accessor, const std::string& what) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobe
