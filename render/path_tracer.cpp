#include "render/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <tbb/parallel_for.h>

namespace lobe {
namespace {

constexpr int kRouletteAfter = 8;       // bounces
constexpr float kMostSurvival = 0.98f;  // so that a closed room of perfect mirrors comes to an end

}  // namespace

struct PathTracer::WalkState {
  Rgb throughput = Rgb::Constant(1);
  float direction_pdf = 0;  // of the direction that led here; 0: shadow rays could not have come here
  float distance = 0;       // from where that direction began, through panes
  float in_air = 1;         // radiance in air of throughput 1: what roulette goes by
  MediaStack media;

  void Start(float pdf) {
    direction_pdf = pdf;
    distance = 0;
  }
};

PathTracer::PathTracer(const Scene& scene, const PathTracerOptions& options)
    : options_(options), scene_(scene) {}

Rgb PathTracer::LampLight(const PathScene::Vertex& vertex, const ReflectanceSampler& sampler, uint32_t medium,
                          RandomStream& random, uint64_t* traced) const {
  const uint64_t lamp = random.NextBits();
  const float u = random.Next(), v = random.Next();
  const PathScene::LampSample sample = scene_.SampleLamp(vertex, sampler, lamp, u, v);
  if (sample.light_pdf == 0) return Rgb::Zero();
  ++*traced;
  const Rgb light = sample.value * scene_.Visible(sample.shadow, medium);
  return options_.light_sampling == LightSampling::kBoth
             ? Rgb(light * PowerWeight(sample.light_pdf, sample.direction_pdf))
             : light;
}

// One way on from glass: reflected or transmitted, or scattered by its base.
bool PathTracer::PassGlass(const PathScene::Vertex& vertex, const RayHit& hit, const Vec3& wo, bool has_base,
                           RandomStream& random, WalkState* walk, PathScene::Scattered* next) const {
  const PathScene::Surface& surface = scene_.surface(hit.face);
  const HitPoint at{vertex.position, vertex.normal, vertex.frame.z};
  const SpecularWays ways =
      scene_.specular().Continue(scene_.material(hit.face), hit.side, at, wo, walk->media);
  const Rgb reflected = ways.reflection.weight;
  const float passes = ways.transmission.weight.mean() / ways.basic;
  const float stays = reflected.mean() + (has_base ? surface.base_mean : 0.0f);
  if (!(passes + stays > 0)) return false;
  const float chance = passes / (passes + stays);
  const bool through = random.Next() < chance;
  walk->throughput /= through ? chance : 1 - chance;
  if (!through && has_base) {
    const float u1 = random.Next(), u2 = random.Next(), u3 = random.Next();
    *next = scene_.Scatter(vertex, surface.sampler, u1, u2, u3);
    // In other glass a coat reflects otherwise than the sampler knows.
    if (next->delta_chance > 0) next->weight = reflected / next->delta_chance;
    walk->Start(next->pdf);
    return next->alive;
  }
  const SpecularWay& on = through ? ways.transmission : ways.reflection;
  next->weight = on.weight;
  next->ray = {vertex.position + on.outward * vertex.lift, 0, on.direction,
               std::numeric_limits<float>::infinity()};
  if (through) {
    walk->media = ways.beyond;
    walk->in_air /= ways.basic;
  }
  if (!through || !ways.straight) walk->Start(0);
  return true;
}

Rgb PathTracer::Walk(const RayHit& start, const Vec3& wo_start, bool count_emission,
                     const ReflectanceSampler* first, RandomStream& random, uint64_t* rays) const {
  const bool by_light = options_.light_sampling != LightSampling::kDirections && scene_.has_lamps();
  Rgb radiance = Rgb::Zero();
  WalkState walk;
  RayHit hit = start;
  Vec3 wo = wo_start;
  uint64_t traced = 0;
  for (int bounce = 0; hit.hit(); ++bounce) {
    const PathScene::Surface& surface = scene_.surface(hit.face);
    const bool forced = bounce == 0 && first;  // the caller says how this surface reflects
    const bool front = hit.side == Side::kFront;
    const bool glass = surface.specular >= SpecularSurfaces::Kind::kPane && !forced;
    const bool inside = !front && glass && surface.specular == SpecularSurfaces::Kind::kBody;
    if (!front && !surface.double_sided && !forced && !inside) break;
    walk.distance += hit.t;
    if (scene_.specular().any_body()) {
      walk.throughput *=
          scene_.specular().Transmittance(walk.media, scene_.material(hit.face), hit.side, hit.t);
    }
    if (scene_.Emits(hit) && (bounce > 0 || count_emission)) {
      float weight = 1;
      if (walk.direction_pdf > 0 && by_light) {
        weight = options_.light_sampling == LightSampling::kBoth
                     ? PowerWeight(walk.direction_pdf, scene_.LightPdf(hit.face, wo, walk.distance))
                     : 0;
      }
      radiance += walk.throughput * (weight * surface.emission);
    }
    const ReflectanceSampler& sampler = forced ? *first : surface.sampler;
    if ((sampler.black() && !glass) || bounce >= options_.max_bounces) break;

    const PathScene::Vertex vertex = scene_.VertexAt(hit, wo);
    const bool has_base = !glass || (!inside && surface.base_mean > 0);
    if (by_light && has_base) {
      radiance += walk.throughput * LampLight(vertex, sampler, walk.media.top(), random, &traced);
    }
    PathScene::Scattered next;
    if (glass) {
      if (!PassGlass(vertex, hit, wo, has_base, random, &walk, &next)) break;
    } else {
      const float u1 = random.Next(), u2 = random.Next(), u3 = random.Next();
      next = scene_.Scatter(vertex, sampler, u1, u2, u3);
      if (!next.alive) break;
      walk.Start(next.pdf);
    }
    walk.throughput *= next.weight;
    if (bounce >= kRouletteAfter) {
      const float survival = std::min(walk.throughput.maxCoeff() * walk.in_air, kMostSurvival);
      if (!(random.Next() < survival)) break;
      walk.throughput /= survival;
    }
    hit = scene_.tracer().Intersect(next.ray);
    ++traced;
    wo = -next.ray.direction;
  }
  if (rays) *rays += traced;
  return radiance;
}

Rgb PathTracer::Radiance(const Ray& ray, RandomStream& random, uint64_t* rays) const {
  if (rays) ++*rays;
  return RadianceFrom(scene_.tracer().Intersect(ray), -ray.direction, random, rays);
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
  const float cosine = scene_.FaceNormal(at.face).dot(wo) * (at.side == Side::kFront ? 1.0f : -1.0f);
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
  const Vec3 wo = scene_.ShadingNormal(hit);
  Estimate out = Average(samples, seed, [&](RandomStream& random) {
    return Walk(hit, wo, /*count_emission=*/false, &white, random, nullptr);
  });
  out.mean *= std::numbers::pi;
  out.standard_error *= std::numbers::pi;
  return out;
}

}  // namespace lobe
