#pragma once

#include <array>
#include <vector>

#include "brdf/frame.h"
#include "brdf/sampling.h"
#include "render/lamps.h"
#include "scene/ray_tracer.h"
#include "scene/scene.h"
#include "scene/specular.h"

namespace lobe {

/// A scene prepared for paths of light: what rays meet, how it scatters, and which points of lamps to aim at.
/// The path tracer and the gathering modes of the renderer walk through here.
///
/// Reflectance lives in the frame of the interpolated normal. Light does not leak through a faceted surface
/// for that: a direction counts only if it is on the same side of the face itself as of the interpolated
/// horizon (a mirror's is pushed up to the face). An eye below that horizon gets the normal turned until it
/// is 0.01 above. Keeps what it needs of the scene. Const methods may run in many threads.
class PathScene {
 public:
  explicit PathScene(const Scene& scene);

  struct Surface {
    ReflectanceSampler sampler;
    Rgb emission;
    bool emits, emits_behind, double_sided;
    SpecularSurfaces::Kind specular;
    float base_mean;  ///< of glass: albedo under the coat, mean of channels
  };

  /// Where a path scatters.
  struct Vertex {
    Vec3 position, normal;  ///< of the face, on the vertex's side
    Frame frame;            ///< about the shading normal
    Vec3 wo_local;
    float lift;  ///< RayTracer::Lift of the face
  };

  /// A way from a vertex to a point of a lamp.
  struct LampSample {
    Rgb value = Rgb::Zero();  ///< f |cos| emission / light_pdf if nothing is in the way; 0: no way
    float light_pdf = 0;  ///< with which the lamp's point was aimed at, per steradian seen from the vertex
    float direction_pdf = 0;  ///< with which `sampler` would have found it
    Ray shadow;               ///< what Visible asks about
  };

  /// A ray that goes on from a vertex.
  struct Scattered {
    Rgb weight = Rgb::Zero();
    float pdf = 0;  ///< of its direction; 0: shadow rays cannot come where it leads (ideal reflection)
    float delta_chance = 0;  ///< of an ideal reflection, with which it was chosen; else 0
    bool alive = false;      ///< false: the path ends here
    Ray ray;
  };

  const RayTracer& tracer() const { return tracer_; }
  const SpecularSurfaces& specular() const { return specular_; }
  const Surface& surface(uint32_t face) const { return surfaces_[faces_[face].material]; }
  const ReflectanceSampler& sampler(uint32_t material) const { return surfaces_[material].sampler; }
  uint32_t material(uint32_t face) const { return faces_[face].material; }
  bool has_lamps() const { return !lamps_.empty(); }
  /// Does this hit see emission?
  bool Emits(const RayHit& hit) const {
    const Surface& s = surface(hit.face);
    return hit.side == Side::kFront ? s.emits : s.emits_behind;
  }
  /// Per steradian seen from `distance` away along unit `wo`, with which shadow rays end on this face; 0
  /// if it is no lamp. `choice`: that of the vertex they start from; null: by power.
  float LightPdf(uint32_t face, const Vec3& wo, float distance, const Lamps::Choice* choice = nullptr) const {
    const FaceShade& f = faces_[face];
    if (f.lamp == kNone) return 0;
    return lamps_.PerArea(f.lamp, choice) * distance * distance / std::abs(f.normal.dot(wo));
  }
  /// About `wo`, unit, pointing back along the ray.
  Vertex VertexAt(const RayHit& hit, const Vec3& wo) const;
  Vec3 FaceNormal(uint32_t face) const { return faces_[face].normal; }
  Vec3 ShadingNormal(const RayHit& hit) const;  ///< on the side that was hit

  Lamps::Choice ChooseLamps(const Vertex& vertex, const ReflectanceSampler& sampler) const {
    return lamps_.ChooseFrom(vertex.position, vertex.frame, vertex.wo_local, sampler);
  }
  /// Aims at a lamp drawn by `bits` (all 64 uniform) and `choice`, or by power, and a point drawn evenly from
  /// it (u, v in [0, 1)).
  LampSample SampleLamp(const Vertex& vertex, const ReflectanceSampler& sampler, uint64_t bits, float u,
                        float v, const Lamps::Choice* choice = nullptr) const;
  /// What comes along a shadow ray through `medium` (a material, or kNone: air): nothing if it is blocked,
  /// else what the medium and panes on the way let through.
  Rgb Visible(const Ray& shadow, uint32_t medium) const {
    Rgb visible = specular_.SeeThrough(tracer_, shadow);
    if (medium != kNone) visible *= specular_.Transmittance(medium, shadow.direction.norm());
    return visible;
  }
  Scattered Scatter(const Vertex& vertex, const ReflectanceSampler& sampler, float u1, float u2,
                    float u3) const;

 private:
  // What shading needs of a face: one cache line.
  struct alignas(64) FaceShade {
    Vec3 corner, edge1, edge2, normal;
    uint32_t material;
    uint32_t lamp = kNone;           // into lamps_
    uint32_t smooth = kNone;         // into corner_normals_; kNone: flat
    bool emits[2] = {false, false};  // by side, if rays can meet that side
  };

  // Materials of the same data share what draws from it.
  ReflectanceSampler SamplerOf(const Scene& scene, uint32_t material) const;

  RayTracer tracer_;
  SpecularSurfaces specular_;
  std::vector<Surface> surfaces_;  // by material
  std::vector<FaceShade> faces_;
  std::vector<std::array<Vec3, 3>> corner_normals_;  // of smooth faces
  Lamps lamps_;
};

/// Power heuristic (Veach and Guibas, "Optimally Combining Sampling Techniques", SIGGRAPH 1995): weight of a
/// sample of density `mine` where `other` could have found it too.
inline float PowerWeight(float mine, float other) {
  const float ratio = other / mine;  // densities squared may overflow, their ratio may not
  return 1 / (1 + ratio * ratio);
}

}  // namespace lobe
