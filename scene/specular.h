#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "brdf/reflectance.h"
#include "scene/mirror.h"

namespace lobe {

/// The bodies of glass that a way of light is inside of, innermost last; none: air. Closed surfaces may be
/// nested, and overlap: what was entered last counts.
///
/// Small, to be copied at every fork. Of more than kCapacity nested bodies the outermost are forgotten; they
/// are remembered when their inside is met.
class MediaStack {
 public:
  static constexpr int kCapacity = 7;

  uint32_t top() const { return count_ == 0 ? kNone : material_[count_ - 1]; }  ///< material; kNone: air
  bool Contains(uint32_t material) const;
  void Enter(uint32_t material);
  void Leave(uint32_t material);  ///< the last one of that material; nothing if there is none

 private:
  uint32_t count_ = 0;
  std::array<uint32_t, kCapacity> material_{};
};

/// One way on from a specular surface.
struct SpecularWay {
  Rgb weight =
      Rgb::Zero();  ///< of radiance that comes along it, seen from where the ray came; 0: no such way
  Vec3 direction;   ///< unit
  Vec3 outward;     ///< the face's normal on the side it leaves from: lift the origin along it
  bool open() const { return (weight > 0).any(); }
};

struct SpecularWays {
  SpecularWay reflection, transmission;
  /// Radiance is compressed in the denser medium: (n_here / n_beyond)^2, a factor of transmission.weight.
  /// Power has no such factor, and chances are better off without it.
  float basic = 1;
  bool straight = false;  ///< the transmission goes on as it came, through a pane
  MediaStack beyond;      ///< along the transmission; the reflection keeps the one it came with
};

/// How light goes on at ideal mirrors and glass: the one place that says so, for links, paths and pictures.
/// The rules: docs/conventions.md#glass. Keeps what it needs of the scene; const methods may run in many
/// threads.
///
/// A scene without mirrors and glass costs one byte a material. To follow a ray:
///
///     MediaStack media;
///     RayHit hit = tracer.Intersect(ray);
///     weight *= specular.Transmittance(media, material, hit.side, hit.t);  // if specular.any_body()
///     const SpecularWays ways = specular.Continue(material, hit.side, FindHitPoint(scene, ray, hit), wo,
///     media);
class SpecularSurfaces {
 public:
  explicit SpecularSurfaces(const Scene& scene);

  enum class Kind : uint8_t {
    kNone,    ///< nothing ideal about it
    kMirror,  ///< opaque, roughness below kMirrorRoughness
    kPane,    ///< thin glass: straight on, and both sides alike
    kBody,    ///< surface of solid glass: its back is the inside, and never black
  };
  Kind kind(uint32_t material) const { return kinds_[material]; }
  bool glass(uint32_t material) const { return kinds_[material] >= Kind::kPane; }
  bool any_pane() const { return any_pane_; }
  bool any_body() const { return any_body_; }

  /// At a hit on `side` of a face of `material`, not of kind kNone; `wo` points back along the ray, `media`
  /// are those it came through. The weights sum to at most 1 (but for `basic`); what is missing stays in the
  /// surface: on fronts and on panes its base reflects some of it.
  SpecularWays Continue(uint32_t material, Side side, const HitPoint& at, const Vec3& wo,
                        const MediaStack& media) const;

  /// Of light along a segment of this length that ends on `side` of a face of `material`, or nowhere (kNone).
  /// The end matters: whoever meets the inside of a body has been inside it, whatever `media` knows.
  Rgb Transmittance(const MediaStack& media, uint32_t material, Side side, float metres) const;
  /// The same in a medium given by its material; kNone: air.
  Rgb Transmittance(uint32_t medium, float metres) const;

  /// The first hit of `ray` that is no pane. `passed` is multiplied by what the panes before it let through,
  /// and `ray` becomes its last piece, behind the last of them. After kMostPanes nothing comes through: a
  /// miss, and black.
  RayHit IntersectPastPanes(const RayTracer& tracer, Ray* ray, Rgb* passed) const;
  /// Of light along `ray`, up to its t_max, by panes alone: black if anything else is in its way.
  Rgb SeeThrough(const RayTracer& tracer, const Ray& ray) const;
  static constexpr int kMostPanes = 64;

 private:
  struct Glass {
    MetallicRoughness model;
    Rgb f0, colour, extinction;  // in air; per crossing; per metre
  };
  struct Pane {  // a face
    uint32_t material;
    Vec3 normal;
    std::array<Vec3, 3> corner_normals;
  };
  float Ior(uint32_t medium) const { return medium == kNone ? 1.0f : glass_[medium].model.ior; }

  bool any_pane_ = false, any_body_ = false;
  std::vector<Kind> kinds_;
  std::vector<Glass> glass_;            // by material, mirrors too; empty if there are none
  std::vector<uint32_t> pane_of_face_;  // kNone: not one; empty without panes
  std::vector<Pane> panes_;
};

}  // namespace lobe
