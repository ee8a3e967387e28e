#include "scene/mirror.h"

namespace lobe {

namespace {

HitPoint FlatHitPoint(const Scene& scene, const Ray& ray, const RayHit& hit) {
  HitPoint out;
  out.position = ray.origin + ray.direction * hit.t;
  out.geometric_normal = scene.GeometricNormal(scene.faces[hit.face]);
  if (hit.side == Side::kBack) out.geometric_normal = -out.geometric_normal;
  out.normal = out.geometric_normal;
  return out;
}

}  // namespace

HitPoint FindHitPoint(const Scene& scene, const Ray& ray, const RayHit& hit) {
  HitPoint out = FlatHitPoint(scene, ray, hit);
  const Face& face = scene.faces[hit.face];
  const Vec3 normal = (1 - hit.u - hit.v) * scene.CornerNormal(face, 0) +
                      hit.u * scene.CornerNormal(face, 1) + hit.v * scene.CornerNormal(face, 2);
  if (normal.squaredNorm() > 0) out.normal = normal.normalized() * (hit.side == Side::kFront ? 1.0f : -1.0f);
  return out;
}

HitPoint FindHitPoint(const Scene& scene, const Mesh& mesh, const Ray& ray, const RayHit& hit,
                      const Mesh::Location& where) {
  HitPoint out = FlatHitPoint(scene, ray, hit);
  if (where.element == kNone || mesh.patches[mesh.element_patch[where.element]].planar) return out;
  Vec3 n = Vec3::Zero();
  for (int i = 0; i < 3; ++i) n += where.weight[i] * mesh.node_normal[mesh.elements[where.element][i]];
  if (n.squaredNorm() > 0) out.normal = n.normalized();
  return out;
}

Vec3 MirrorDirection(const Vec3& wo, const HitPoint& at) {
  Vec3 reflected = 2.0f * wo.dot(at.normal) * at.normal - wo;
  const float into = reflected.dot(at.geometric_normal);
  if (into <= 0) reflected -= (into - kLeastLift) * at.geometric_normal;
  return reflected.normalized();
}

}  // namespace lobe
