#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sh/vector.h"

namespace lobe {

/// Of two numbers spread evenly over [0, 1): a direction about z, with density cos / pi.
inline Vec3 CosineDirection(float u, float v) {
  const float r = std::sqrt(u), phi = 2.0f * std::numbers::pi_v<float> * v;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1.0f - u))};
}

/// A point of a triangle, evenly.
inline Vec3 PointOnTriangle(const std::array<Vec3, 3>& p, float u, float v) {
  const float s = std::sqrt(u);
  return p[0] * (1 - s) + p[1] * (s * (1 - v)) + p[2] * (s * v);
}

}  // namespace lobe
