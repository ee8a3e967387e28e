#pragma once

#include <array>

#include "sh/vector.h"

namespace lobe {

float LongestEdgeSquared(const std::array<Vec3, 3>& corners);

/// Light from a triangle of radiance 1 at a point, nothing in between.
struct TriangleLight {
  float irradiance = 0;           ///< W m^-2; pi times the point-to-triangle form factor
  Vec3 direction = Vec3::Zero();  ///< unit, towards the triangle: that of the vector irradiance
};

/// Exact: Lambert's formula over the part of the triangle above the horizon of `normal` (Baum et al.,
/// SIGGRAPH 1989, eq. 10). The triangle's front must face the point (counter-clockwise seen from it);
/// otherwise irradiance is 0. Used where a triangle is near; far ones are points.
TriangleLight ExactTriangleLight(const Vec3& point, const Vec3& normal, const std::array<Vec3, 3>& corners);

/// As a point at the centroid: cos_i cos_o A / r^2. Relative error about (size / distance)^2 / 8.
TriangleLight FarTriangleLight(const Vec3& point, const Vec3& normal, const std::array<Vec3, 3>& corners);

/// Good to 4 % of itself, to decide what is worth cutting: the point form from two edge lengths away, unless
/// the triangle reaches below the horizon.
TriangleLight EstimateTriangleLight(const Vec3& point, const Vec3& normal,
                                    const std::array<Vec3, 3>& corners);

/// The exact form near, the point form far, good to 0.4 % (docs/validation.md#form-factor).
TriangleLight LightOfTriangle(const Vec3& point, const Vec3& normal, const std::array<Vec3, 3>& corners);

}  // namespace lobe
