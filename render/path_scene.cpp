#include "render/path_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/repeated_faces.h"

namespace lobe {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kLeastCosine = 0.01f;  // of the eye about an interpolated normal

// Barycentrics of a point drawn evenly from a triangle, by folding the unit square: Heitz, "A Low-Distortion
// Map Between Triangle and Square", 2019.
void FoldSquare(float* u, float* v) {
  if (*v > *u) {
    *u *= 0.5f;
    *v -= *u;
  } else {
    *v *= 0.5f;
    *u -= *v;
  }
}

}  // namespace

ReflectanceSampler PathScene::SamplerOf(const Scene& scene, uint32_t material) const {
  const Reflectance& reflectance = scene.materials[material].reflectance;
  if (const auto* measured = std::get_if<Measured>(&reflectance)) {
    for (uint32_t m = 0; m < material; ++m) {
      const auto* before = std::get_if<Measured>(&scene.materials[m].reflectance);
      if (before && before->data == measured->data) return sampler(m);
    }
  }
  return ReflectanceSampler(reflectance);
}

PathScene::PathScene(const Scene& scene) : tracer_(scene), specular_(scene) {
  for (const Material& m : scene.materials) {
    const auto kind = specular_.kind(uint32_t(surfaces_.size()));
    const auto* glass = m.glass() ? std::get_if<MetallicRoughness>(&m.reflectance) : nullptr;
    const float base_mean =
        glass ? (glass->UnderCoat(glass->F0()) * (glass->DiffuseColor() + glass->TransmissionColor())).mean()
              : 0.0f;
    surfaces_.push_back({SamplerOf(scene, uint32_t(surfaces_.size())), m.emission, m.emits(),
                         m.emits_behind(), m.double_sided, kind, base_mean});
  }

  // Of faces at one place rays meet only some; lamps no ray can meet must not be sampled either.
  const RepeatedFaces repeated = FindRepeatedFaces(scene);
  std::vector<uint8_t> front_met(scene.faces.size(), repeated.twins.empty()), back_met = front_met;
  if (!repeated.twins.empty()) {
    for (const uint32_t f : repeated.kept) {
      front_met[f] = 1;
      const uint32_t twin = repeated.twins[f].face;
      (twin == kNone ? back_met[f] : front_met[twin]) = 1;
    }
  }

  std::vector<Lamps::Face> lamps;
  faces_.reserve(scene.faces.size());
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    const Face& face = scene.faces[f];
    const auto p = scene.Corners(face);
    FaceShade shade;
    shade.corner = p[0];
    shade.edge1 = p[1] - p[0];
    shade.edge2 = p[2] - p[0];
    shade.normal = scene.GeometricNormal(face);
    shade.material = face.material;
    std::array<Vec3, 3> corner_normals;
    bool smooth = false;
    for (int k = 0; k < 3; ++k) {
      corner_normals[k] = scene.CornerNormal(face, k);
      smooth |= (corner_normals[k] - shade.normal).squaredNorm() > 1e-10f;  // files round to float
    }
    if (smooth) {
      shade.smooth = uint32_t(corner_normals_.size());
      corner_normals_.push_back(corner_normals);
    }
    const Surface& surface = surfaces_[face.material];
    const float area = scene.Area(face);
    if (surface.emits && area > 0) {
      shade.emits[0] = front_met[f];
      shade.emits[1] = back_met[f] && surface.emits_behind;
      if (const int sides = shade.emits[0] + shade.emits[1]; sides > 0) {
        shade.lamp = uint32_t(lamps.size());
        lamps.push_back({f,
                         p,
                         shade.normal,
                         {shade.emits[0], shade.emits[1]},
                         area,
                         double(surface.emission.mean()) * area * sides,
                         face.surface});
      }
    }
    faces_.push_back(shade);
  }
  lamps_ = Lamps(std::move(lamps));
}

Vec3 PathScene::ShadingNormal(const RayHit& hit) const {
  const FaceShade& face = faces_[hit.face];
  Vec3 normal = face.normal;
  if (face.smooth != kNone) {
    const auto& n = corner_normals_[face.smooth];
    normal = ((1 - hit.u - hit.v) * n[0] + hit.u * n[1] + hit.v * n[2]).normalized();
  }
  return hit.side == Side::kFront ? normal : Vec3(-normal);
}

PathScene::Vertex PathScene::VertexAt(const RayHit& hit, const Vec3& wo) const {
  const FaceShade& face = faces_[hit.face];
  const Vec3 normal = hit.side == Side::kFront ? face.normal : Vec3(-face.normal);
  const Vec3 position = face.corner + hit.u * face.edge1 + hit.v * face.edge2;
  Vec3 shading_normal = normal;
  if (face.smooth != kNone) {
    shading_normal = ShadingNormal(hit);
    const float cosine = shading_normal.dot(wo);
    if (cosine < kLeastCosine) shading_normal = (shading_normal + (kLeastCosine - cosine) * wo).normalized();
  }
  const Frame frame(shading_normal);
  return {position, normal, frame, frame.ToLocal(wo), tracer_.Lift(hit.face)};
}

PathScene::LampSample PathScene::SampleLamp(const Vertex& vertex, const ReflectanceSampler& sampler,
                                            uint64_t bits, float u, float v,
                                            const Lamps::Choice* choice) const {
  LampSample out;
  const uint32_t chosen = lamps_.Draw(bits, choice);
  const FaceShade& lamp = faces_[lamps_.face(chosen)];
  FoldSquare(&u, &v);
  const Vec3 target = lamp.corner + u * lamp.edge1 + v * lamp.edge2;
  const Vec3 way = target - vertex.position;
  const float distance2 = way.squaredNorm(), towards = -lamp.normal.dot(way);
  if (!(distance2 > 0) || towards == 0 || !lamp.emits[towards < 0]) return out;

  const float distance = std::sqrt(distance2);
  const Vec3 wi = way / distance, wi_local = vertex.frame.ToLocal(wi);
  const float above = wi.dot(vertex.normal);
  if (!(above * wi_local.z() > 0) || (above < 0 && !sampler.transmits())) return out;
  const ReflectanceValue value = sampler.Evaluate(vertex.wo_local, wi_local);
  if (!(value.f > 0).any()) return out;

  const Vec3 from = vertex.position + vertex.normal * std::copysign(vertex.lift, above);
  const Vec3 to = target + lamp.normal * std::copysign(tracer_.LiftOfEnd(lamps_.face(chosen), from), towards);
  out.shadow = {from, 0, to - from, 1};  // Visible takes its length for the way
  out.light_pdf = lamps_.PerArea(chosen, choice) * distance2 * distance / std::abs(towards);
  out.direction_pdf = value.pdf;
  out.value = value.f * surfaces_[lamp.material].emission * (std::abs(wi_local.z()) / out.light_pdf);
  return out;
}

PathScene::Scattered PathScene::Scatter(const Vertex& vertex, const ReflectanceSampler& sampler, float u1,
                                        float u2, float u3) const {
  Scattered out;
  const SampledDirection next = sampler.Sample(vertex.wo_local, u1, u2, u3);
  if (!(next.pdf > 0)) return out;
  Vec3 wi = vertex.frame.ToWorld(next.wi);
  float above = wi.dot(vertex.normal);
  if (next.delta && above < kLeastLift) {
    // The reflection about an interpolated normal points into the face.
    wi = (wi + (kLeastLift - above) * vertex.normal).normalized();
    above = kLeastLift;
  }
  if (!(above * next.wi.z() > 0)) return out;
  out.alive = true;
  out.weight = next.weight;
  (next.delta ? out.delta_chance : out.pdf) = next.pdf;
  out.ray = {vertex.position + vertex.normal * std::copysign(vertex.lift, above), 0, wi, kInfinity};
  return out;
}

}  // namespace lobe
