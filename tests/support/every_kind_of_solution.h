#pragma once

#include <limits>
#include <random>
#include <vector>

#include "scene/tessellate.h"
#include "solver/solution.h"
#include "tests/support/scene_builder.h"

namespace lobe::test {

/// Solutions made by hand, never solved: random lobes, and every kind of material and surface.

inline MetallicRoughness Dielectric() {
  MetallicRoughness m;
  m.base_color = Rgb(0.1f, 0.7f, 1.0f / 3);
  m.metallic = 0;
  m.roughness = 0.45f;
  m.ior = 1.33f;
  m.has_specular = true;
  m.specular = 0.7f;
  m.specular_color = Rgb(1, 0.9f, 2.5f);
  return m;
}

/// One material of every model and kind; double-sided, smooth and flat surfaces; awkward numbers.
inline Scene EveryKindOfScene() {
  SceneBuilder b;
  const uint32_t wall = b.AddMaterial("wall", Lambert{Rgb(0.7f, 0.6f, 0.1f)});
  const uint32_t glazed = b.AddMaterial("glazed", Dielectric());
  MetallicRoughness brass;
  brass.base_color = Rgb(0.89f, 0.79f, 0.43f);
  brass.roughness = 0.6f;
  const uint32_t metal = b.AddMaterial("brass", brass, Rgb::Zero(), /*double_sided=*/true);
  const uint32_t phong = b.AddMaterial("phong", Phong{Rgb(0.3f, 0.2f, 0.9f), 17.3f});
  const uint32_t ward = b.AddMaterial("ward", Ward{Rgb(0.3f, 0.2f, 0.9f), 0.17f});
  brass.roughness = 0;
  const uint32_t mirror = b.AddMaterial("mirror", brass);
  const uint32_t lamp = b.AddMaterial("lamp", Lambert{Rgb::Zero()}, Rgb(17.1f, 12.3f, 0.7f));
  const uint32_t glow = b.AddMaterial("glow", Dielectric(), Rgb(0.3f, 0.01f, 0.7f), true);
  MetallicRoughness paper = Dielectric();
  paper.diffuse_transmission = 0.37f;
  paper.diffuse_transmission_color = Rgb(0.9f, 0.65f, 0.31f);
  const uint32_t shade = b.AddMaterial("shade", paper, Rgb::Zero(), true);
  MetallicRoughness bottle;
  bottle.base_color = Rgb(0.1f, 0.7f, 1.0f / 3);
  bottle.metallic = 0;
  bottle.roughness = 0;
  bottle.transmission = 0.83f;
  bottle.thickness = 0.017f;
  bottle.attenuation_color = Rgb(0.1f, 0.3f, 1.0f / 7);
  bottle.attenuation_distance = 0.13f;
  const uint32_t body = b.AddMaterial("bottle", bottle);
  bottle.thickness = 0;
  bottle.attenuation_color = Rgb::Constant(1);
  bottle.attenuation_distance = std::numeric_limits<float>::infinity();
  const uint32_t window = b.AddMaterial("window", bottle, Rgb::Zero(), true);
  b.AddBox({-1, 0, -1}, {1, 2, 1.1f}, wall, /*inward=*/true);
  b.AddSphere({0.1f, 0.5f, 0.2f}, 0.4f, glazed, 6);
  b.AddQuad({-0.5f, 1, -0.5f}, {0.5f, 1.1f, -0.5f}, {0.5f, 1.2f, 0.1f}, {-0.5f, 1.1f, 0.1f}, metal);
  b.AddTriangle({-0.9f, 0.1f, 0}, {-0.8f, 0.9f, 0.3f}, {-0.9f, 0.4f, 0.5f}, phong);
  b.AddTriangle({0.7f, 0.1f, 0}, {0.8f, 0.9f, 0.3f}, {0.9f, 0.4f, 0.5f}, ward);
  b.AddQuad({-0.9f, 0.1f, -0.9f}, {-0.2f, 0.1f, -0.9f}, {-0.2f, 1, -0.9f}, {-0.9f, 1, -0.9f}, mirror);
  b.AddQuad({-0.2f, 1.9f, -0.2f}, {0.2f, 1.9f, -0.2f}, {0.2f, 1.9f, 0.2f}, {-0.2f, 1.9f, 0.2f}, lamp);
  b.AddTriangle({0.6f, 0.3f, -0.8f}, {0.8f, 0.3f, -0.6f}, {0.7f, 0.8f, -0.7f}, glow);
  b.AddTriangle({0.3f, 1.3f, 0.7f}, {0.8f, 1.3f, 0.7f}, {0.5f, 1.7f, 0.8f}, shade);
  b.AddSphere({-0.5f, 1.6f, 0.6f}, 0.2f, body, 5);
  b.AddQuad({0.4f, 0.1f, 0.9f}, {0.9f, 0.1f, 0.9f}, {0.9f, 0.7f, 0.9f}, {0.4f, 0.7f, 0.9f}, window);
  b.AddCamera("view0", {0.3f, 1.1f, 0.9f}, {-0.2f, 0.7f, -0.4f});
  b.AddCamera("view \"ä\"", {-0.7f, 0.3f, 0.8f}, {0.3f, 0.9f, -0.1f}, {0.1f, 1, 0.2f}, 1.234567f);
  Scene scene = b.Build();
  scene.cameras[1].aspect = 16.0f / 9;
  return scene;
}

inline PartDegrees DegreesOf(const Material& material) {
  if (std::holds_alternative<Lambert>(material.reflectance)) return {0, -1};
  if (material.name == "mirror") return {-1, -1};
  if (material.name == "brass" || material.name == "ward") return {-1, 4};
  if (material.name == "phong") return {-1, 1};
  return {2, 3};
}

inline void FillRandomly(NodeLobes* lobes, std::mt19937* random) {
  std::normal_distribution<float> normal(0.2f, 1.0f);
  for (uint32_t p = 0; p < lobes->patch_count(); ++p) {
    for (float& value : lobes->patch_values(p)) value = normal(*random);
    if (lobes->patch_values(p).empty()) continue;
    lobes->patch_values(p).front() = -0.0f;
    lobes->patch_values(p).back() = 1e-42f;  // denormal
  }
}

inline void FillLobes(Solution* s) {
  std::mt19937 random(7);
  std::vector<PartDegrees> degrees;
  for (const Mesh::Patch& patch : s->mesh.patches)
    degrees.push_back(DegreesOf(s->scene.materials[patch.material]));
  s->total = s->direct = s->unshot = NodeLobes(s->mesh, degrees);
  FillRandomly(&s->total, &random);
  FillRandomly(&s->direct, &random);
  FillRandomly(&s->unshot, &random);
  s->hidden.assign(s->mesh.node_count(), 0);
  for (size_t i = 3; i < s->hidden.size() / 2; i += 17) s->hidden[i] = 1;
}

inline Solution MakeSolution(const Scene& scene, const std::vector<bool>& sides = {}) {
  Solution s;
  s.scene = scene;
  s.options.mesh.max_edge = 0.37f;
  s.options.mesh.border_inset = 0.07f;  // not the default
  s.options.lobes.error = 0.1;
  s.options.lobes.force_l_max = 5;
  s.options.light_samples = 33;
  s.options.residual = 1.0 / 3000;
  s.options.max_seconds = 12.25;
  s.options.seed = 0xfedcba9876543210u;
  s.mesh = Tessellate(scene, s.options.mesh, sides);
  FillLobes(&s);
  const GlossKind kinds[] = {GlossKind::kNone, GlossKind::kLobe, GlossKind::kSharp, GlossKind::kMirror};
  for (size_t m = 0; m < scene.materials.size(); ++m) {
    s.material_kinds.push_back(kinds[m % 4]);
    s.material_errors.push_back(0.1 / double(m + 3));
  }
  double watts = 1;
  for (Ledger::Power* p : {&s.ledger.emitted, &s.ledger.sent, &s.ledger.delivered, &s.ledger.absorbed,
                           &s.ledger.reflected, &s.ledger.mirrored, &s.ledger.truncated, &s.ledger.escaped,
                           &s.ledger.blocked, &s.ledger.unshot, &s.ledger.imbalance}) {
    for (double& channel : *p) channel = (watts *= -1.1) / 3;
  }
  s.history = {{0, 1.0, 0.25, 1000, 0}, {1, 1.0 / 7, 0.5, 12'345'678'901, 4'000'000'000u}};
  s.stop_reason = StopReason::kTimeLimit;
  s.solve_seconds = 1.0 / 3;
  return s;
}

inline Solution EveryKindOfSolution() {
  const Scene scene = EveryKindOfScene();
  std::vector<bool> sides(2 * scene.faces.size());
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    sides[2 * f] = f % 7 != 2;  // some fronts that no ray meets
    sides[2 * f + 1] = scene.materials[scene.faces[f].material].double_sided;
  }
  return MakeSolution(scene, sides);
}

}  // namespace lobe::test
