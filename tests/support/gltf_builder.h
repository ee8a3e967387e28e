#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/glb_writer.h"
#include "tests/support/scratch_folder.h"

namespace lobe::test {

/// glTF files made piece by piece, for tests of the reader: everything may be bent through `document()`.
/// (Whole scenes: scene_glb.h.)
class GltfBuilder {
 public:
  GlbWriter writer;
  nlohmann::json& document() { return writer.document; }

  int Floats(const std::vector<float>& values, const std::string& type) {
    return writer.AddFloats(values, type, GlbWriter::Target::kVertices, type == "VEC3");
  }
  int Uints(const std::vector<uint32_t>& values) {
    return writer.AddUints(values, GlbWriter::Target::kIndices);
  }
  /// Raw bytes read as elements of another component type.
  int Packed(const std::vector<uint8_t>& bytes, int component_type, const std::string& type, int count,
             bool normalized = false) {
    const int accessor = writer.AddBytes(bytes);
    nlohmann::json& json = document()["accessors"][accessor];
    json["componentType"] = component_type;
    json["type"] = type;
    json["count"] = count;
    if (normalized) json["normalized"] = true;
    return accessor;
  }

  /// A mesh of one primitive; returns its index.
  int Mesh(nlohmann::json primitive, const std::string& name = "mesh") {
    document()["meshes"].push_back({{"name", name}, {"primitives", {std::move(primitive)}}});
    return static_cast<int>(document()["meshes"].size() - 1);
  }
  /// A right triangle (0,0,0), (1,0,0), (0,1,0) without normals.
  int TriangleMesh() {
    return Mesh({{"attributes", {{"POSITION", Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")}}}});
  }
  /// A node in the scene; returns its index.
  int Node(nlohmann::json node) {
    document()["nodes"].push_back(std::move(node));
    const int index = static_cast<int>(document()["nodes"].size() - 1);
    document()["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  /// Path of the written file, in a folder that lives as long as this.
  std::string Write(const std::string& name = "test.glb") {
    writer.Write(folder_.File(name));
    return folder_.File(name);
  }
  const ScratchFolder& folder() const { return folder_; }

 private:
  ScratchFolder folder_;
};

}  // namespace lobe::test
