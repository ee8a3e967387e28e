#pragma once

#include "scene/mesh.h"
#include "scene/ray_tracer.h"
#include "scene/scene.h"

namespace lobe {

/// Where a ray met a face, normals on the side that was met.
struct HitPoint {
  Vec3 position;
  Vec3 geometric_normal;
  Vec3 normal;  ///< for shading: interpolated over a curved patch
};

/// From the normals of the scene's file.
HitPoint FindHitPoint(const Scene& scene, const Ray& ray, const RayHit& hit);
/// From those of the mesh's nodes. `where`: mesh.Locate of the hit. Without nodes there the geometric normal
/// is all there is.
HitPoint FindHitPoint(const Scene& scene, const Mesh& mesh, const Ray& ray, const RayHit& hit,
                      const Mesh::Location& where);

/// Mirror image of the unit direction `wo` (away from the surface) about the shading normal, unit. What would
/// point into the surface, which an interpolated normal can do, is lifted just above it.
inline constexpr float kLeastLift = 1e-4f;
Vec3 MirrorDirection(const Vec3& wo, const HitPoint& at);

}  // namespace lobe
