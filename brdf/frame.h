#pragma once

#include <cmath>

#include "sh/vector.h"

namespace lobe {

/// Local shading frame: z is the shading normal, x and y follow from z alone, so that any reader of
/// a solution can rebuild it. Branchless construction of Duff et al., "Building an Orthonormal
/// Basis, Revisited", JCGT 6(1), 2017, listing 3. Pinned by FrameTest.
struct Frame {
  Vec3 x, y, z;

  /// `normal` must be of unit length.
  explicit Frame(const Vec3& normal) : z(normal) {
    const float sign = std::copysign(1.0f, z.z());
    const float a = -1.0f / (sign + z.z());
    const float b = z.x() * z.y() * a;
    x = Vec3(1.0f + sign * z.x() * z.x() * a, sign * b, -sign * z.x());
    y = Vec3(b, sign + z.y() * z.y() * a, -z.y());
  }

  Vec3 ToLocal(const Vec3& world) const { return {x.dot(world), y.dot(world), z.dot(world)}; }
  Vec3 ToWorld(const Vec3& local) const { return x * local.x() + y * local.y() + z * local.z(); }
};

/// A local direction below the horizon is bent up to it before a lobe is read: the even basis would
/// mirror it (docs/conventions.md#horizon).
inline Vec3 BendToHorizon(const Vec3& local) {
  if (local.z() >= 0) return local;
  const float s = std::hypot(local.x(), local.y());
  if (s == 0) return {1, 0, 0};
  return {local.x() / s, local.y() / s, 0};
}

}  // namespace lobe
