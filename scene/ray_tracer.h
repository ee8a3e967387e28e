#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "scene/mesh.h"
#include "scene/scene.h"
#include "sh/lanes.h"

namespace lobe {

struct Ray {
  Vec3 origin;
  float t_min = 0;
  Vec3 direction;  ///< need not be unit; t is in multiples of it
  float t_max;
};

struct RayHit {
  uint32_t face = kNone;  ///< kNone: nothing hit
  float t = 0;
  float u = 0, v = 0;  ///< barycentrics of Face::vertex[1], [2]
  Side side = Side::kFront;
  bool hit() const { return face != kNone; }
};

/// Hits of kLanes rays side by side.
struct PacketHits {
  alignas(64) uint32_t face_side[kLanes];  ///< 2 * face + side, as in Mesh::roots; kNone: nothing hit
  alignas(64) float t[kLanes], u[kLanes], v[kLanes];
  RayHit at(int lane) const {
    if (face_side[lane] == kNone) return {};
    return {face_side[lane] / 2, t[lane], u[lane], v[lane], Side(face_side[lane] % 2)};
  }
};

/// Visibility among the scene's input triangles. The one place that knows Embree. Const methods may
/// run in many threads; results do not depend on how rays are grouped.
///
/// Of faces met at one t the first counts. Where faces repeat each other's three corners, as sheets modelled
/// for both sides do, each winding shows its front; if both are translucent the first shows both its sides.
class RayTracer {
 public:
  explicit RayTracer(const Scene& scene);
  ~RayTracer();
  RayTracer(RayTracer&&) noexcept;

  RayHit Intersect(const Ray& ray) const;
  bool Occluded(const Ray& ray) const;

  /// Many rays at once, in packets. `coherent`: they start or go together (eye rays, rays to one lamp).
  void Intersect(std::span<const Ray> rays, std::span<RayHit> hits, bool coherent) const;
  void Occluded(std::span<const Ray> rays, std::span<uint8_t> occluded, bool coherent) const;

  /// Rays that fan out from one point and are always traced together, as a node's links are; hits.size() of
  /// them, coordinates of the directions apart. Faster, also since which of several faces met at one t is
  /// reported may depend on the other rays of the fan.
  void IntersectFan(const Vec3& origin, const float* x, const float* y, const float* z,
                    std::span<RayHit> hits) const;
  /// The same for kLanes rays; `x`, `y` and `z` are aligned to 64 bytes.
  void IntersectPacket(const Vec3& origin, const float* x, const float* y, const float* z,
                       PacketHits* hits) const;

  /// Distance by which ray origins are lifted off surfaces: a few rounding errors of coordinates this far
  /// from the origin, and no more, so that contacts do not leak. The most that any face needs.
  float epsilon() const { return epsilon_; }
  /// The same for points on one face. Of what is small beside the scene's coordinates a thousandth of its
  /// size will do, as long as that is a few rounding errors of its own: a coin on a plane a million metres
  /// wide must not be read half a metre above itself.
  float Lift(uint32_t face) const { return face_lift_.empty() ? epsilon_ : face_lift_[face]; }
  /// The ray that leaves a point of `face` on the side `outward` points to (unit).
  Ray Leaving(uint32_t face, const Vec3& point, const Vec3& outward, const Vec3& direction) const {
    return {point + outward * Lift(face), 0.0f, direction, std::numeric_limits<float>::infinity()};
  }
  /// The same distance for the point that a ray from `from` is to end just short of: how far the ray misses
  /// it by rounding follows from both.
  float LiftOfEnd(uint32_t face, const Vec3& from) const {
    return face_lift_.empty() ? epsilon_ : std::min(epsilon_, std::max(face_lift_[face], Roundings(from)));
  }
  /// For the nodes of each patch of `mesh`.
  std::vector<float> PatchLifts(const Mesh& mesh) const;

 private:
  // A few rounding errors of a point's coordinates.
  static float Roundings(const Vec3& at) { return kRoundings * std::ldexp(at.cwiseAbs().maxCoeff(), -23); }
  static constexpr float kRoundings = 4;  // see the constructor
  float LiftOf(const Eigen::AlignedBox3f& box) const;

  std::vector<float> face_lift_;  // empty: all epsilon_
  struct Impl;
  std::unique_ptr<Impl> impl_;
  float epsilon_;
};

}  // namespace lobe
