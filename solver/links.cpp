#include "solver/links.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "brdf/frame.h"
#include "scene/element_locator.h"
#include "scene/specular.h"
#include "solver/hash.h"

namespace lobe {
namespace {

constexpr uint32_t kBlockOfNodes = 64;

// Flat shading to rounding: normals that differ by less than 0.26 degrees.
constexpr float kLean = 1e-5f;

// An order of the element's three corners, in which each corner comes with the probability of its weight
// among those not yet taken. The first that is not hidden then has the probability of its renormalised
// weight, whichever are hidden; and that is known only after all links are traced.
constexpr uint8_t kOrder[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
uint32_t DrawOrder(const float w[3], float u) {
  const uint32_t first = uint32_t(u >= w[0]) + uint32_t(u >= w[0] + w[1]);
  // What is left of u, uniform again over w[first], chooses the second: without a branch, since it is a toss.
  const float below = first == 0 ? 0.0f : first == 1 ? w[0] : w[0] + w[1];
  const float a = first == 0 ? w[1] : w[0], b = first == 2 ? w[1] : w[2];
  return 2 * first + uint32_t((u - below) * (a + b) >= a * w[first]);
}

}  // namespace

uint32_t PackDirection(const Vec3& direction) {
  const Vec3 d = direction / direction.cwiseAbs().sum();
  float x = d.x(), y = d.y();
  if (d.z() < 0) {
    x = std::copysign(1 - std::abs(d.y()), d.x());
    y = std::copysign(1 - std::abs(d.x()), d.y());
  }
  const auto quantize = [](float v) {
    return uint32_t(std::lround((std::clamp(v, -1.0f, 1.0f) + 1) * 32767.5f));
  };
  return quantize(x) | quantize(y) << 16;
}

Vec3 UnpackDirection(uint32_t packed) {
  float x = float(packed & 0xffff) / 32767.5f - 1, y = float(packed >> 16) / 32767.5f - 1;
  const float z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) {
    const float t = x;
    x = std::copysign(1 - std::abs(y), t);
    y = std::copysign(1 - std::abs(t), y);
  }
  return Vec3(x, y, z).normalized();
}

void Links::Hop::SetThroughput(const Rgb& throughput) {
  float unit = 1;
  for (scale = 0; throughput.maxCoeff() > unit && scale < 15; ++scale) unit *= 2;
  for (int c = 0; c < 3; ++c) {
    fresnel[c] = uint16_t(std::lround(std::clamp(throughput[c] / unit, 0.0f, 1.0f) * 65535));
  }
}

// What the threads share while tracing, and each one's scratch.
struct Links::Tracing {
  const Scene& scene;
  const Mesh& mesh;
  const ElementLocator locator;
  const RayTracer& tracer;
  const std::vector<MaterialLobes>& materials;
  const Options& options;
  const std::vector<float> lifts = tracer.PatchLifts(mesh);
  const SpecularSurfaces specular{scene};
  std::vector<uint8_t> mirror = {};       // per material: links go on there, being opaque
  std::vector<uint8_t> specular_at = {};  // per material: mirror or glass
  bool any_specular = false;

  // A way still to be followed.
  struct Branch {
    Ray ray;
    RayHit hit;
    Rgb throughput = Rgb::Constant(1);  // of radiance
    float basic = 1;                    // of it, the square of the indices' ratio
    float share = 1;                    // of the link's power, as if choices were splits
    MediaStack media = {};
    int mirrors = 0, glass = 0;
    uint32_t last_mirror = kNone;  // patch
    bool bent = false;             // no shadow ray comes this way: reflected by glass, or refracted
    Rgb Power() const { return throughput / basic; }
  };

  struct Scratch {
    std::vector<Branch> branches;
    std::vector<float> x, y, z;  // directions
    std::vector<RayHit> hits;
    std::vector<Mesh::Location> where;
    DirectionsByPattern directions;
    uint64_t traced = 0;
  };

  // 6 * element + order, or a lost link.
  uint32_t End(const Mesh::Location& where, RandomStream& random) const {
    if (where.element == kNone) return kBlocked;
    return 6 * where.element + DrawOrder(where.weight, random.Next());
  }

  bool ShotByMirror(uint32_t patch, const Face& emitter) const {
    return std::any_of(
        options.planar_mirrors.begin(), options.planar_mirrors.end(),
        [&](const PlanarMirror& m) { return m.patch == patch && scene.Area(emitter) < m.largest_emitter; });
  }

  void TraceNode(uint32_t node, const LinkPattern& pattern, Scratch& scratch, std::span<uint32_t> out,
                 std::vector<Hop>& hops) const {
    LinkDirections& directions = scratch.directions.Of(pattern);
    directions.Start(node, options.seed);
    const Frame frame(mesh.node_normal[node]);
    const Vec3& outward = mesh.node_sample_normal[node];
    const Vec3 origin = mesh.node_sample_position[node] + outward * lifts[mesh.node_patch[node]];
    const size_t count = size_t(pattern.count());
    for (auto* v : {&scratch.x, &scratch.y, &scratch.z}) v->resize(count);
    scratch.hits.resize(count);
    scratch.where.resize(count);
    directions.World(frame, scratch.x.data(), scratch.y.data(), scratch.z.data());
    tracer.IntersectFan(origin, scratch.x.data(), scratch.y.data(), scratch.z.data(), scratch.hits);
    locator.Locate(scratch.hits, scratch.where);
    scratch.traced += count;
    RandomStream random(Mix(Mix(options.seed, 0x7a5), node));
    const bool leans = outward.dot(frame.z) < 1 - kLean;
    for (size_t i = 0; i < count; ++i) {
      if (leans && Vec3(scratch.x[i], scratch.y[i], scratch.z[i]).dot(outward) <= 0) {
        out[i] = kBelow;
        continue;
      }
      const RayHit& hit = scratch.hits[i];
      if (!hit.hit()) {
        out[i] = kEscaped;
        continue;
      }
      const Mesh::Location& where = scratch.where[i];
      const uint32_t material = any_specular ? scene.faces[hit.face].material : 0;
      if (any_specular && specular_at[material] && (where.element != kNone || specular.glass(material))) {
        const Ray ray{origin, 0.0f, {scratch.x[i], scratch.y[i], scratch.z[i]}, hit.t};
        out[i] = TraceChain(ray, hit, random, scratch, hops);
      } else {
        out[i] = End(where, random);
      }
    }
  }

  // Follows mirrors and glass from the first on; returns the link.
  uint32_t TraceChain(const Ray& ray, const RayHit& hit, RandomStream& random, Scratch& scratch,
                      std::vector<Hop>& hops) const {
    const size_t begin = hops.size();
    Rgb absorbed = Rgb::Zero();
    scratch.branches.push_back({.ray = ray, .hit = hit});
    while (!scratch.branches.empty()) {
      Branch branch = scratch.branches.back();
      scratch.branches.pop_back();
      while (Advance(branch, random, scratch, hops, &absorbed)) {
        branch.hit = tracer.Intersect(branch.ray);
        ++scratch.traced;
      }
    }
    if ((absorbed > 0).any() || hops.size() == begin) AddLost(kAbsorbed, absorbed, hops);
    hops.back().last = 1;
    return kChain | uint32_t(begin);
  }

  static void AddLost(uint32_t how, const Rgb& power, std::vector<Hop>& hops) {
    Hop hop{};
    hop.node = how;
    hop.end = 1;
    hop.SetThroughput(power);
    hops.push_back(hop);
  }

  // From a branch's hit to its next ray; false where it ends.
  bool Advance(Branch& branch, RandomStream& random, Scratch& scratch, std::vector<Hop>& hops,
               Rgb* absorbed) const {
    const RayHit& hit = branch.hit;
    const uint32_t material = hit.hit() ? scene.faces[hit.face].material : kNone;
    const Side side = hit.side;
    if (specular.any_body()) {
      const float metres =
          hit.hit() ? hit.t * branch.ray.direction.norm() : std::numeric_limits<float>::infinity();
      const Rgb passed = specular.Transmittance(branch.media, material, side, metres);
      *absorbed += branch.Power() * (1 - passed);
      branch.throughput *= passed;
      if ((branch.throughput <= 0).all()) return false;
    }
    if (!hit.hit()) {
      AddLost(kEscaped, branch.Power(), hops);
      return false;
    }
    const Face& face = scene.faces[hit.face];
    const auto where = locator.Locate(hit);
    Hop hop{};
    hop.direction = PackDirection(-branch.ray.direction);
    hop.SetThroughput(branch.throughput);
    hop.node = End(where, random);
    // Straight emission travels by shooting, and by way of one planar mirror too; panes do not hinder it.
    const bool by_shooting =
        !branch.bent &&
        (branch.mirrors == 0 || (branch.mirrors == 1 && ShotByMirror(branch.last_mirror, face)));
    hop.emission = !by_shooting && hop.node != kBlocked && scene.materials[material].emits();
    const bool glass = specular.glass(material);
    const bool goes_on = glass || (hop.node != kBlocked && mirror[material]);
    const bool beyond = glass ? branch.glass == kMaxGlass : branch.mirrors == kMaxMirrors;
    if (!goes_on || beyond) {
      hop.cut = goes_on;
      hop.end = 1;
      if (hop.node == kBlocked) hop.SetThroughput(branch.Power());
      hops.push_back(hop);
      return false;
    }
    if (hop.node != kBlocked && (materials[material].base.l_max >= 0 || hop.emission)) hops.push_back(hop);
    if (glass) return GoThroughGlass(branch, material, where, random, scratch, hops, absorbed);

    const HitPoint at = FindHitPoint(scene, mesh, branch.ray, hit, where);
    const Vec3 wo = -branch.ray.direction;
    branch.throughput *= materials[material].SentOn(std::clamp(wo.dot(at.normal), 0.0f, 1.0f));
    branch.ray = tracer.Leaving(branch.hit.face, at.position, at.geometric_normal, MirrorDirection(wo, at));
    branch.last_mirror = mesh.element_patch[where.element];
    ++branch.mirrors;
    return true;
  }

  bool GoThroughGlass(Branch& branch, uint32_t material, const Mesh::Location& where, RandomStream& random,
                      Scratch& scratch, std::vector<Hop>& hops, Rgb* absorbed) const {
    const HitPoint at = FindHitPoint(scene, branch.ray, branch.hit);
    SpecularWays ways = specular.Continue(material, branch.hit.side, at, -branch.ray.direction, branch.media);
    const Rgb passed = ways.transmission.weight / ways.basic;
    // Nodes count what their surface keeps; where there are none it is counted here.
    if (where.element == kNone) *absorbed += branch.Power() * (1 - ways.reflection.weight - passed);
    if (!options.follow_mirrors) {
      AddLost(
          kBlocked,
          branch.Power() * (ways.straight ? ways.reflection.weight : Rgb(ways.reflection.weight + passed)),
          hops);
      ways.reflection.weight = Rgb::Zero();
      if (!ways.straight) return false;
    }

    ++branch.glass;
    const float reflects = ways.reflection.weight.mean(), passes = passed.mean();
    if (!(reflects + passes > 0)) return false;
    const auto reflect = [&](Branch& to, float weight) {
      to.throughput *= ways.reflection.weight * weight;
      to.bent = true;
      to.ray =
          tracer.Leaving(branch.hit.face, at.position, ways.reflection.outward, ways.reflection.direction);
    };
    const auto transmit = [&](Branch& to, float weight) {
      to.throughput *= ways.transmission.weight * weight;
      to.basic *= ways.basic;
      to.bent |= !ways.straight;
      to.media = ways.beyond;
      to.ray = tracer.Leaving(branch.hit.face, at.position, ways.transmission.outward,
                              ways.transmission.direction);
    };
    if (branch.share * std::min(reflects, passes) >= kSplit) {
      Branch other = branch;
      other.share *= reflects;
      reflect(other, 1);
      other.hit = tracer.Intersect(other.ray);
      ++scratch.traced;
      scratch.branches.push_back(other);
      branch.share *= passes;
      transmit(branch, 1);
      return true;
    }
    const float chance = passes / (reflects + passes);
    if (random.Next() < chance) {
      transmit(branch, 1 / chance);
    } else {
      reflect(branch, 1 / (1 - chance));
    }
    return true;
  }
};

LinkPattern Links::PatternOf(const MaterialLobes& material, int links) {
  return LinkPattern::For(links, material.diffuse() ? 0 : material.max_degree(), kPerCoefficient);
}

Links::Links(const Scene& scene, const Mesh& mesh, const RayTracer& tracer,
             const std::vector<MaterialLobes>& materials, const Options& options,
             const std::function<bool(double)>& stop)
    : options_(options), node_patch_(mesh.node_patch) {
  // The orders of corners must fit beside the chain's bit.
  if (mesh.element_count() >= kChain / 6) throw std::length_error("more than 3.5e8 elements");
  size_t links = 0;
  for (const auto& p : mesh.patches) {
    const auto& m = materials[p.material];
    const LinkPattern pattern = PatternOf(m, options.links);
    patches_.push_back({pattern, links, p.node_begin});
    links += size_t(p.node_end - p.node_begin) * pattern.count();
  }
  targets_.resize(links);
  hidden_.assign(mesh.node_count(), 0);

  Tracing tracing{scene, mesh, ElementLocator(mesh), tracer, materials, options_};
  for (const auto& m : materials) {
    tracing.mirror.push_back(options.follow_mirrors && m.mirror());
    tracing.specular_at.push_back(tracing.mirror.back() || m.glass());
    tracing.any_specular |= tracing.specular_at.back() != 0;
  }
  const size_t nodes = mesh.node_count();
  const uint32_t blocks = uint32_t((nodes + kBlockOfNodes - 1) / kBlockOfNodes);
  std::vector<std::vector<Hop>> hops(blocks);
  tbb::enumerable_thread_specific<Tracing::Scratch> scratches;
  std::atomic<bool> stopped{false};
  std::atomic<uint32_t> done{0};
  tbb::parallel_for(0u, blocks, [&](uint32_t block) {
    if (stopped.load(std::memory_order_relaxed)) return;
    auto& scratch = scratches.local();
    const uint32_t end = uint32_t(std::min<size_t>(nodes, size_t(block + 1) * kBlockOfNodes));
    for (uint32_t node = block * kBlockOfNodes; node < end; ++node) {
      const Patch& p = patches_[node_patch_[node]];
      const std::span<uint32_t> out{
          targets_.data() + p.begin + size_t(node - p.node_begin) * p.pattern.count(),
          size_t(p.pattern.count())};
      tracing.TraceNode(node, p.pattern, scratch, out, hops[block]);
      const auto blocked = std::count(out.begin(), out.end(), kBlocked);
      const auto below = std::count(out.begin(), out.end(), kBelow);
      hidden_[node] = 2 * size_t(blocked) > out.size() - size_t(below);
    }
    if (stop && stop(double(++done) / blocks)) stopped = true;
  });
  for (const auto& scratch : scratches) rays_ += scratch.traced;
  if ((stopped_ = stopped)) return;

  // Chains were numbered block by block.
  std::vector<uint32_t> first_hop(blocks);
  for (uint32_t b = 0; b < blocks; ++b) {
    first_hop[b] = uint32_t(hops_.size());
    hops_.insert(hops_.end(), hops[b].begin(), hops[b].end());
    hops[b] = {};
  }
  if (hops_.size() >= (kBelow & ~kChain)) throw std::length_error("more than 2^31 hops of links by mirrors");
  const auto resolve = [&](uint32_t& end) {
    if (!IsNode(end)) return;
    const auto& corners = mesh.elements[end / 6];
    const auto& order = kOrder[end % 6];
    for (const uint8_t k : order) {
      if (hidden_[corners[k]]) continue;
      end = corners[k];
      return;
    }
    end = kBlocked;
  };
  tbb::parallel_for(0u, blocks, [&](uint32_t block) {
    const uint32_t end = uint32_t(std::min<size_t>(nodes, size_t(block + 1) * kBlockOfNodes));
    for (uint32_t node = block * kBlockOfNodes; node < end; ++node) {
      const Patch& p = patches_[node_patch_[node]];
      uint32_t* link = targets_.data() + p.begin + size_t(node - p.node_begin) * p.pattern.count();
      for (int i = 0; i < p.pattern.count(); ++i) {
        if (IsChain(link[i])) {
          link[i] += first_hop[block];
        } else {
          resolve(link[i]);
        }
      }
    }
  });
  tbb::parallel_for(size_t(0), hops_.size(), [&](size_t i) { resolve(hops_[i].node); });
}

}  // namespace lobe
