#include "render/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "brdf/frame.h"
#include "scene/repeated_faces.h"

namespace lobe {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kRouletteAfter = 8;       // bounces
constexpr float kMostSurvival = 0.98f;  // so that a closed room of perfect mirrors comes to an end
constexpr float kLeastCosine = 0.01f;   // of the eye about an interpolated normal

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

// Power heuristic: weight of a sample of density `mine` where `other` could have found it too.
float PowerWeight(float mine, float other) {
  const float ratio = other / mine;  // densities squared may overflow, their ratio may not
  return 1 / (1 + ratio * ratio);
}

}  // namespace

PathTracer::PathTracer(const Scene& scene, const PathTracerOptions& options)
    : options_(options), tracer_(scene), specular_(scene) {
  for (const Material& m : scene.materials) {
    const auto kind = specular_.kind(uint32_t(surfaces_.size()));
    const auto* glass = m.glass() ? std::get_if<MetallicRoughness>(&m.reflectance) : nullptr;
    const float base_mean =
        glass ? (glass->UnderCoat(glass->F0()) * (glass->DiffuseColor() + glass->TransmissionColor())).mean()
              : 0.0f;
    surfaces_.push_back(
        {ReflectanceSampler(m.reflectance), m.emission, m.emits(), m.double_sided, kind, base_mean});
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

  std::vector<double> power;
  double total = 0;
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
      shade.emits[1] = back_met[f] && surface.double_sided;
      if (const int sides = shade.emits[0] + shade.emits[1]; sides > 0) {
        lamps_.push_back(f);
        power.push_back(double(surface.emission.mean()) * area * sides);
        total += power.back();
      }
    }
    faces_.push_back(shade);
  }
  if (lamps_.empty()) return;
  choose_lamp_ = AliasTable(power);
  for (size_t i = 0; i < lamps_.size(); ++i) {
    faces_[lamps_[i]].light_density = float(power[i] / total / scene.Area(scene.faces[lamps_[i]]));
  }
}

Vec3 PathTracer::ShadingNormal(const RayHit& hit, const FaceShade& face) const {
  Vec3 normal = face.normal;
  if (face.smooth != kNone) {
    const auto& n = corner_normals_[face.smooth];
    normal = ((1 - hit.u - hit.v) * n[0] + hit.u * n[1] + hit.v * n[2]).normalized();
  }
  return hit.side == Side::kFront ? normal : Vec3(-normal);
}

// Where a path scatters.
struct PathTracer::Vertex {
  Vec3 position, normal;  // of the face, on the vertex's side
  Frame frame;            // about the shading normal
  Vec3 wo_local;
  const ReflectanceSampler& sampler;
};

Rgb PathTracer::LampLight(const Vertex& vertex, uint32_t medium, RandomStream& random,
                          uint64_t* traced) const {
  const FaceShade& lamp = faces_[lamps_[choose_lamp_.Draw(random.NextBits())]];
  float u = random.Next(), v = random.Next();
  FoldSquare(&u, &v);
  const Vec3 target = lamp.corner + u * lamp.edge1 + v * lamp.edge2;
  const Vec3 way = target - vertex.position;
  const float distance2 = way.squaredNorm(), towards = -lamp.normal.dot(way);
  if (!(distance2 > 0) || towards == 0 || !lamp.emits[towards < 0]) return Rgb::Zero();

  const float distance = std::sqrt(distance2);
  const Vec3 wi = way / distance, wi_local = vertex.frame.ToLocal(wi);
  const float above = wi.dot(vertex.normal);
  if (!(above * wi_local.z() > 0) || (above < 0 && !vertex.sampler.transmits())) return Rgb::Zero();
  const ReflectanceValue value = vertex.sampler.Evaluate(vertex.wo_local, wi_local);
  if (!(value.f > 0).any()) return Rgb::Zero();

  const Vec3 from = vertex.position + vertex.normal * std::copysign(tracer_.epsilon(), above);
  const Vec3 to = target + lamp.normal * std::copysign(tracer_.epsilon(), towards);
  ++*traced;
  const Ray ray{from, 0, to - from, 1};
  Rgb emission = surfaces_[lamp.material].emission;
  if (specular_.any_pane()) {
    emission *= specular_.SeeThrough(tracer_, ray);
    if ((emission <= 0).all()) return Rgb::Zero();
  } else if (tracer_.Occluded(ray)) {
    return Rgb::Zero();
  }
  if (medium != kNone) emission *= specular_.Transmittance(medium, distance);
  const float light_pdf = lamp.light_density * distance2 * distance / std::abs(towards);
  const float weight =
      options_.light_sampling == LightSampling::kBoth ? PowerWeight(light_pdf, value.pdf) : 1;
  return value.f * emission * (weight * std::abs(wi_local.z()) / light_pdf);
}

Rgb PathTracer::Walk(const RayHit& start, const Vec3& wo_start, bool count_emission,
                     const ReflectanceSampler* first, RandomStream& random, uint64_t* rays) const {
  const bool by_light = options_.light_sampling != LightSampling::kDirections && !lamps_.empty();
  Rgb radiance = Rgb::Zero(), throughput = Rgb::Constant(1);
  RayHit hit = start;
  Vec3 wo = wo_start;
  uint64_t traced = 0;
  float direction_pdf = 0;  // of the direction that led here; 0: shadow rays could not have come here
  float way = 0;            // from where that direction began, metres
  float in_air = 1;         // radiance in air of throughput 1: what roulette goes by
  MediaStack media;
  for (int bounce = 0; hit.hit(); ++bounce) {
    const FaceShade& face = faces_[hit.face];
    const Surface& surface = surfaces_[face.material];
    const bool front = hit.side == Side::kFront;
    const bool forced = bounce == 0 && first;  // the caller says how this surface reflects
    const bool glass = surface.specular >= SpecularSurfaces::Kind::kPane && !forced;
    const bool inside = !front && glass && surface.specular == SpecularSurfaces::Kind::kBody;
    if (!front && !surface.double_sided && !forced && !inside) break;
    way += hit.t;
    if (specular_.any_body()) {
      throughput *= specular_.Transmittance(media, face.material, hit.side, hit.t);
    }
    if (surface.emits && (bounce > 0 || count_emission) && (front || surface.double_sided)) {
      float weight = 1;
      if (direction_pdf > 0 && by_light) {
        const float light_pdf = face.light_density * way * way / std::abs(face.normal.dot(wo));
        weight = options_.light_sampling == LightSampling::kBoth ? PowerWeight(direction_pdf, light_pdf) : 0;
      }
      radiance += throughput * (weight * surface.emission);
    }
    const ReflectanceSampler& sampler = forced ? *first : surface.sampler;
    if ((sampler.black() && !glass) || bounce >= options_.max_bounces) break;

    const Vec3 normal = front ? face.normal : Vec3(-face.normal);
    const Vec3 position = face.corner + hit.u * face.edge1 + hit.v * face.edge2;
    Vec3 shading_normal = normal;
    if (face.smooth != kNone) {
      shading_normal = ShadingNormal(hit, face);
      const float cosine = shading_normal.dot(wo);
      if (cosine < kLeastCosine)
        shading_normal = (shading_normal + (kLeastCosine - cosine) * wo).normalized();
    }
    const Frame frame(shading_normal);
    const Vertex vertex{position, normal, frame, frame.ToLocal(wo), sampler};
    const bool has_base = !glass || (!inside && surface.base_mean > 0);
    if (by_light && has_base) radiance += throughput * LampLight(vertex, media.top(), random, &traced);

    Vec3 wi;
    float above = 0;
    bool scattered = true;
    Rgb reflected = Rgb::Zero();  // by glass
    if (glass) {
      const SpecularWays ways =
          specular_.Continue(face.material, hit.side, {position, normal, shading_normal}, wo, media);
      reflected = ways.reflection.weight;
      const float passes = ways.transmission.weight.mean() / ways.basic;
      const float stays = reflected.mean() + (has_base ? surface.base_mean : 0.0f);
      if (!(passes + stays > 0)) break;
      const float chance = passes / (passes + stays);
      const bool through = random.Next() < chance;
      throughput /= through ? chance : 1 - chance;
      scattered = !through && has_base;
      if (!scattered) {
        const SpecularWay& on = through ? ways.transmission : ways.reflection;
        throughput *= on.weight;
        wi = on.direction;
        above = wi.dot(normal);
      }
      if (through) {
        media = ways.beyond;
        in_air /= ways.basic;
      }
      if (!through || !ways.straight) direction_pdf = way = 0;
    }
    if (scattered) {
      const float u1 = random.Next(), u2 = random.Next(), u3 = random.Next();
      const SampledDirection next = sampler.Sample(vertex.wo_local, u1, u2, u3);
      if (!(next.pdf > 0)) break;
      // In other glass a coat reflects otherwise than the sampler knows.
      throughput *= next.delta && glass ? Rgb(reflected / next.pdf) : next.weight;
      wi = frame.ToWorld(next.wi);
      above = wi.dot(normal);
      if (next.delta && above < kLeastLift) {
        // The reflection about an interpolated normal points into the face.
        wi = (wi + (kLeastLift - above) * normal).normalized();
        above = kLeastLift;
      }
      if (!(above * next.wi.z() > 0)) break;
      direction_pdf = next.delta ? 0 : next.pdf;
      way = 0;
    }
    if (bounce >= kRouletteAfter) {
      const float survival = std::min(throughput.maxCoeff() * in_air, kMostSurvival);
      if (!(random.Next() < survival)) break;
      throughput /= survival;
    }
    hit = tracer_.Intersect({position + normal * std::copysign(tracer_.epsilon(), above), 0, wi, kInfinity});
    ++traced;
    wo = -wi;
  }
  if (rays) *rays += traced;
  return radiance;
}

Rgb PathTracer::Radiance(const Ray& ray, RandomStream& random, uint64_t* rays) const {
  if (rays) ++*rays;
  return RadianceFrom(tracer_.Intersect(ray), -ray.direction, random, rays);
}

Rgb PathTracer::RadianceFrom(const RayHit& hit, const Vec3& wo, RandomStream& random, uint64_t* rays) const {
  return Walk(hit, wo, /*count_emission=*/true, nullptr, random, rays);
}

template <typename Sample>
Estimate PathTracer::Average(int samples, uint64_t seed, const Sample& sample) const {
  if (samples < 2) throw std::invalid_argument("an estimate with its error needs at least 2 samples");
  // Chunks of samples are summed in their order, whichever thread made them.
  constexpr int kChunk = 256;
  struct Sums {
    Eigen::Array3d first = Eigen::Array3d::Zero(), second = Eigen::Array3d::Zero();
  };
  std::vector<Sums> chunks((samples + kChunk - 1) / kChunk);
  tbb::parallel_for(size_t(0), chunks.size(), [&](size_t c) {
    RandomStream random(Mix(Mix(seed, 0x9a7), c));
    const int count = std::min(kChunk, samples - int(c) * kChunk);
    for (int i = 0; i < count; ++i) {
      const Eigen::Array3d x = sample(random).template cast<double>();
      chunks[c].first += x;
      chunks[c].second += x * x;
    }
  });
  Sums all;
  for (const Sums& c : chunks) {
    all.first += c.first;
    all.second += c.second;
  }
  Estimate out;
  out.mean = all.first / samples;
  const Eigen::Array3d variance = ((all.second - samples * out.mean * out.mean) / (samples - 1)).max(0.0);
  out.standard_error = (variance / samples).sqrt();
  return out;
}

Estimate PathTracer::ExitantRadiance(const SurfacePoint& at, const Vec3& wo, int samples,
                                     uint64_t seed) const {
  const float cosine = faces_.at(at.face).normal.dot(wo) * (at.side == Side::kFront ? 1.0f : -1.0f);
  if (!(cosine > 0)) throw std::invalid_argument("wo is not above the side of the face it is to leave");
  const RayHit hit{at.face, 0, at.u, at.v, at.side};
  return Average(samples, seed, [&](RandomStream& random) {
    return Walk(hit, wo, /*count_emission=*/false, nullptr, random, nullptr);
  });
}

Estimate PathTracer::Irradiance(const SurfacePoint& at, int samples, uint64_t seed) const {
  // The radiance of a white Lambertian surface in its place, times pi.
  static const ReflectanceSampler white(Lambert{Rgb::Constant(1)});
  const RayHit hit{at.face, 0, at.u, at.v, at.side};
  const Vec3 wo = ShadingNormal(hit, faces_.at(at.face));
  Estimate out = Average(samples, seed, [&](RandomStream& random) {
    return Walk(hit, wo, /*count_emission=*/false, &white, random, nullptr);
  });
  out.mean *= std::numbers::pi;
  out.standard_error *= std::numbers::pi;
  return out;
}

}  // namespace lobe
