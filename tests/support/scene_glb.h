#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/glb_writer.h"
#include "scene/gltf_output.h"
#include "scene/scene.h"

namespace lobe::test {

/// Writes a scene made in code as a .glb or .gltf: a node, mesh and primitive per surface, a node per camera.
/// Every surface has one material.
inline void WriteSceneGlb(const Scene& scene, const std::string& path) {
  GlbWriter writer;
  nlohmann::json& document = writer.document;
  nlohmann::json nodes = nlohmann::json::array();
  for (const Material& material : scene.materials) {
    document["materials"].push_back(GltfMaterial(material, &writer));
  }

  std::map<uint32_t, std::vector<const Face*>> surfaces;
  for (const Face& face : scene.faces) surfaces[face.surface].push_back(&face);
  for (const auto& [surface, faces] : surfaces) {
    std::vector<float> positions, normals;
    std::vector<uint32_t> indices;
    std::map<uint32_t, uint32_t> numbers;
    for (const Face* face : faces) {
      for (const uint32_t v : face->vertex) {
        const auto [at, is_new] = numbers.try_emplace(v, static_cast<uint32_t>(numbers.size()));
        indices.push_back(at->second);
        if (!is_new) continue;
        positions.insert(positions.end(), scene.positions[v].data(), scene.positions[v].data() + 3);
        normals.insert(normals.end(), scene.normals[v].data(), scene.normals[v].data() + 3);
      }
    }
    const int position = writer.AddFloats(positions, "VEC3", GlbWriter::Target::kVertices, true);
    const int normal = writer.AddFloats(normals, "VEC3", GlbWriter::Target::kVertices);
    const int index = writer.AddUints(indices, GlbWriter::Target::kIndices);
    const nlohmann::json primitive = {{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                                      {"indices", index},
                                      {"material", faces[0]->material}};
    const std::string& name = scene.surface_names[surface];
    nodes.push_back({{"name", name}, {"mesh", document["meshes"].size()}});
    document["meshes"].push_back({{"name", name}, {"primitives", {primitive}}});
  }
  for (const Camera& camera : scene.cameras) {
    nodes.push_back(GltfCameraNode(camera, static_cast<int>(document["cameras"].size())));
    document["cameras"].push_back(GltfCamera(camera, 0.01f));
  }
  std::vector<size_t> roots;
  for (size_t i = 0; i < nodes.size(); ++i) roots.push_back(i);
  document["nodes"] = std::move(nodes);
  document["scenes"] = {{{"nodes", roots}}};
  document["scene"] = 0;
  const nlohmann::json used = ExtensionsUsed(document);
  if (!used.empty()) document["extensionsUsed"] = used;
  writer.Write(path);
}

}  // namespace lobe::test
