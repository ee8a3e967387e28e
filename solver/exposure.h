#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "brdf/material_lobes.h"
#include "scene/mesh.h"
#include "scene/ray_tracer.h"
#include "scene/scene.h"

namespace lobe {

/// Which sides of which faces light can reach: 2 * face + side. Found by random walks from the emitters,
/// in rounds until a round reaches nothing new, per connected piece of a surface; then by rays aimed at what
/// walks have not met. Walks go on through what transmits, and of that both sides are lit if either is. Of
/// glass only sides that have light to store count: with a base under the coat, or emitting.
/// A side that no light meets gets no nodes and costs nothing (inside a closed box, say).
/// Throws InputError if nothing emits. `poll` is called from time to time, by any thread, and may throw to
/// end it.
std::vector<bool> FindLitSides(const Scene& scene, const RayTracer& tracer, uint64_t seed,
                               const std::function<void()>& poll = {});

/// Emitted light that reaches no node, as fractions of each channel's emitted power; for the ledger. With
/// `mirrors` (per material: an ideal mirror that light goes on from) what is lost behind mirrors counts too,
/// and with `through_glass` what is lost behind glass; else light passes panes alone, straight.
struct EmissionLoss {
  Eigen::Array3d escaped = Eigen::Array3d::Zero(), blocked = Eigen::Array3d::Zero();
  Eigen::Array3d in_glass = Eigen::Array3d::Zero();  ///< absorbed where no node of the glass counts it
};
EmissionLoss FindEmissionLoss(const Scene& scene, const Mesh& mesh, const RayTracer& tracer,
                              const std::vector<const MaterialLobes*>& mirrors, uint64_t seed,
                              bool through_glass = true);

/// One emitting side of an input face.
struct Emitter {
  uint32_t face;
  Side side;
  std::array<Vec3, 3> corners;  ///< counter-clockwise seen from the emitting side
  Vec3 normal;                  ///< on that side
  float area;
  Rgb radiance;
};
std::vector<Emitter> FindEmitters(const Scene& scene);

}  // namespace lobe
