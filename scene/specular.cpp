#include "scene/specular.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobe {
namespace {

Rgb Schlick(const Rgb& f0, float f90, float cosine) {
  const float x = 1 - cosine, x2 = x * x;
  return f0 + (f90 - f0) * (x2 * x2 * x);
}

SpecularSurfaces::Kind KindOf(const Material& material) {
  if (material.pane()) return SpecularSurfaces::Kind::kPane;
  if (material.body()) return SpecularSurfaces::Kind::kBody;
  const auto* m = std::get_if<MetallicRoughness>(&material.reflectance);
  const bool mirror = m && m->roughness < kMirrorRoughness && ((m->F0() > 0).any() || m->F90() > 0);
  return mirror ? SpecularSurfaces::Kind::kMirror : SpecularSurfaces::Kind::kNone;
}

// Beer and Lambert: exp(-extinction d) is the attenuation colour at its distance.
Rgb Extinction(const MetallicRoughness& m) {
  if (!std::isfinite(m.attenuation_distance)) return Rgb::Zero();
  // Black would be infinite, and no light at no distance undefined.
  return (-m.attenuation_color.log() / m.attenuation_distance)
      .max(0.0f)
      .min(std::numeric_limits<float>::max());
}

// What an interpolated normal would send back to the side it came from is put just beyond the face.
Vec3 ForcedBeyond(const Vec3& direction, const HitPoint& at) {
  const float out = direction.dot(at.geometric_normal);
  if (out < -kLeastLift) return direction.normalized();
  return (direction - (out + kLeastLift) * at.geometric_normal).normalized();
}

}  // namespace

bool MediaStack::Contains(uint32_t material) const {
  return std::find(material_.begin(), material_.begin() + count_, material) != material_.begin() + count_;
}

void MediaStack::Enter(uint32_t material) {
  if (count_ == kCapacity) {
    std::copy(material_.begin() + 1, material_.end(), material_.begin());
    --count_;
  }
  material_[count_++] = material;
}

void MediaStack::Leave(uint32_t material) {
  for (uint32_t i = count_; i-- > 0;) {
    if (material_[i] != material) continue;
    std::copy(material_.begin() + i + 1, material_.begin() + count_, material_.begin() + i);
    --count_;
    return;
  }
}

SpecularSurfaces::SpecularSurfaces(const Scene& scene) {
  for (const Material& m : scene.materials) kinds_.push_back(KindOf(m));
  if (std::all_of(kinds_.begin(), kinds_.end(), [](Kind k) { return k == Kind::kNone; })) return;
  for (const Material& m : scene.materials) {
    glass_.emplace_back();
    if (kinds_[glass_.size() - 1] == Kind::kNone) continue;
    const auto& model = std::get<MetallicRoughness>(m.reflectance);
    glass_.back() = {model, model.F0(), model.GlassColor(), Extinction(model)};
    any_pane_ |= m.pane();
    any_body_ |= m.body();
  }
  if (!any_pane_) return;
  for (const Face& face : scene.faces) {
    pane_of_face_.push_back(kNone);
    if (kinds_[face.material] != Kind::kPane) continue;
    pane_of_face_.back() = uint32_t(panes_.size());
    panes_.push_back(
        {face.material,
         scene.GeometricNormal(face),
         {scene.CornerNormal(face, 0), scene.CornerNormal(face, 1), scene.CornerNormal(face, 2)}});
  }
}

SpecularWays SpecularSurfaces::Continue(uint32_t material, Side side, const HitPoint& at, const Vec3& wo,
                                        const MediaStack& media) const {
  const Glass& glass = glass_[material];
  const float f90 = glass.model.F90();
  const float cosine = std::clamp(wo.dot(at.normal), 0.0f, 1.0f);
  SpecularWays ways;
  ways.reflection.direction = MirrorDirection(wo, at);
  ways.reflection.outward = at.geometric_normal;
  ways.transmission.outward = -at.geometric_normal;
  ways.transmission.direction = -wo;
  ways.beyond = media;
  if (kinds_[material] != Kind::kBody) {
    ways.reflection.weight = Schlick(glass.f0, f90, cosine);
    if (kinds_[material] != Kind::kPane) return ways;
    ways.straight = true;
    ways.transmission.weight = glass.model.UnderCoat(ways.reflection.weight) * glass.colour;
    return ways;
  }

  uint32_t here = media.top();
  if (side == Side::kFront) {
    ways.beyond.Enter(material);
  } else if (media.Contains(material)) {
    ways.beyond.Leave(material);
  } else {
    here = material;  // the way began inside
  }
  const float n_here = Ior(here), n_beyond = Ior(ways.beyond.top());
  if (n_here == n_beyond) {
    // No boundary, so no coat. Schlick's formula would still have all be reflected at grazing.
    ways.transmission.weight = glass.colour;
    ways.transmission.direction = ForcedBeyond(-wo, at);
    return ways;
  }
  const float eta = n_here / n_beyond;
  const float sine2_beyond = eta * eta * (1 - cosine * cosine);
  // An index of 0 stands for infinity: nothing gets in, and nothing that is inside gets out.
  if (!(eta > 0 && sine2_beyond < 1)) {
    ways.reflection.weight = Rgb::Constant(1);
    return ways;
  }
  const float cosine_beyond = std::sqrt(1 - sine2_beyond);
  const float n_outer = side == Side::kFront ? n_here : n_beyond;
  const Rgb f0 = n_outer == 1 ? glass.f0 : glass.model.F0(n_outer);
  ways.reflection.weight = Schlick(f0, f90, eta < 1 ? cosine : cosine_beyond);
  ways.basic = eta * eta;
  ways.transmission.weight = glass.model.UnderCoat(ways.reflection.weight) * glass.colour * ways.basic;
  ways.transmission.direction = ForcedBeyond((eta * cosine - cosine_beyond) * at.normal - eta * wo, at);
  return ways;
}

Rgb SpecularSurfaces::Transmittance(uint32_t medium, float metres) const {
  if (medium == kNone) return Rgb::Constant(1);
  const Rgb& extinction = glass_[medium].extinction;
  // An endless way through clear glass is clear; 0 times infinity is not.
  return (extinction > 0).select((-extinction * metres).exp(), Rgb::Constant(1));
}

Rgb SpecularSurfaces::Transmittance(const MediaStack& media, uint32_t material, Side side,
                                    float metres) const {
  const bool inside = material != kNone && side == Side::kBack && kinds_[material] == Kind::kBody &&
                      !media.Contains(material);
  return Transmittance(inside ? material : media.top(), metres);
}

RayHit SpecularSurfaces::IntersectPastPanes(const RayTracer& tracer, Ray* ray, Rgb* passed) const {
  const Vec3 end = ray->origin + ray->direction * ray->t_max;  // not finite for an endless ray
  const Vec3 unit = ray->direction.normalized();
  for (int panes = 0;; ++panes) {
    const RayHit hit = tracer.Intersect(*ray);
    if (!any_pane_ || !hit.hit() || pane_of_face_[hit.face] == kNone) return hit;
    if (panes == kMostPanes) break;
    const Pane& pane = panes_[pane_of_face_[hit.face]];
    const auto& n = pane.corner_normals;
    const Vec3 normal = ((1 - hit.u - hit.v) * n[0] + hit.u * n[1] + hit.v * n[2]).normalized();
    const float cosine = std::clamp(unit.dot(normal) * (hit.side == Side::kFront ? -1.0f : 1.0f), 0.0f, 1.0f);
    const Glass& glass = glass_[pane.material];
    *passed *= glass.model.UnderCoat(Schlick(glass.f0, glass.model.F90(), cosine)) * glass.colour;
    if ((*passed <= 0).all()) break;
    ray->origin = ray->origin + ray->direction * hit.t +
                  pane.normal * (hit.side == Side::kFront ? -tracer.Lift(hit.face) : tracer.Lift(hit.face));
    // A ray with an end still ends there: it may end just above a face.
    if (std::isfinite(ray->t_max)) {
      ray->direction = end - ray->origin;
      ray->t_max = 1;
    }
  }
  *passed = Rgb::Zero();
  return {};
}

Rgb SpecularSurfaces::SeeThrough(const RayTracer& tracer, const Ray& ray) const {
  if (!any_pane_) return Rgb::Constant(tracer.Occluded(ray) ? 0.0f : 1.0f);
  Rgb passed = Rgb::Constant(1);
  Ray piece = ray;
  if (IntersectPastPanes(tracer, &piece, &passed).hit()) return Rgb::Zero();
  return passed;
}

}  // namespace lobe
