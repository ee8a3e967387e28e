#pragma once

#include "scene/scene.h"
#include "tests/support/metal.h"
#include "tests/support/scene_builder.h"

namespace lobe::test {

/// A lift cabin: four flat walls of polished steel between a matt floor and a matt ceiling with a lamp below
/// it. Light goes between the walls many times.
inline Scene LiftCabin(float albedo, float roughness) {
  SceneBuilder b;
  const uint32_t steel = b.AddMaterial("steel", Metal(roughness, Rgb::Constant(albedo)));
  const Vec3 low(0, 0, 0), high(1.1f, 2.2f, 1.4f);
  const auto wall = [&](Vec3 p, Vec3 q) {  // from p to q along the floor, seen from its left
    b.AddQuad(p, q, {q.x(), high.y(), q.z()}, {p.x(), high.y(), p.z()}, steel);
  };
  wall({0, 0, 0}, {high.x(), 0, 0});
  wall({high.x(), 0, 0}, {high.x(), 0, high.z()});
  wall({high.x(), 0, high.z()}, {0, 0, high.z()});
  wall({0, 0, high.z()}, {0, 0, 0});
  const uint32_t matt = b.AddLambert(Rgb::Constant(0.5f));
  b.AddQuad(low, {0, 0, high.z()}, {high.x(), 0, high.z()}, {high.x(), 0, 0}, matt);
  b.AddQuad({0, high.y(), 0}, {high.x(), high.y(), 0}, high, {0, high.y(), high.z()}, matt);
  b.AddQuad({0.4f, 2.15f, 0.5f}, {0.7f, 2.15f, 0.5f}, {0.7f, 2.15f, 0.9f}, {0.4f, 2.15f, 0.9f},
            b.AddEmitter(Rgb::Constant(8)));
  b.AddCamera("view0", {0.3f, 1.5f, 1.2f}, {0.8f, 1.0f, 0.0f});
  return b.Build();
}

}  // namespace lobe::test
