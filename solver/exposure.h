#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/mesh.h"
#include "scene/ray_tracer.h"
#include "scene/scene.h"

namespace lobe {

/// Which sides of which faces light can reach: 2 * face + side. Found by random walks from the emitters,
/// in rounds until a round reaches nothing new, per connected piece of a surface; then by rays aimed at what
/// walks have not met. Walks go on through what transmits, and of that both sides are lit if either is.
/// A side that no light meets gets no nodes and costs nothing (inside a closed box, say).
/// Throws InputError if nothing emits.
std::vector<bool> FindLitSides(const Scene& scene, const RayTracer& tracer, uint64_t seed);

/// What the nodes see around them, from kProbes cosine-distributed rays each.
struct Exposure {
  static constexpr int kProbes = 64;

  /// Nodes most of whose rays meet a black back or an unlit side: they are inside something.
  std::vector<uint8_t> hidden;

  /// Rays whose light reaches no node. Ledger only.
  struct LostRay {
    Vec3 direction_local;
    bool escaped;  ///< left the scene; else blocked
  };
  std::vector<uint32_t> lost_begin;  ///< per node, into `lost`; one more at the end
  std::vector<LostRay> lost;

  /// The same for emission, as fractions of each channel's emitted power.
  Eigen::Array3d emission_escaped = Eigen::Array3d::Zero(), emission_blocked = Eigen::Array3d::Zero();
  uint64_t rays = 0;
};
Exposure FindExposure(const Scene& scene, const Mesh& mesh, const RayTracer& tracer, uint64_t seed);

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
