#include "scene/mirror.h"

namespace lobe {

HitPoint FindHitPoint(const Scene& scene, const Mesh& mesh, const Ray& ray, const RayHit& hit,
                      const Mesh::Location& where) {
  HitPoint out;
  out.position = ray.origin + ray.direction * hit.t;
  out.geometric_normal = scene.GeometricNormal(scene.faces[hit.face]);
  if (hit.side == Side::kBack) out.geometric_normal = -out.geometric_normal;
  out.normal = out.geometric_normal;
  if (where.element == kNone || mesh.patches[mesh.element_patch[where.element]].planar) return out;
  Vec3 n = Vec3::Zero();
  for (int i = 0; i < 3; ++i) n += where.weight[i] * mesh.node_normal[mesh.elements[where.element][i]];
  if (n.squaredNorm() > 0) out.normal = n.normalized();
  return out;
}

Vec3 MirrorDirection(const Vec3& wo, const HitPoint& at) {
  Vec3 reflected = 2.0f * wo.dot(at.normal) * at.normal - wo;
  const float into = reflected.dot(at.geometric_normal);
  if (into <= 0) reflected -= (into - 1e-4f) * at.geometric_normal;
  return reflected.normalized();
}

}  // namespace lobe
