#include "solver/exposure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include <tbb/parallel_for.h>

#include "brdf/frame.h"
#include "scene/input_error.h"
#include "scene/specular.h"
#include "solver/hash.h"
#include "solver/links.h"
#include "solver/random_points.h"

namespace lobe {
namespace {

constexpr int kWalksPerRound = 4096, kMaxRounds = 64, kMaxBounces = 24;

// Rays aimed at a side that walks have not met (chosen): what one in twenty can see is missed once in 5e5.
constexpr int kAimedRays = 256;

// Faces of one surface that share positions hang together, but not across contact lines: light may fall on
// one side of those only. Where a line touches a position, faces must share an edge that is none. A line is
// one for what stands on it, too: the bottom of a box is dark, its sides are not.
std::vector<uint32_t> ConnectedPieces(const Scene& scene) {
  std::vector<uint32_t> parent(scene.faces.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find = [&](uint32_t f) {
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
  };
  using Place = std::array<float, 3>;
  using Edge = std::array<Place, 2>;
  const auto place = [&](uint32_t f, int k) {
    const Vec3& p = scene.positions[scene.faces[f].vertex[k]];
    return Place{p.x() + 0.0f, p.y() + 0.0f, p.z() + 0.0f};
  };
  const auto edge = [&](uint32_t f, int k) {
    const Place a = place(f, k), b = place(f, (k + 1) % 3);
    return a < b ? Edge{a, b} : Edge{b, a};
  };
  std::set<Place> on_line;
  std::set<Edge> lines;
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if (!(scene.faces[f].contact >> k & 1)) continue;
      lines.insert(edge(f, k));
      on_line.insert({place(f, k), place(f, (k + 1) % 3)});
    }
  }
  std::map<std::pair<uint32_t, Place>, uint32_t> first;  // by surface
  std::map<std::pair<uint32_t, Edge>, uint32_t> first_at_edge;
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    const uint32_t surface = scene.faces[f].surface;
    for (int k = 0; k < 3; ++k) {
      const Place here = place(f, k);
      if (on_line.empty() || !on_line.contains(here)) {
        const auto [it, added] = first.try_emplace({surface, here}, f);
        if (!added) parent[find(f)] = find(it->second);
        continue;
      }
      for (const int side : {k, (k + 2) % 3}) {
        if (lines.contains(edge(f, side))) continue;
        const auto [it, added] = first_at_edge.try_emplace({surface, edge(f, side)}, f);
        if (!added) parent[find(f)] = find(it->second);
      }
    }
  }
  for (uint32_t f = 0; f < parent.size(); ++f) parent[f] = find(f);
  return parent;
}

// Does light go on from one side to the other?
bool LetsThrough(const Material& material) { return material.transmits() || material.glass(); }

// Clear glass sends all light on, and the inside of a body has no base.
bool StoresLight(const Material& material, Side side) {
  if (!material.glass()) return true;
  if (material.body() && side == Side::kBack) return false;
  const auto& m = std::get<MetallicRoughness>(material.reflectance);
  return material.emits() || material.transmits() || (m.DiffuseColor() > 0).any();
}

// Where light arrives or starts; `side` is 2 * piece + side.
struct LitPoint {
  uint32_t side, face;
  Vec3 position, normal;
};

// A point on one of `faces`, on `side`, in sight of one of `from`.
struct Sighting {
  uint32_t face;
  Vec3 position, normal;
};
std::optional<Sighting> FindInSight(const Scene& scene, const RayTracer& tracer,
                                    const std::vector<uint32_t>& faces, Side side,
                                    const std::vector<LitPoint>& from, RandomStream random) {
  for (int i = 0; i < kAimedRays; ++i) {
    const uint32_t f = faces[random.NextBits() % faces.size()];
    const Face& face = scene.faces[f];
    const LitPoint& lit = from[random.NextBits() % from.size()];
    const Vec3 normal = scene.GeometricNormal(face) * (side == Side::kFront ? 1.0f : -1.0f);
    const float u = random.Next(), v = random.Next();
    const Vec3 position = PointOnTriangle(scene.Corners(face), u, v);
    const Vec3 at = position + normal * tracer.Lift(f);
    const Vec3 to = lit.position + lit.normal * tracer.LiftOfEnd(lit.face, at) - at;
    if (to.dot(normal) > 0 && to.dot(lit.normal) < 0 && !tracer.Occluded({at, 0.0f, to, 1.0f})) {
      return Sighting{f, position, normal};
    }
  }
  return std::nullopt;
}

// Index of the emitter that holds `u` of the total power, u in [0, 1).
class EmitterChoice {
 public:
  explicit EmitterChoice(const std::vector<Emitter>& emitters) {
    double sum = 0;
    for (const auto& e : emitters) cumulative_.push_back(sum += double(e.radiance.sum()) * e.area);
  }
  size_t At(double u) const {
    const auto it = std::upper_bound(cumulative_.begin(), cumulative_.end(), u * cumulative_.back());
    return std::min(size_t(it - cumulative_.begin()), cumulative_.size() - 1);
  }

 private:
  std::vector<double> cumulative_;
};

}  // namespace

std::vector<Emitter> FindEmitters(const Scene& scene) {
  std::vector<Emitter> out;
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    const Material& material = scene.material(scene.faces[f]);
    if (!material.emits()) continue;
    const auto p = scene.Corners(scene.faces[f]);
    const Vec3 n = scene.GeometricNormal(scene.faces[f]);
    const float area = scene.Area(scene.faces[f]);
    out.push_back({f, Side::kFront, p, n, area, material.emission});
    if (material.emits_behind())
      out.push_back({f, Side::kBack, {p[0], p[2], p[1]}, -n, area, material.emission});
  }
  return out;
}

std::vector<bool> FindLitSides(const Scene& scene, const RayTracer& tracer, uint64_t seed,
                               const std::function<void()>& poll) {
  const auto emitters = FindEmitters(scene);
  if (emitters.empty()) {
    throw InputError(scene.path +
                     ": no emitter found: at least one material with an emissiveFactor above 0 "
                     "on a triangle is expected");
  }
  const auto piece = ConnectedPieces(scene);
  const EmitterChoice choice(emitters);
  std::vector<bool> lit_piece(2 * scene.faces.size(), false);  // 2 * piece + side
  for (const auto& e : emitters) lit_piece[2 * piece[e.face] + size_t(e.side)] = true;

  const auto double_sided = [&](uint32_t f) {
    const Material& material = scene.material(scene.faces[f]);
    return material.double_sided || material.glass();
  };
  std::vector<LitPoint> points;  // of the last round
  for (int round = 0; round < kMaxRounds; ++round) {
    // Each walk lists the sides it met; merged afterwards, so that threads share nothing.
    std::vector<std::vector<LitPoint>> met(kWalksPerRound);
    tbb::parallel_for(0, kWalksPerRound, [&](int walk) {
      if (poll && walk % 64 == 0) poll();
      RandomStream random(Mix(Mix(seed, 0x11f7), uint64_t(round) * kWalksPerRound + walk));
      // Every other walk starts at any emitter alike: a room is lit by its own lamp, however dim that is
      // beside those of other rooms.
      const float u = (walk + random.Next()) / kWalksPerRound;
      const size_t any = std::min(size_t(u * float(emitters.size())), emitters.size() - 1);
      const Emitter& e = emitters[walk % 2 == 0 ? choice.At(u) : any];
      Vec3 at = PointOnTriangle(e.corners, random.Next(), random.Next());
      Vec3 normal = e.normal;
      uint32_t face = e.face;
      met[walk].push_back({2 * piece[face] + uint32_t(e.side), face, at, normal});
      for (int bounce = 0; bounce < kMaxBounces; ++bounce) {
        const Vec3 w = Frame(normal).ToWorld(CosineDirection(random.Next(), random.Next()));
        const RayHit hit = tracer.Intersect(tracer.Leaving(face, at, normal, w));
        if (!hit.hit() || (hit.side == Side::kBack && !double_sided(hit.face))) break;
        face = hit.face;
        const auto p = scene.Corners(scene.faces[face]);
        at = p[0] * (1 - hit.u - hit.v) + p[1] * hit.u + p[2] * hit.v;
        normal = scene.GeometricNormal(scene.faces[hit.face]);
        if (hit.side == Side::kBack) normal = -normal;
        const uint32_t met_side = 2 * piece[hit.face] + uint32_t(hit.side);
        met[walk].push_back({met_side, face, at, normal});
        if (LetsThrough(scene.material(scene.faces[hit.face]))) {
          met[walk].push_back({met_side ^ 1, face, at, -normal});
          // However little goes through, what lies behind is lit; so a coin decides, not the albedo.
          if (random.Next() < 0.5f) normal = -normal;
        }
      }
    });
    bool anything_new = false;
    points.clear();
    for (const auto& walk : met) {
      for (const LitPoint& point : walk) {
        if (!lit_piece[point.side]) lit_piece[point.side] = anything_new = true;
        points.push_back(point);
      }
    }
    if (!anything_new) break;
  }

  // A small thing in a large scene is seldom met by chance, and would stay black. If it is translucent, what
  // lies behind it is looked for in turn: every time round, from the far sides of what was found before.
  while (!points.empty()) {
    std::map<uint32_t, std::vector<uint32_t>> unmet;  // faces by 2 * piece + side
    for (uint32_t f = 0; f < scene.faces.size(); ++f) {
      for (uint32_t side = 0; side < (double_sided(f) ? 2u : 1u); ++side) {
        if (!lit_piece[2 * piece[f] + side]) unmet[2 * piece[f] + side].push_back(f);
      }
    }
    const std::vector<std::pair<uint32_t, std::vector<uint32_t>>> aims(unmet.begin(), unmet.end());
    std::vector<std::optional<Sighting>> sightings(aims.size());
    tbb::parallel_for(size_t(0), aims.size(), [&](size_t i) {
      if (poll && i % 16 == 0) poll();
      const auto& [side, faces] = aims[i];
      const RandomStream random(Mix(Mix(seed, 0xa13), side));
      sightings[i] = FindInSight(scene, tracer, faces, Side(side % 2), points, random);
    });
    points.clear();
    for (size_t i = 0; i < aims.size(); ++i) {
      if (!sightings[i]) continue;
      const uint32_t side = aims[i].first;
      lit_piece[side] = true;
      if (!LetsThrough(scene.material(scene.faces[sightings[i]->face]))) continue;
      lit_piece[side ^ 1] = true;
      points.push_back({side ^ 1, sightings[i]->face, sightings[i]->position, -sightings[i]->normal});
    }
  }

  std::vector<bool> lit(2 * scene.faces.size());
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    const Material& material = scene.material(scene.faces[f]);
    const bool through = LetsThrough(material);
    for (size_t side = 0; side < 2; ++side) {
      lit[2 * f + side] = lit_piece[2 * piece[f] + side] || (through && lit_piece[2 * piece[f] + (1 - side)]);
      if (!StoresLight(material, Side(side))) lit[2 * f + side] = false;
    }
  }
  return lit;
}

EmissionLoss FindEmissionLoss(const Scene& scene, const Mesh& mesh, const RayTracer& tracer,
                              const std::vector<const MaterialLobes*>& mirrors, uint64_t seed,
                              bool through_glass) {
  constexpr int kProbes = 1 << 14;
  const auto emitters = FindEmitters(scene);
  const EmitterChoice choice(emitters);
  const SpecularSurfaces specular(scene);
  struct Fate {
    size_t emitter;
    Rgb escaped = Rgb::Zero(), blocked = Rgb::Zero(), in_glass = Rgb::Zero();
  };
  std::vector<Fate> fates(kProbes);
  tbb::parallel_for(0, kProbes, [&](int i) {
    Fate& fate = fates[i];
    RandomStream random(Mix(Mix(seed, 0xe317), i));
    const Emitter& e = emitters[fate.emitter = choice.At((i + random.Next()) / kProbes)];
    const Vec3 w = Frame(e.normal).ToWorld(CosineDirection(random.Next(), random.Next()));
    Ray ray = tracer.Leaving(e.face, PointOnTriangle(e.corners, random.Next(), random.Next()), e.normal, w);
    Rgb throughput = Rgb::Constant(1);
    MediaStack media;
    for (int mirror = 0, glass = 0; mirror <= Links::kMaxMirrors && glass <= Links::kMaxGlass;) {
      const RayHit hit = tracer.Intersect(ray);
      const uint32_t material = hit.hit() ? scene.faces[hit.face].material : kNone;
      if (specular.any_body()) {
        const float metres = hit.hit() ? hit.t : std::numeric_limits<float>::infinity();
        const Rgb passed = specular.Transmittance(media, material, hit.side, metres);
        fate.in_glass += throughput * (1 - passed);
        throughput *= passed;
      }
      if (!hit.hit()) {
        fate.escaped += throughput;
        return;
      }
      const auto where = mesh.Locate(hit.face, hit.side, hit.u, hit.v);
      if (specular.glass(material)) {
        const HitPoint at = FindHitPoint(scene, ray, hit);
        const SpecularWays ways = specular.Continue(material, hit.side, at, -ray.direction, media);
        Rgb reflected = ways.reflection.weight;
        const Rgb passed = ways.transmission.weight / ways.basic;
        if (where.element == kNone) fate.in_glass += throughput * (1 - reflected - passed);
        if (!through_glass) {
          fate.blocked += throughput * (ways.straight ? reflected : Rgb(reflected + passed));
          reflected = Rgb::Zero();
          if (!ways.straight) return;
        }
        const float reflects = reflected.mean(), passes = passed.mean();
        if (!(reflects + passes > 0)) return;
        const float chance = passes / (reflects + passes);
        const bool through = random.Next() < chance;
        throughput *= through ? Rgb(passed / chance) : Rgb(reflected / (1 - chance));
        const SpecularWay& on = through ? ways.transmission : ways.reflection;
        if (through) media = ways.beyond;
        ray = tracer.Leaving(hit.face, at.position, on.outward, on.direction);
        ++glass;
        continue;
      }
      if (where.element == kNone) {
        fate.blocked += throughput;
        return;
      }
      const MaterialLobes* lobes = mirrors[material];
      if (!lobes) return;
      const HitPoint at = FindHitPoint(scene, mesh, ray, hit, where);
      throughput *= lobes->SentOn(std::clamp(-ray.direction.dot(at.normal), 0.0f, 1.0f));
      ray = tracer.Leaving(hit.face, at.position, at.geometric_normal, MirrorDirection(-ray.direction, at));
      ++mirror;
    }
    fate.blocked += throughput;
  });
  // Every probe carries the same power, in the colours of its emitter.
  EmissionLoss out;
  Eigen::Array3d all = Eigen::Array3d::Zero();
  for (const Fate& fate : fates) {
    const Rgb& radiance = emitters[fate.emitter].radiance;
    const Rgb share = radiance / radiance.sum();
    all += share.cast<double>();
    out.escaped += (share * fate.escaped).cast<double>();
    out.blocked += (share * fate.blocked).cast<double>();
    out.in_glass += (share * fate.in_glass).cast<double>();
  }
  out.escaped = (all > 0).select(out.escaped / all, 0.0);
  out.blocked = (all > 0).select(out.blocked / all, 0.0);
  out.in_glass = (all > 0).select(out.in_glass / all, 0.0);
  return out;
}

}  // namespace lobe
