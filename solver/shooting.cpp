#include "solver/shooting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "brdf/frame.h"

namespace lobe {
namespace {

// Cells below this fraction of the threshold are sampled instead of all being shot: their expected light is
// laid end to end and a cell is taken each time another such portion is full. Keeps the ray count near the
// budget when a scene has many small faces. (measured in docs/validation.md#delta-areas)
constexpr float kSampledBelow = 0.25f;

// A glossy receiver wants its light cut to this many radians times 1 / l_max, or cells alias in its lobe.
constexpr float kGlossyAngle = 2.0f;

// And this many delta areas per coefficient of its lobe, or noise shows as blotches.
constexpr float kPerCoefficient = 8.0f;

// The mean radiance of a glossy cell says little of what it sends one way; cells are cut this much finer.
constexpr float kGlossyCaution = 4.0f;

// An emitter whose edges are shorter than this times its distance is taken by points spread evenly over it,
// without cutting: the kernel hardly varies. So many points for each threshold of light, as cutting would
// give.
constexpr float kSeenSmall = 0.7f;
constexpr float kPerThreshold = 1.4f;

// If what promises most, down to some tenth part of a tenth part ..., is hidden but for less than this share
// of all, then what promises less had too few rays and is asked anew with as many as all had. (chosen)
// Whether it is does not depend on what its own rays saw, and what promises more keeps its rays: so no
// estimate is biased by it. So many times at most, for lamps ever dimmer.
constexpr double kTooFewRays = 0.1;
constexpr int kMostSharings = 16;

// Halvings below a root; 2^40 pieces.
constexpr int kMaxDepth = 40;

// A point of a cell to stand for it, chosen in proportion to the light it would bring: one of kCandidates
// random points, by their kernel cos_i cos_o / r^2 (resampled importance sampling, Talbot et al., EGSR 2005).
// Points spread evenly over the area would too often be far or on the horizon, and what is far is hidden more
// often than what is near: light would be lost (docs/validation.md#delta-areas).
constexpr int kCandidates = 8;
struct StandInPoint {
  Vec3 barycentrics, position;
};
StandInPoint StandIn(const std::array<Vec3, 3>& p, const Vec3& cell_normal, const Vec3& point,
                     const Vec3& normal, RandomStream& random) {
  // Seen small and well above both horizons the kernel is as good as constant: any point will do.
  const Vec3 middle = (p[0] + p[1] + p[2]) * (1.0f / 3.0f) - point;
  const float distance = middle.norm();
  const bool even = LongestEdgeSquared(p) < 0.0625f * distance * distance &&
                    middle.dot(normal) > 0.3f * distance && -middle.dot(cell_normal) > 0.3f * distance;
  const int candidates = even ? 1 : kCandidates;
  // Candidates follow the plastic-number sequence (Roberts 2018), shifted at random: stratified.
  const float u0 = random.Next(), v0 = random.Next();
  StandInPoint chosen;
  float sum = 0;
  float pick = random.Next();
  for (int i = 0; i < candidates; ++i) {
    float u = u0 + 0.7548777f * float(i), v = v0 + 0.5698403f * float(i);
    u -= std::floor(u);
    v -= std::floor(v);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const Vec3 position = p[0] + (p[1] - p[0]) * u + (p[2] - p[0]) * v;
    const Vec3 to = position - point;
    const float r2 = to.squaredNorm(), cos_i = to.dot(normal), cos_o = -to.dot(cell_normal);
    if (!(r2 * r2 > 0) || cos_i <= 0 || cos_o <= 0) continue;
    const float kernel = cos_i * cos_o / (r2 * r2);
    sum += kernel;
    // One number serves all choices: rescaled, what is left of it is uniform again.
    const float share = kernel / sum;
    if (pick < share) {
      chosen = {{1 - u - v, u, v}, position};
      pick /= share;
    } else {
      pick = (pick - share) / (1 - share);
    }
  }
  if (sum > 0) return chosen;
  // A sliver above the horizon that every candidate missed: near its highest corner.
  int highest = 0;
  for (int i = 1; i < 3; ++i) {
    if ((p[i] - p[highest]).dot(normal) > 0) highest = i;
  }
  chosen.barycentrics = Vec3::Constant(0.005f);
  chosen.barycentrics[highest] = 0.99f;
  chosen.position =
      p[0] * chosen.barycentrics[0] + p[1] * chosen.barycentrics[1] + p[2] * chosen.barycentrics[2];
  return chosen;
}

}  // namespace

ShootingField::ShootingField(const Mesh& mesh, const std::vector<Emitter>& emitters) : mesh_(&mesh) {
  for (const auto& e : emitters) roots_.push_back({e.corners, e.normal, e.radiance, kNone, false, e.face});
}

ShootingField::ShootingField(const Mesh& mesh, const std::vector<Emitter>& emitters,
                             std::vector<PlanarMirror> mirrors)
    : mesh_(&mesh), mirrors_(std::move(mirrors)) {
  for (uint32_t m = 0; m < mirrors_.size(); ++m) {
    const PlanarMirror& mirror = mirrors_[m];
    for (const auto& e : emitters) {
      const auto above = [&](const Vec3& p) { return mirror.normal.dot(p - mirror.point) > 0; };
      if (e.area >= mirror.largest_emitter) continue;
      if (std::none_of(e.corners.begin(), e.corners.end(), above)) continue;
      // Reflection turns the winding round.
      const Vec3 normal = e.normal - 2 * mirror.normal.dot(e.normal) * mirror.normal;
      roots_.push_back({{mirror.Image(e.corners[0]), mirror.Image(e.corners[2]), mirror.Image(e.corners[1])},
                        normal,
                        e.radiance,
                        kNone,
                        false,
                        e.face,
                        m});
    }
  }
}

ShootingField::ShootingField(const Scene& scene, const Mesh& mesh, const std::vector<uint8_t>& hidden,
                             const NodeLobes& lobes)
    : mesh_(&mesh), hidden_(&hidden), lobes_(&lobes), cell_radiance_(mesh.cells.size(), Rgb::Zero()) {
  std::vector<Rgb> node_radiance(mesh.node_count());
  for (uint32_t n = 0; n < mesh.node_count(); ++n) {
    node_radiance[n] = lobes.Flux(n) / std::numbers::pi_v<float>;
  }
  // Children lie after their parents and halve them exactly.
  for (size_t i = mesh.cells.size(); i-- > 0;) {
    const auto& cell = mesh.cells[i];
    if (cell.child != kNone) {
      cell_radiance_[i] = 0.5f * (cell_radiance_[cell.child] + cell_radiance_[cell.child + 1]);
    } else {
      const NodeWeights w = Interpolate(mesh, hidden, {cell.element, {1 / 3.0f, 1 / 3.0f, 1 / 3.0f}});
      for (int k = 0; k < w.count; ++k) cell_radiance_[i] += w.weight[k] * node_radiance[w.node[k]];
    }
  }
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    for (const Side side : {Side::kFront, Side::kBack}) {
      const uint32_t cell = mesh.roots[2 * f + size_t(side)];
      if (cell == kNone || (cell_radiance_[cell] == 0).all()) continue;
      const auto p = scene.Corners(scene.faces[f]);
      const Vec3 n = scene.GeometricNormal(scene.faces[f]);
      uint32_t leaf = cell;
      while (mesh.cells[leaf].child != kNone) leaf = mesh.cells[leaf].child;
      const bool glossy = !lobes.degrees(mesh.elements[mesh.cells[leaf].element][0]).diffuse();
      if (side == Side::kFront) {
        roots_.push_back({p, n, cell_radiance_[cell], cell, glossy, f});
      } else {
        roots_.push_back({{p[0], p[2], p[1]}, -n, cell_radiance_[cell], cell, glossy, f});
      }
    }
  }
}

Rgb ShootingField::Radiance(uint32_t element, const float weight[3], const Vec3& wo_world,
                            float* basis) const {
  Mesh::Location where{element, {weight[0], weight[1], weight[2]}};
  const NodeWeights w = Interpolate(*mesh_, *hidden_, where);
  Rgb out = Rgb::Zero();
  const bool planar = mesh_->patches[mesh_->element_patch[element]].planar;
  for (int k = 0; k < w.count; ++k) {
    if (k == 0 || !planar) {
      out += w.weight[k] *
             lobes_->Radiance(w.node[k], Frame(mesh_->node_normal[w.node[k]]).ToLocal(wo_world), basis);
    } else {
      out += w.weight[k] * lobes_->RadianceFromBasis(w.node[k], basis);
    }
  }
  return out;
}

Receiver::Receiver(const Mesh& mesh, const RayTracer& tracer, const std::vector<MaterialLobes>& materials,
                   const SpecularSurfaces& specular)
    : mesh_(mesh),
      tracer_(tracer),
      materials_(materials),
      specular_(specular),
      basis_(kMaxBasisSize),
      lifts_(tracer.PatchLifts(mesh)) {}

void Receiver::Split(const ShootingField& field, const ShootingField::Root& root, const Vec3& point,
                     const Vec3& normal, const Cell& parent) {
  const Mesh::Cell* tree = parent.cell == kNone ? nullptr : &mesh_.cells[parent.cell];
  int apex;
  if (tree && tree->child != kNone) {
    apex = tree->apex;
  } else {
    // Below an element, and in an emitter: the longest edge.
    const auto& p = parent.corners;
    const float e[3] = {(p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm(),
                        (p[1] - p[0]).squaredNorm()};
    apex = int(std::max_element(e, e + 3) - e);
  }
  const auto corners = Bisect(parent.corners, apex);
  const auto weights = Bisect(parent.weights, apex);
  for (int i = 1; i >= 0; --i) {
    Cell child{corners[i], weights[i], parent.radiance, 0, parent.cell, parent.element, parent.depth + 1};
    if (tree && tree->child != kNone) {
      child.cell = tree->child + i;
      child.element = mesh_.cells[child.cell].element;
      child.weights = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
      child.radiance = field.cell_radiance(child.cell);
      if ((child.radiance == 0).all()) continue;
    }
    const float light = EstimateTriangleLight(point, normal, child.corners).irradiance;
    if (!(light > 0)) continue;
    child.expected = light * std::abs(child.radiance.sum()) * (root.glossy ? kGlossyCaution : 1);
    stack_.push_back(child);
  }
}

void Receiver::Emit(const ShootingField& field, uint32_t root_index, uint32_t node, const Cell& cell,
                    float weight, RandomStream& random, Received& work) {
  const ShootingField::Root& root = field.roots()[root_index];
  const Vec3 &point = mesh_.node_sample_position[node], &normal = mesh_.node_normal[node];
  const TriangleLight light = LightOfTriangle(point, normal, cell.corners);
  if (!(light.irradiance > 0)) return;
  const auto [b, target] = StandIn(cell.corners, root.normal, point, normal, random);
  // The element at the point counts, not the cell's mean: what is dark is often also what is out of sight
  // (the floor under a box), and mean radiance times visible part would count that twice.
  uint32_t element = cell.element;
  Rgb radiance = cell.radiance;
  Vec3 weights = cell.weights[0] * b[0] + cell.weights[1] * b[1] + cell.weights[2] * b[2];
  if (cell.cell != kNone) {
    uint32_t at = cell.cell;
    if (mesh_.cells[at].child != kNone) weights = b;
    while (mesh_.cells[at].child != kNone) {
      const auto& tree = mesh_.cells[at];
      const float w0 = weights[tree.apex], w1 = weights[(tree.apex + 1) % 3],
                  w2 = weights[(tree.apex + 2) % 3];
      const bool first = w1 >= w2;
      weights = first ? Vec3(w0, w1 - w2, 2 * w2) : Vec3(w0, 2 * w1, w2 - w1);
      at = tree.child + (first ? 0 : 1);
    }
    element = mesh_.cells[at].element;
    radiance = field.cell_radiance(at);
  }
  const Vec3 from = point + mesh_.node_sample_normal[node] * lifts_[mesh_.node_patch[node]];
  const Vec3 to = target + root.normal * tracer_.LiftOfEnd(root.face, from);
  if (root.glossy) {
    radiance = field.Radiance(element, weights.data(), (from - to).normalized(), basis_.data());
    ++work.lobe_reads;
  }
  rays_.push_back({from, 0.0f, to - from, 1.0f});
  deltas_.push_back({light.direction, radiance * (light.irradiance * weight), root_index, root.mirror});
}

Rgb Receiver::ByMirror(const PlanarMirror& mirror, const Ray& ray) const {
  Rgb passed = Rgb::Constant(1);
  Ray piece = ray;
  const RayHit hit = specular_.IntersectPastPanes(tracer_, &piece, &passed);
  if (!hit.hit()) return Rgb::Zero();
  const auto where = mesh_.Locate(hit.face, hit.side, hit.u, hit.v);
  if (where.element == kNone || mesh_.element_patch[where.element] != mirror.patch) return Rgb::Zero();
  const Vec3 at = piece.origin + piece.direction * hit.t + mirror.normal * tracer_.Lift(hit.face);
  const Vec3 lamp = mirror.Image(ray.origin + ray.direction);
  const Ray beyond{at, 0.0f, lamp - at, 1.0f};
  passed *= specular_.SeeThrough(tracer_, beyond);
  const float cosine = -ray.direction.normalized().dot(mirror.normal);
  return materials_[mesh_.patches[mirror.patch].material].SentOn(std::clamp(cosine, 0.0f, 1.0f)) * passed;
}

bool Receiver::EmitEvenly(const ShootingField& field, uint32_t root_index, uint32_t node, int samples,
                          RandomStream& random) {
  const ShootingField::Root& root = field.roots()[root_index];
  const Vec3 &point = mesh_.node_sample_position[node], &normal = mesh_.node_normal[node];
  const auto& p = root.corners;
  const Vec3 middle = (p[0] + p[1] + p[2]) * (1.0f / 3.0f) - point;
  const float distance = middle.norm();
  if (LongestEdgeSquared(p) > kSeenSmall * kSeenSmall * distance * distance ||
      middle.dot(normal) < 0.3f * distance || -middle.dot(root.normal) < 0.3f * distance) {
    return false;
  }
  const float irradiance = LightOfTriangle(point, normal, p).irradiance;
  const Vec3 from = point + mesh_.node_sample_normal[node] * lifts_[mesh_.node_patch[node]];
  const Vec3 lift = root.normal * tracer_.LiftOfEnd(root.face, from);
  const float u0 = random.Next(), v0 = random.Next();
  const size_t first = rays_.size();
  double sum = 0;  // of up to millions
  for (int i = 0; i < samples; ++i) {
    // Plastic-number sequence (Roberts 2018), shifted at random, onto the triangle.
    float u = u0 + 0.7548777f * float(i), v = v0 + 0.5698403f * float(i);
    u = std::sqrt(u - std::floor(u));
    v = (v - std::floor(v)) * u;
    const Vec3 target = p[0] * (1 - u) + p[1] * (u - v) + p[2] * v;
    const Vec3 to = target - point;
    const float r2 = to.squaredNorm();
    const float kernel = to.dot(normal) * -to.dot(root.normal) / (r2 * r2);
    if (!(kernel > 0)) continue;  // a corner beyond one of the horizons
    sum += kernel;
    rays_.push_back({from, 0.0f, target + lift - from, 1.0f});
    deltas_.push_back({to / std::sqrt(r2), root.radiance * kernel, root_index, root.mirror});
  }
  if (!(sum > 0)) return false;
  // Together they bring what the whole triangle brings.
  for (size_t i = first; i < deltas_.size(); ++i) deltas_[i].irradiance *= float(irradiance / sum);
  return true;
}

void Receiver::Cut(uint32_t node, const ShootingField& field, int samples, float received_before,
                   uint64_t seed, Received& work) {
  const Vec3 &point = mesh_.node_sample_position[node], &normal = mesh_.node_normal[node];
  const MaterialLobes& material = materials_[mesh_.patches[mesh_.node_patch[node]].material];
  const float max_angle = material.diffuse() ? std::numeric_limits<float>::infinity()
                                             : kGlossyAngle / float(std::max(2, material.max_degree()));
  RandomStream random(Mix(seed, node));

  const auto& roots = field.roots();
  expected_.assign(roots.size(), 0.0f);
  float total = 0;
  for (uint32_t i = 0; i < roots.size(); ++i) {
    const auto& root = roots[i];
    if (settled_[i]) continue;
    if ((point - root.corners[0]).dot(root.normal) <= 0) continue;
    const float light = EstimateTriangleLight(point, normal, root.corners).irradiance;
    expected_[i] = light * std::abs(root.radiance.sum()) * (root.glossy ? kGlossyCaution : 1);
    total += expected_[i];
  }
  if (!(total > 0)) return;
  if (!material.diffuse() && !field.emission()) {
    samples = std::max(samples, int(kPerCoefficient * float(CoefficientCount(material.max_degree()))));
  }
  const float threshold = std::max(total, received_before) / float(samples);
  const float portion = kSampledBelow * threshold;
  float filled = random.Next() * portion;

  for (uint32_t i = 0; i < roots.size(); ++i) {
    if (!(expected_[i] > 0)) continue;
    const auto& root = roots[i];
    if (root.cell == kNone && expected_[i] > threshold &&
        EmitEvenly(field, i, node, int(std::ceil(kPerThreshold * expected_[i] / threshold)), random)) {
      continue;
    }
    stack_.push_back({root.corners,
                      {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()},
                      root.radiance,
                      expected_[i],
                      root.cell,
                      root.cell == kNone ? kNone : mesh_.cells[root.cell].element,
                      0});
    while (!stack_.empty()) {
      const Cell cell = stack_.back();
      stack_.pop_back();
      bool split = cell.expected > threshold;
      if (!split && cell.expected > portion && std::isfinite(max_angle)) {
        const auto& p = cell.corners;
        split = LongestEdgeSquared(p) >
                max_angle * max_angle * ((p[0] + p[1] + p[2]) / 3.0f - point).squaredNorm();
      }
      if (split && cell.depth < kMaxDepth) {
        Split(field, root, point, normal, cell);
        continue;
      }
      float weight = 1;
      if (cell.expected < portion) {
        filled += cell.expected;
        if (filled < portion) continue;
        filled -= portion;
        weight = portion / cell.expected;
      }
      Emit(field, i, node, cell, weight, random, work);
    }
  }
}

uint64_t Receiver::Trace(const ShootingField& field, size_t first) {
  occluded_.resize(rays_.size());
  const size_t count = rays_.size() - first;
  if (!field.mirrors().empty()) {
    for (size_t i = first; i < rays_.size(); ++i) {
      deltas_[i].irradiance *= ByMirror(field.mirrors()[deltas_[i].mirror], rays_[i]);
      occluded_[i] = (deltas_[i].irradiance <= 0).all();
    }
    return 2 * count;
  }
  if (!specular_.any_pane()) {
    tracer_.Occluded({rays_.data() + first, count}, {occluded_.data() + first, count}, /*coherent=*/true);
  } else {
    for (size_t i = first; i < rays_.size(); ++i) {
      const Rgb passed = specular_.SeeThrough(tracer_, rays_[i]);
      deltas_[i].irradiance *= passed;
      occluded_[i] = (passed <= 0).all();
    }
  }
  return count;
}

bool Receiver::SettlePromising(size_t first) {
  enum : uint8_t { kNotAsked, kHidden, kSeen };
  seen_.assign(expected_.size(), kNotAsked);
  for (size_t i = first; i < deltas_.size(); ++i) {
    uint8_t& seen = seen_[deltas_[i].root];
    seen = std::max<uint8_t>(seen, occluded_[i] ? kHidden : kSeen);
  }
  // What is settled already is expected to bring nothing more: Cut leaves it out.
  float bar = *std::max_element(expected_.begin(), expected_.end());
  for (;;) {
    bar *= float(kTooFewRays);
    double seen = 0, hidden = 0, promising = 0, others = 0;
    for (size_t root = 0; root < expected_.size(); ++root) {
      const double expected = expected_[root];
      (expected_[root] >= bar ? promising : others) += expected;
      if (expected_[root] < bar || seen_[root] == kNotAsked) continue;
      (seen_[root] == kSeen ? seen : hidden) += expected;
    }
    const double enough = kTooFewRays * (promising + others);
    // An infinite sum says nothing, and would never end.
    if (!(others > 0) || seen >= enough || !std::isfinite(enough)) return false;
    // Roots that no ray was for are taken to be like those that were asked.
    if (hidden > 0 && others + promising * seen / (seen + hidden) < enough) break;
  }

  size_t kept = first;
  for (size_t i = first; i < deltas_.size(); ++i) {
    if (expected_[deltas_[i].root] < bar) continue;
    deltas_[kept] = deltas_[i];
    rays_[kept] = rays_[i];
    occluded_[kept++] = occluded_[i];
  }
  deltas_.resize(kept);
  rays_.resize(kept);
  for (size_t root = 0; root < expected_.size(); ++root) settled_[root] |= expected_[root] >= bar;
  return true;
}

Received Receiver::Gather(uint32_t node, const ShootingField& field, int samples, float received_before,
                          uint64_t seed, float* out) {
  Received work;
  settled_.assign(field.roots().size(), 0);
  deltas_.clear();
  rays_.clear();
  for (int sharing = 0; sharing < kMostSharings; ++sharing) {
    const size_t first = rays_.size();
    Cut(node, field, samples, received_before, sharing == 0 ? seed : Mix(seed, uint64_t(sharing)), work);
    if (rays_.size() == first) break;
    work.rays += Trace(field, first);
    if (!SettlePromising(first)) break;
  }
  if (rays_.empty()) return work;

  const MaterialLobes& material = materials_[mesh_.patches[mesh_.node_patch[node]].material];
  const Vec3& normal = mesh_.node_normal[node];
  // In double: of a million floats, one after the other, per cents would be lost.
  using Sum = Eigen::Array3d;
  Sum delivered = Sum::Zero(), reflected = Sum::Zero(), mirrored = Sum::Zero(), through = Sum::Zero();
  const auto add = [&](const Rgb& irradiance, float cosine) {
    delivered += irradiance.cast<double>();
    if (material.sends_on()) mirrored += (irradiance * material.SentOn(cosine)).cast<double>();
    if (material.transmits()) through += (irradiance * material.TransmissionAlbedo(cosine)).cast<double>();
  };
  if (material.diffuse()) {
    for (size_t i = 0; i < deltas_.size(); ++i) {
      if (!occluded_[i]) add(deltas_[i].irradiance, deltas_[i].direction.dot(normal));
    }
    reflected = material.DiffuseAlbedo().cast<double>() * delivered;
    // Radiance albedo E / pi, as the coefficient of the constant function 1 / sqrt(2 pi).
    if (material.base.l_max >= 0) {
      for (int c = 0; c < 3; ++c) out[c] += float(reflected[c] * std::sqrt(2.0 / std::numbers::pi));
    }
  } else {
    const Frame frame(normal);
    moments_.Start(material);
    for (size_t i = 0; i < deltas_.size(); ++i) {
      if (occluded_[i]) continue;
      const Vec3 wi = frame.ToLocal(deltas_[i].direction);
      moments_.Add(wi, deltas_[i].irradiance);
      ++work.lobe_writes;
      reflected += (deltas_[i].irradiance * material.Albedo(wi.z())).cast<double>();
      add(deltas_[i].irradiance, wi.z());
    }
    moments_.Finish(out, out + 3 * material.base.count());
  }
  work.delivered = delivered.cast<float>();
  work.reflected = reflected.cast<float>();
  work.mirrored = mirrored.cast<float>();
  work.through = through.cast<float>();
  work.absorbed = work.delivered - work.reflected - work.mirrored - work.through;
  return work;
}

}  // namespace lobe
