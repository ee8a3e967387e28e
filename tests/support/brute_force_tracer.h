#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "scene/ray_tracer.h"
#include "scene/scene.h"

namespace lobe::test {

/// Every face against every ray, in double: Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle
/// Intersection", J. Graphics Tools 2(1), 1997. The second opinion on RayTracer.
inline RayHit BruteForceIntersect(const Scene& scene, const Ray& ray) {
  RayHit nearest;
  double nearest_t = ray.t_max;
  const Vec3d d = ray.direction.cast<double>();
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    const auto p = scene.Corners(scene.faces[f]);
    const Vec3d p0 = p[0].cast<double>();
    const Vec3d e1 = p[1].cast<double>() - p0, e2 = p[2].cast<double>() - p0;
    const Vec3d q = d.cross(e2);
    const double det = e1.dot(q);  // minus direction times front normal
    if (det == 0) continue;
    const Vec3d s = ray.origin.cast<double>() - p0;
    const double u = s.dot(q) / det;
    const Vec3d r = s.cross(e1);
    const double v = d.dot(r) / det;
    const double t = e2.dot(r) / det;
    if (u < 0 || v < 0 || u + v > 1 || t < ray.t_min || t >= nearest_t) continue;
    nearest_t = t;
    nearest.face = f;
    nearest.t = static_cast<float>(t);
    nearest.u = static_cast<float>(u);
    nearest.v = static_cast<float>(v);
    nearest.side = det > 0 ? Side::kFront : Side::kBack;
  }
  return nearest;
}

}  // namespace lobe::test
