#include "solver/exposure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include <tbb/parallel_for.h>

#include "brdf/frame.h"
#include "scene/input_error.h"
#include "solver/hash.h"

namespace lobe {
namespace {

constexpr int kWalksPerRound = 4096, kMaxRounds = 64, kMaxBounces = 24;

// Rays aimed at a side that walks have not met (chosen): what one in twenty can see is missed once in 5e5.
constexpr int kAimedRays = 256;

Vec3 CosineDirection(float u, float v) {
  const float r = std::sqrt(u), phi = 2.0f * std::numbers::pi_v<float> * v;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1.0f - u))};
}

Vec3 PointOnTriangle(const std::array<Vec3, 3>& p, float u, float v) {
  const float s = std::sqrt(u);
  return p[0] * (1 - s) + p[1] * (s * (1 - v)) + p[2] * (s * v);
}

Ray RayFrom(const Vec3& point, const Vec3& normal, const Vec3& direction, float epsilon) {
  return {point + normal * epsilon, 0.0f, direction, std::numeric_limits<float>::infinity()};
}

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

// Where light arrives or starts; `side` is 2 * piece + side.
struct LitPoint {
  uint32_t side;
  Vec3 position, normal;
};

// Is a point on one of `faces`, on `side`, in sight of one of `from`?
bool InSight(const Scene& scene, const RayTracer& tracer, const std::vector<uint32_t>& faces, Side side,
             const std::vector<LitPoint>& from, RandomStream random) {
  for (int i = 0; i < kAimedRays; ++i) {
    const Face& face = scene.faces[faces[random.NextBits() % faces.size()]];
    const LitPoint& lit = from[random.NextBits() % from.size()];
    const Vec3 normal = scene.GeometricNormal(face) * (side == Side::kFront ? 1.0f : -1.0f);
    const float u = random.Next(), v = random.Next();
    const Vec3 at = PointOnTriangle(scene.Corners(face), u, v) + normal * tracer.epsilon();
    const Vec3 to = lit.position + lit.normal * tracer.epsilon() - at;
    if (to.dot(normal) > 0 && to.dot(lit.normal) < 0 && !tracer.Occluded({at, 0.0f, to, 1.0f})) return true;
  }
  return false;
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
    if (material.double_sided)
      out.push_back({f, Side::kBack, {p[0], p[2], p[1]}, -n, area, material.emission});
  }
  return out;
}

std::vector<bool> FindLitSides(const Scene& scene, const RayTracer& tracer, uint64_t seed) {
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

  const auto double_sided = [&](uint32_t f) { return scene.material(scene.faces[f]).double_sided; };
  std::vector<LitPoint> points;  // of the last round
  for (int round = 0; round < kMaxRounds; ++round) {
    // Each walk lists the sides it met; merged afterwards, so that threads share nothing.
    std::vector<std::vector<LitPoint>> met(kWalksPerRound);
    tbb::parallel_for(0, kWalksPerRound, [&](int walk) {
      RandomStream random(Mix(Mix(seed, 0x11f7), uint64_t(round) * kWalksPerRound + walk));
      const Emitter& e = emitters[choice.At((walk + random.Next()) / kWalksPerRound)];
      Vec3 at = PointOnTriangle(e.corners, random.Next(), random.Next());
      Vec3 normal = e.normal;
      met[walk].push_back({2 * piece[e.face] + uint32_t(e.side), at, normal});
      for (int bounce = 0; bounce < kMaxBounces; ++bounce) {
        const Vec3 w = Frame(normal).ToWorld(CosineDirection(random.Next(), random.Next()));
        const RayHit hit = tracer.Intersect(RayFrom(at, normal, w, tracer.epsilon()));
        if (!hit.hit() || (hit.side == Side::kBack && !double_sided(hit.face))) break;
        const auto p = scene.Corners(scene.faces[hit.face]);
        at = p[0] * (1 - hit.u - hit.v) + p[1] * hit.u + p[2] * hit.v;
        normal = scene.GeometricNormal(scene.faces[hit.face]);
        if (hit.side == Side::kBack) normal = -normal;
        met[walk].push_back({2 * piece[hit.face] + uint32_t(hit.side), at, normal});
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

  // A small thing in a large scene is seldom met by chance, and would stay black.
  std::map<uint32_t, std::vector<uint32_t>> unmet;  // faces by 2 * piece + side
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    for (uint32_t side = 0; side < (double_sided(f) ? 2u : 1u); ++side) {
      if (!lit_piece[2 * piece[f] + side]) unmet[2 * piece[f] + side].push_back(f);
    }
  }
  const std::vector<std::pair<uint32_t, std::vector<uint32_t>>> aims(unmet.begin(), unmet.end());
  std::vector<uint8_t> in_sight(aims.size());
  tbb::parallel_for(size_t(0), aims.size(), [&](size_t i) {
    const auto& [side, faces] = aims[i];
    const RandomStream random(Mix(Mix(seed, 0xa13), side));
    in_sight[i] = InSight(scene, tracer, faces, Side(side % 2), points, random);
  });
  for (size_t i = 0; i < aims.size(); ++i) {
    if (in_sight[i]) lit_piece[aims[i].first] = true;
  }

  std::vector<bool> lit(2 * scene.faces.size());
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    for (int side = 0; side < 2; ++side) lit[2 * f + side] = lit_piece[2 * piece[f] + side];
  }
  return lit;
}

Exposure FindExposure(const Scene& scene, const Mesh& mesh, const RayTracer& tracer, uint64_t seed) {
  constexpr int kSide = 8;  // strata a side
  static_assert(kSide * kSide == Exposure::kProbes);
  Exposure out;
  const size_t nodes = mesh.node_count();
  out.hidden.assign(nodes, 0);
  std::vector<std::vector<Exposure::LostRay>> lost(nodes);

  const auto reaches_nodes = [&](const RayHit& hit) {
    return mesh.roots[2 * hit.face + size_t(hit.side)] != kNone;
  };
  tbb::parallel_for(size_t(0), nodes, [&](size_t node) {
    RandomStream random(Mix(Mix(seed, 0xe9), node));
    const Frame frame(mesh.node_sample_normal[node]), shading(mesh.node_normal[node]);
    Ray rays[Exposure::kProbes];
    RayHit hits[Exposure::kProbes];
    for (int i = 0; i < Exposure::kProbes; ++i) {
      const Vec3 w = frame.ToWorld(
          CosineDirection((i / kSide + random.Next()) / kSide, (i % kSide + random.Next()) / kSide));
      rays[i] = RayFrom(mesh.node_sample_position[node], frame.z, w, tracer.epsilon());
    }
    tracer.Intersect(rays, hits, /*coherent=*/false);
    int blocked = 0;
    for (int i = 0; i < Exposure::kProbes; ++i) {
      if (hits[i].hit() && reaches_nodes(hits[i])) continue;
      blocked += hits[i].hit();
      lost[node].push_back({shading.ToLocal(rays[i].direction), !hits[i].hit()});
    }
    out.hidden[node] = 2 * blocked > Exposure::kProbes;
  });
  for (const auto& rays : lost) {
    out.lost_begin.push_back(uint32_t(out.lost.size()));
    out.lost.insert(out.lost.end(), rays.begin(), rays.end());
  }
  out.lost_begin.push_back(uint32_t(out.lost.size()));

  const auto emitters = FindEmitters(scene);
  const EmitterChoice choice(emitters);
  constexpr int kEmissionProbes = 1 << 14;
  std::vector<uint8_t> fate(kEmissionProbes);  // 1 escaped, 2 blocked
  std::vector<size_t> source(kEmissionProbes);
  tbb::parallel_for(0, kEmissionProbes, [&](int i) {
    RandomStream random(Mix(Mix(seed, 0xe317), i));
    const Emitter& e = emitters[source[i] = choice.At((i + random.Next()) / kEmissionProbes)];
    const Vec3 w = Frame(e.normal).ToWorld(CosineDirection(random.Next(), random.Next()));
    const Vec3 at = PointOnTriangle(e.corners, random.Next(), random.Next());
    const RayHit hit = tracer.Intersect(RayFrom(at, e.normal, w, tracer.epsilon()));
    fate[i] = !hit.hit() ? 1 : reaches_nodes(hit) ? 0 : 2;
  });
  // Every probe carries the same power, in the colours of its emitter.
  Eigen::Array3d power[3] = {Eigen::Array3d::Zero(), Eigen::Array3d::Zero(), Eigen::Array3d::Zero()};
  for (int i = 0; i < kEmissionProbes; ++i) {
    const Rgb& radiance = emitters[source[i]].radiance;
    power[fate[i]] += (radiance / radiance.sum()).cast<double>();
  }
  const Eigen::Array3d all = power[0] + power[1] + power[2];
  out.emission_escaped = (all > 0).select(power[1] / all, 0.0);
  out.emission_blocked = (all > 0).select(power[2] / all, 0.0);
  out.rays = nodes * Exposure::kProbes + kEmissionProbes;
  return out;
}

}  // namespace lobe
