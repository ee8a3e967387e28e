#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "sh/vector.h"

namespace lobe::test {

/// Irradiance at a point of normal `n` from a polygon of radiance 1 that lies above the point's horizon,
/// corners counter-clockwise seen from its front: Lambert's formula, half the sum over the edges of the angle
/// each is seen under times the cosine between n and the edge plane's normal. Negative from behind.
inline double PolygonIrradiance(const Vec3d& at, const Vec3d& n, const std::vector<Vec3>& corners) {
  double sum = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec3d a = (corners[i].cast<double>() - at).normalized();
    const Vec3d b = (corners[(i + 1) % corners.size()].cast<double>() - at).normalized();
    sum += std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * b.cross(a).normalized().dot(n);
  }
  return 0.5 * sum;
}

}  // namespace lobe::test
