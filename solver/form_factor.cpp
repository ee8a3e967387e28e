#include "solver/form_factor.h"

#include <algorithm>
#include <cmath>

namespace lobe {
namespace {

// Beyond this many edge lengths a triangle is a point to 0.4 % (docs/validation.md#form-factor).
constexpr float kFar = 6.0f;

// And to 4 % beyond this many.
constexpr float kFarEnough = 2.0f;

}  // namespace

float LongestEdgeSquared(const std::array<Vec3, 3>& p) {
  return std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
}

TriangleLight ExactTriangleLight(const Vec3& point, const Vec3& normal, const std::array<Vec3, 3>& corners) {
  // Clip to the horizon: at most four corners remain.
  Vec3 polygon[4];
  int count = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 a = corners[i] - point, b = corners[(i + 1) % 3] - point;
    const float ha = a.dot(normal), hb = b.dot(normal);
    if (ha > 0) polygon[count++] = a;
    if ((ha > 0) != (hb > 0)) {
      polygon[count++] = a + (b - a) * (ha / (ha - hb));
    }
  }
  if (count < 3) return {};
  // Vector irradiance: half the sum of edge angles times edge-plane normals.
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < count; ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % count];
    const Vec3 cross = a.cross(b);
    const float length = cross.norm();
    if (length <= 0) continue;
    sum += cross * (std::atan2(length, a.dot(b)) / length);
  }
  // Counter-clockwise seen from the point means this sum points away from the triangle.
  const Vec3 vector = -0.5f * sum;
  const float irradiance = vector.dot(normal);
  const float norm = vector.norm();
  if (!(irradiance > 0) || !(norm > 0)) return {};
  return {irradiance, vector / norm};
}

TriangleLight FarTriangleLight(const Vec3& point, const Vec3& normal, const std::array<Vec3, 3>& corners) {
  const Vec3 to = (corners[0] + corners[1] + corners[2]) * (1.0f / 3.0f) - point;
  const Vec3 area_normal = 0.5f * (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const float r2 = to.squaredNorm();
  const float cos_i = to.dot(normal), cos_o_area = -to.dot(area_normal);
  if (!(r2 > 0) || cos_i <= 0 || cos_o_area <= 0) return {};
  return {cos_i * cos_o_area / (r2 * r2), to / std::sqrt(r2)};
}

TriangleLight EstimateTriangleLight(const Vec3& point, const Vec3& normal,
                                    const std::array<Vec3, 3>& corners) {
  const Vec3 to = (corners[0] + corners[1] + corners[2]) * (1.0f / 3.0f) - point;
  const bool above = (corners[0] - point).dot(normal) > 0 && (corners[1] - point).dot(normal) > 0 &&
                     (corners[2] - point).dot(normal) > 0;
  if (above && to.squaredNorm() > kFarEnough * kFarEnough * LongestEdgeSquared(corners)) {
    return FarTriangleLight(point, normal, corners);
  }
  return ExactTriangleLight(point, normal, corners);
}

TriangleLight LightOfTriangle(const Vec3& point, const Vec3& normal, const std::array<Vec3, 3>& corners) {
  const Vec3 to = (corners[0] + corners[1] + corners[2]) * (1.0f / 3.0f) - point;
  if (to.squaredNorm() > kFar * kFar * LongestEdgeSquared(corners)) {
    return FarTriangleLight(point, normal, corners);
  }
  return ExactTriangleLight(point, normal, corners);
}

}  // namespace lobe
