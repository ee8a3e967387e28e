#include "render/eye_shader.h"

#include <cmath>
#include <limits>

#include "render/sobol.h"

namespace lobe {
namespace {

constexpr uint64_t kReflected = 0x5ef,
                   kTransmitted = 0x72a;  // what keys are mixed with behind a mirror, glass

}  // namespace

// One way from the eye to a surface, and where to put what it brings.
struct EyeShader::Way {
  Rgb throughput = Rgb::Constant(1);
  Rgb* direct;    // emission met, and lamps' light reflected by the surface
  Rgb* indirect;  // the rest
  uint64_t key;
  int mirrors = 0;
  int panes = 0;            // of `mirrors` it does not count, since lamps are aimed at through them
  float samples = 1;        // ways among which the throughput was shared out
  bool gathered = false;    // by a diffuse or glossy surface: lobes are read wherever the way ends
  bool lamps_only = false;  // straight from there: all else was read from lobes
  float direction_pdf = 0;  // with which the gathering surface found this direction; 0: lamps not aimed at
  float travelled = 0;      // since then, through panes
  const Lamps::Choice* lamps = nullptr;  // of that surface
  MediaStack media;
};

struct EyeShader::Task {
  const RenderOptions& options;
  uint32_t sample;
  bool split;
  EyeLight light;
  Work& work;
};

EyeShader::EyeShader(const Solution& solution)
    : solution_(solution), paths_(solution.scene), stored_(solution), curved_(FindCurvedElements(solution)) {
  for (uint32_t m = 0; m < solution.scene.materials.size(); ++m) gloss_.push_back(paths_.sampler(m).Gloss());
}

EyeShader::Reading EyeShader::ReadingOf(uint32_t material, uint32_t element,
                                        const RenderOptions& options) const {
  const GlossKind kind = solution_.material_kinds[material];
  switch (options.mode) {
    case RenderMode::kStored:
      return Reading::kStored;
    case RenderMode::kDirect:
      return Reading::kDirect;
    case RenderMode::kGather:
      if (options.gather_base) return Reading::kGatherAll;
      return kind == GlossKind::kLobe || kind == GlossKind::kSharp ? Reading::kGather : Reading::kStored;
    case RenderMode::kAuto:
      if (kind == GlossKind::kSharp) return Reading::kGather;
      if (curved_.empty() || element == kNone) return Reading::kStored;
      return curved_[element] == NotStored::kGloss           ? Reading::kGather
             : curved_[element] == NotStored::kStraightLight ? Reading::kDirect
                                                             : Reading::kStored;
  }
  return Reading::kStored;
}

EyeLight EyeShader::Shade(const Ray& ray, const RayHit& hit, const RenderOptions& options,
                          const EyeSample& sample, bool split, Work& work) const {
  Task task{options, sample.index, split, {}, work};
  Way way;
  way.direct = &task.light.direct;
  way.indirect = &task.light.indirect;
  way.key = sample.pixel_key;
  Follow(ray, hit, way, task);
  return task.light;
}

void EyeShader::Follow(const Ray& ray, const RayHit& hit, Way way, Task& task) const {
  if (!hit.hit()) return;
  const uint32_t material = paths_.material(hit.face);
  const PathScene::Surface& surface = paths_.surface(hit.face);
  const SpecularSurfaces& specular = paths_.specular();
  const SpecularSurfaces::Kind kind = specular.kind(material);
  const bool inside = hit.side == Side::kBack && kind == SpecularSurfaces::Kind::kBody;
  if (hit.side == Side::kBack && !surface.double_sided && !inside) return;
  if (specular.any_body()) way.throughput *= specular.Transmittance(way.media, material, hit.side, hit.t);
  way.travelled += hit.t;
  if (!inside) Surface(ray, hit, way, task);
  if (kind == SpecularSurfaces::Kind::kNone) return;

  const HitPoint at = FindHitPoint(solution_.scene, ray, hit);
  const SpecularWays ways = specular.Continue(material, hit.side, at, -ray.direction, way.media);
  const auto go_on = [&](const SpecularWay& next_way, const MediaStack& media, bool straight) {
    if (!next_way.open()) return;
    Way next = way;
    next.throughput *= next_way.weight;
    // Shadow rays pass panes to the end, so what shares with them must, too.
    const bool shared = straight && way.direction_pdf > 0;
    const bool cut = shared ? way.panes == SpecularSurfaces::kMostPanes
                            : way.mirrors == task.options.max_mirror_depth ||
                                  next.throughput.maxCoeff() * way.samples < task.options.specular_cutoff;
    if (cut) {
      task.work.cut_off += next.throughput.sum();
      return;
    }
    ++(shared ? next.panes : next.mirrors);
    next.key = Mix(way.key, &next_way == &ways.reflection ? kReflected : kTransmitted);
    next.media = media;
    // Where a lamp was aimed at through panes, the light found this way has to share with that.
    if (!straight) next.direction_pdf = 0;
    // A gathered way stays with what its gatherer reflects.
    if (!way.gathered) {
      next.direct = next.indirect = &task.light.specular;
    } else if (!straight) {
      next.direct = way.indirect;
    }
    const Ray on = paths_.tracer().Leaving(hit.face, at.position, next_way.outward, next_way.direction);
    ++task.work.rays;
    Follow(on, paths_.tracer().Intersect(on), next, task);
  };
  if (!way.lamps_only) go_on(ways.reflection, way.media, false);
  if (!way.lamps_only || ways.straight) go_on(ways.transmission, ways.beyond, ways.straight);
}

// What leaves the surface itself: emission, and light that it scatters.
void EyeShader::Surface(const Ray& ray, const RayHit& hit, const Way& way, Task& task) const {
  const uint32_t material = paths_.material(hit.face);
  const PathScene::Surface& surface = paths_.surface(hit.face);
  const Vec3 wo = -ray.direction;
  float* basis = task.work.basis.data();
  if (paths_.Emits(hit)) {
    const float weight =
        way.direction_pdf > 0
            ? PowerWeight(way.direction_pdf, paths_.LightPdf(hit.face, wo, way.travelled, way.lamps))
            : 1;
    *way.direct += way.throughput * (weight * surface.emission);
  }
  if (way.lamps_only) return;

  const Mesh::Location where = stored_.Locate(hit);
  const auto sample = [&](const ReflectanceSampler& sampler, int samples, bool gather) {
    if (!sampler.black()) Sample(paths_.VertexAt(hit, wo), sampler, samples, gather, way, task);
  };
  switch (way.gathered ? Reading::kStored : ReadingOf(material, where.element, task.options)) {
    case Reading::kStored: {
      const Rgb direct =
          task.split && !way.gathered ? stored_.Direct(where, wo, basis).max(0.0f) : Rgb(Rgb::Zero());
      Show(stored_.Total(where, wo, basis), direct, way, task);
      break;
    }
    case Reading::kDirect: {
      const Rgb total = stored_.Total(where, wo, basis);
      Show(total - stored_.Direct(where, wo, basis), Rgb::Zero(), way, task);
      const bool few_places = task.options.mode == RenderMode::kAuto;
      sample(surface.sampler, few_places ? task.options.gather_samples : task.options.light_samples,
             /*gather=*/false);
      break;
    }
    case Reading::kGather: {
      const Rgb direct = task.split ? stored_.DirectBase(where, wo, basis).max(0.0f) : Rgb(Rgb::Zero());
      Show(stored_.Base(where, wo, basis), direct, way, task);
      sample(gloss_[material], task.options.gather_samples, /*gather=*/true);
      break;
    }
    case Reading::kGatherAll:
      sample(surface.sampler, task.options.gather_samples, /*gather=*/true);
      break;
  }
}

// Light read from lobes; `direct` of it. Negative values become zero.
void EyeShader::Show(const Rgb& read, const Rgb& direct, const Way& way, Task& task) const {
  const Rgb shown = read.max(0.0f);
  *way.direct += way.throughput * direct;
  *way.indirect += way.throughput * (shown - direct);
  task.light.clamped += way.throughput * (shown - read);
}

// Lamps are aimed at and directions drawn, equally many of both, weighed by the power heuristic.
void EyeShader::Sample(const PathScene::Vertex& vertex, const ReflectanceSampler& sampler, int samples,
                       bool gather, const Way& way, Task& task) const {
  const RayTracer& tracer = paths_.tracer();
  const SobolPoints directions(Mix(way.key, 1)), choices(Mix(way.key, 2)), places(Mix(way.key, 3));
  Way next = way;
  next.throughput /= float(samples);
  next.samples *= float(samples);
  next.gathered = true;
  next.travelled = 0;
  const Lamps::Choice lamps = paths_.ChooseLamps(vertex, sampler);
  next.lamps = &lamps;
  for (int j = 0; j < samples; ++j) {
    const uint32_t index = task.sample * uint32_t(samples) + uint32_t(j);
    const auto choice = choices.BitsAt(index);
    if (paths_.has_lamps()) {
      const auto place = places.At(index);
      const PathScene::LampSample lamp =
          paths_.SampleLamp(vertex, sampler, uint64_t(choice[0]) << 32, place[0], place[1], &lamps);
      if (lamp.light_pdf > 0) {
        ++task.work.rays;
        *way.direct += next.throughput * lamp.value * paths_.Visible(lamp.shadow, way.media.top()) *
                       PowerWeight(lamp.light_pdf, lamp.direction_pdf);
      }
    }
    const auto u = directions.At(index);
    const PathScene::Scattered scattered =
        paths_.Scatter(vertex, sampler, u[0], u[1], float(choice[1] >> 8) * 0x1p-24f);
    // Ideal reflections are followed by Follow.
    if (!scattered.alive || scattered.pdf == 0) continue;
    ++task.work.rays;
    Way found = next;
    found.throughput *= scattered.weight;
    found.key = Mix(way.key, index);
    found.direction_pdf = paths_.has_lamps() ? scattered.pdf : 0;
    found.lamps_only = !gather;
    Follow(scattered.ray, tracer.Intersect(scattered.ray), found, task);
  }
}

}  // namespace lobe
