#pragma once

#include <array>

#include "sh/vector.h"

namespace lobe {

/// The point of a triangle nearest to a given one: barycentrics (1 - u - v, u, v) and distance, metres.
struct ClosestPoint {
  float u = 0, v = 0, distance = 0;
};

/// Works for triangles of no area too.
ClosestPoint ClosestPointOnTriangle(const Vec3& point, const std::array<Vec3, 3>& corners);

}  // namespace lobe
