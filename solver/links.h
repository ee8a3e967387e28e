#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "brdf/material_lobes.h"
#include "scene/mesh.h"
#include "scene/ray_tracer.h"
#include "scene/scene.h"
#include "solver/link_pattern.h"
#include "solver/planar_mirrors.h"

namespace lobe {

/// What each node sees: for every direction of its pattern, the node whose light arrives from there. Traced
/// once and used in every sweep (Buckalew and Fussell, "Illumination networks", SIGGRAPH 1989, link parallel
/// rays in the same spirit).
///
/// A link takes 4 bytes: it ends in *one* node of the element it hits, chosen with the probabilities of their
/// hat functions, so that light read through it is on average the interpolated light at the hit. What this
/// adds in noise is small against that of sampling the hemisphere (docs/validation.md#links).
///
/// Links follow ideal mirrors and glass (scene/specular.h): a link that meets one is a chain of hops. Where
/// glass reflects and transmits, both ways are followed as long as they carry much, and the hops of all
/// branches lie one after another; else one way is chosen at random, with a weight that makes up for the
/// other.
class Links {
 public:
  /// Values of a link that ends in no node.
  static constexpr uint32_t kEscaped = 0xffffffffu;  ///< leaves the scene
  static constexpr uint32_t kBlocked = 0xfffffffeu;  ///< black back, or a side without nodes
  /// Of hops alone: their throughput is what glass on the way has absorbed, where no node of it counts that.
  static constexpr uint32_t kAbsorbed = 0xfffffffdu;
  /// Leaves below the node's own facet, above its shading horizon: no light arrives from there
  /// (docs/conventions.md#horizon).
  static constexpr uint32_t kBelow = 0xfffffffcu;
  /// This bit marks the index of a chain's first hop instead of a node.
  static constexpr uint32_t kChain = 0x80000000u;
  static bool IsNode(uint32_t link) { return link < kChain; }
  static bool IsLost(uint32_t link) { return link >= kBelow; }
  static bool IsChain(uint32_t link) { return link >= kChain && link < kBelow; }

  /// One surface on a link's way by mirrors and glass. What arrives through the link is the sum over its hops
  /// of throughput x radiance of `node` towards `wo`. At lost ends the throughput is of power, without the
  /// square of the index that radiance in glass has.
  struct Hop {
    uint32_t node;          ///< or kEscaped, kBlocked, kAbsorbed
    uint32_t direction;     ///< packed wo, from this surface back along the way (UnpackDirection)
    uint16_t fresnel[3];    ///< what the surfaces so far pass on, in 2^scale / 65535
    uint16_t last : 1;      ///< ends the chain
    uint16_t end : 1;       ///< ends a branch of it
    uint16_t emission : 1;  ///< the surface's own emission is read too: nothing else carries it here
    uint16_t cut : 1;       ///< a mirror beyond kMaxMirrors, glass beyond kMaxGlass: what it sends on is lost
    uint16_t scale : 4;     ///< 0 but where radiance grows: on its way out of glass, or by a random choice
    Rgb Throughput() const {
      return Rgb(float(fresnel[0]), float(fresnel[1]), float(fresnel[2])) / 65535.0f * float(1 << scale);
    }
    void SetThroughput(const Rgb& throughput);  ///< up to 32768; more is cut
  };
  static_assert(sizeof(Hop) == 16);

  /// Mirrors a link follows at most. A room of mirrors of reflectance 0.9 loses 0.9^16 = 19 % of what keeps
  /// between them; the ledger says how much it was.
  static constexpr int kMaxMirrors = 16;
  /// Surfaces of glass a branch meets at most: what is reflected totally loses nothing there.
  static constexpr int kMaxGlass = 64;
  /// Glass splits a link if both ways carry at least this share of it, so into 33 branches at most. Just
  /// below the 4 % that glass reflects at normal incidence: a lamp in a window then is seen dimly by many
  /// links instead of in full by few. At 0.1 its noise was four times as large (GlassClassTest.LSDE_...).
  static constexpr float kSplit = 0.03f;

  /// Fewer links than this for each coefficient of a glossy node's lobe, and noise shows as blotches
  /// (docs/validation.md#links).
  static constexpr int kPerCoefficient = 8;

  /// Shooting needs links only to see which nodes are hidden and where light is lost: so many.
  static constexpr int kProbes = 64;

  struct Options {
    int links =
        1024;  ///< per diffuse node; glossy ones take kPerCoefficient for each coefficient if that is more
    bool follow_mirrors = true;  ///< and glass; else links pass panes alone, as shadow rays do
    uint64_t seed = 1;
    /// By way of these shooting brings light of small emitters: links leave that out.
    std::vector<PlanarMirror> planar_mirrors = {};
  };

  /// Traces all links. `stop` is asked from time to time; if it says so, the object is useless (stopped()).
  Links(const Scene& scene, const Mesh& mesh, const RayTracer& tracer,
        const std::vector<MaterialLobes>& materials, const Options& options,
        const std::function<bool(double fraction)>& stop = {});

  bool stopped() const { return stopped_; }
  /// Nodes more than half of whose links above their facets are blocked: they are inside something. Have no
  /// weight.
  const std::vector<uint8_t>& hidden() const { return hidden_; }
  const LinkPattern& pattern(uint32_t patch) const { return patches_[patch].pattern; }
  uint64_t seed() const { return options_.seed; }
  std::span<const uint32_t> of(uint32_t node) const {
    const Patch& p = patches_[node_patch_[node]];
    return {targets_.data() + p.begin + size_t(node - p.node_begin) * p.pattern.count(),
            size_t(p.pattern.count())};
  }
  const Hop* chain(uint32_t link) const { return hops_.data() + (link & ~kChain); }
  uint64_t rays() const { return rays_; }
  size_t count() const { return targets_.size(); }
  size_t bytes() const { return targets_.size() * sizeof(uint32_t) + hops_.size() * sizeof(Hop); }
  static LinkPattern PatternOf(const MaterialLobes& material, int links);

 private:
  struct Patch {
    LinkPattern pattern;
    size_t begin;
    uint32_t node_begin;
  };
  struct Tracing;

  void Resolve(const Mesh& mesh);

  Options options_;
  bool stopped_ = false;
  std::vector<Patch> patches_;
  std::span<const uint32_t> node_patch_;
  std::vector<uint32_t> targets_;
  std::vector<Hop> hops_;
  std::vector<uint8_t> hidden_;
  uint64_t rays_ = 0;
};

/// Unit vector in 32 bits, octahedral (Cigolle et al., JCGT 3(2), 2014): off by at most 6.5e-5 radians, in
/// the middle of an octant: half a step in x and in y moves a point of the face by sqrt(3/2) steps of 1 /
/// 32767.5, and the sphere is sqrt(3) times as far.
uint32_t PackDirection(const Vec3& direction);
Vec3 UnpackDirection(uint32_t packed);

}  // namespace lobe
