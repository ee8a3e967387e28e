#include "scene/closest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace lobe {

ClosestPoint ClosestPointOnTriangle(const Vec3& point, const std::array<Vec3, 3>& corners) {
  const Vec3d p = point.cast<double>();
  const Vec3d a = corners[0].cast<double>();
  const Vec3d ab = corners[1].cast<double>() - a, ac = corners[2].cast<double>() - a;

  // The foot of the perpendicular, if it is inside; areas of the subtriangles over the whole.
  const Vec3d normal = ab.cross(ac);
  const double area2 = normal.squaredNorm();
  if (area2 > 0) {
    const double u = (p - a).cross(ac).dot(normal) / area2, v = ab.cross(p - a).dot(normal) / area2;
    if (u >= 0 && v >= 0 && u + v <= 1) {
      return {float(u), float(v), float(std::abs((p - a).dot(normal)) / std::sqrt(area2))};
    }
  }
  // Otherwise it is on an edge. Ends of the edges as (u, v).
  const Eigen::Vector2d ends[3] = {{0, 0}, {1, 0}, {0, 1}};
  double nearest = std::numeric_limits<double>::infinity();
  ClosestPoint best;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d from = ends[i], step = ends[(i + 1) % 3] - from;
    const Vec3d start = a + from.x() * ab + from.y() * ac, edge = step.x() * ab + step.y() * ac;
    const double length2 = edge.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - start).dot(edge) / length2, 0.0, 1.0) : 0.0;
    const double distance = (p - start - t * edge).norm();
    if (distance < nearest) {
      nearest = distance;
      const Eigen::Vector2d at = from + t * step;
      best = {float(at.x()), float(at.y()), float(distance)};
    }
  }
  return best;
}

}  // namespace lobe
