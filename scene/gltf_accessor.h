#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf_json.h"

namespace lobe {

/// Typed reads of a glTF document's accessors, glTF 2.0 section 3.6. Everything is checked against bufferView
/// and buffer before memory is taken for it, as counts and offsets come from outside.
class GltfAccessors {
 public:
  /// `buffers` by index; they and the document outlive this.
  GltfAccessors(const GltfJson& document, std::vector<std::span<const uint8_t>> buffers)
      : document_(document), buffers_(std::move(buffers)) {}

  int Count(int accessor) const;
  std::vector<float> ReadFloats(int accessor, int components, const std::string& what) const;
  std::vector<uint32_t> ReadIndices(int accessor, const std::string& what) const;

 private:
  struct Elements;  // laid out in a buffer view, known to lie inside it

  GltfJson Accessor(int accessor, const std::string& what) const;
  Elements Locate(const GltfJson& owner, size_t count, size_t element_bytes, bool may_stride) const;
  template <typename To>
  std::vector<To> Read(const GltfJson& accessor, int components) const;
  template <typename To>
  void Override(const GltfJson& sparse, size_t component_type, int components, bool normalized,
                std::vector<To>* values) const;

  GltfJson document_;
  std::vector<std::span<const uint8_t>> buffers_;
};

}  // namespace lobe
