#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/glb_writer.h"
#include "scene/scene.h"

namespace lobe::test {

inline nlohmann::json ToJson(const Rgb& c) { return {c[0], c[1], c[2]}; }

inline nlohmann::json MaterialJson(const Material& material) {
  nlohmann::json json = {{"name", material.name}, {"doubleSided", material.double_sided}};
  const float strength = material.emission.maxCoeff();
  if (strength > 0) {
    json["emissiveFactor"] = ToJson(material.emission / strength);
    json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
  }
  nlohmann::json brdf;
  if (const auto* m = std::get_if<MetallicRoughness>(&material.reflectance)) {
    json["pbrMetallicRoughness"] = {
        {"baseColorFactor", {m->base_color[0], m->base_color[1], m->base_color[2], 1}},
        {"metallicFactor", m->metallic},
        {"roughnessFactor", m->roughness}};
    json["extensions"]["KHR_materials_ior"]["ior"] = m->ior;
    if (m->has_specular) {
      json["extensions"]["KHR_materials_specular"] = {{"specularFactor", m->specular},
                                                      {"specularColorFactor", ToJson(m->specular_color)}};
    }
  } else if (const auto* lambert = std::get_if<Lambert>(&material.reflectance)) {
    brdf = {{"model", "lambert"}, {"albedo", ToJson(lambert->albedo)}};
  } else if (const auto* phong = std::get_if<Phong>(&material.reflectance)) {
    brdf = {{"model", "phong"}, {"albedo", ToJson(phong->albedo)}, {"exponent", phong->exponent}};
  } else if (const auto* ward = std::get_if<Ward>(&material.reflectance)) {
    brdf = {{"model", "ward"}, {"albedo", ToJson(ward->albedo)}, {"alpha", ward->alpha}};
  }
  if (!brdf.is_null()) json["extensions"]["LOBE_materials_brdf"] = brdf;
  return json;
}

/// Writes a scene made in code as a .glb or .gltf: a node, mesh and primitive per surface, a node per camera.
/// Every surface has one material.
inline void WriteSceneGlb(const Scene& scene, const std::string& path) {
  GlbWriter writer;
  nlohmann::json& document = writer.document;
  nlohmann::json nodes = nlohmann::json::array();
  for (const Material& material : scene.materials) document["materials"].push_back(MaterialJson(material));

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
  for (const Camera& c : scene.cameras) {
    nodes.push_back({{"name", c.name},
                     {"camera", document["cameras"].size()},
                     {"matrix", {c.right.x(), c.right.y(), c.right.z(), 0, c.up.x(), c.up.y(), c.up.z(), 0,
                                 c.back.x(), c.back.y(), c.back.z(), 0, c.eye.x(), c.eye.y(), c.eye.z(), 1}}});
    document["cameras"].push_back(
        {{"name", c.name},
         {"type", "perspective"},
         {"perspective", {{"yfov", c.fov_y}, {"aspectRatio", c.aspect}, {"znear", 0.01}}}});
  }
  std::vector<size_t> roots;
  for (size_t i = 0; i < nodes.size(); ++i) roots.push_back(i);
  document["nodes"] = std::move(nodes);
  document["scenes"] = {{{"nodes", roots}}};
  document["scene"] = 0;
  writer.Write(path);
}

}  // namespace lobe::test
