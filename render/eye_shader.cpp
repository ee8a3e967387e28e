#include "render/eye_shader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/sobol.h"
#include "scene/mirror.h"

namespace lobe {
namespace {

constexpr uint64_t kReflected = 0x5ef;  // what keys are mixed with behind a mirror

}  // namespace

// One way from the eye to a surface, and where to put what it brings.
struct EyeShader::Way {
  Rgb throughput = Rgb::Constant(1);
  Rgb* direct;    // emission met, and lamps' light reflected by the surface
  Rgb* indirect;  // the rest
  uint64_t key;
  int mirrors = 0;
  bool gathered = false;    // by a diffuse or glossy surface: lobes are read wherever the way ends
  float direction_pdf = 0;  // with which the gathering surface found this direction; 0: lamps not aimed at
};

struct EyeShader::Task {
  const RenderOptions& options;
  uint32_t sample;
  bool split;
  EyeLight light;
  Work& work;
};

EyeShader::EyeShader(const Solution& solution)
    : solution_(solution), paths_(solution.scene), stored_(solution) {
  for (const Material& m : solution.scene.materials) {
    gloss_.push_back(ReflectanceSampler(m.reflectance).Gloss());
  }
}

EyeShader::Reading EyeShader::ReadingOf(uint32_t material, const RenderOptions& options) const {
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
      return kind == GlossKind::kSharp ? Reading::kGather : Reading::kStored;
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

void EyeShader::Follow(const Ray& ray, const RayHit& hit, const Way& way, Task& task) const {
  if (!hit.hit()) return;
  const uint32_t material = paths_.material(hit.face);
  const PathScene::Surface& surface = paths_.surface(hit.face);
  if (hit.side == Side::kBack && !surface.double_sided) return;
  const Vec3 wo = -ray.direction;
  if (surface.emits) {
    const float weight = way.direction_pdf > 0 ? PowerWeight(way.direction_pdf, paths_.LightPdf(hit, wo)) : 1;
    *way.direct += way.throughput * (weight * surface.emission);
  }

  const Mesh::Location where = stored_.Locate(hit);
  switch (way.gathered ? Reading::kStored : ReadingOf(material, task.options)) {
    case Reading::kStored:
      Read(where, wo, task.split && !way.gathered, way, task);
      break;
    case Reading::kDirect: {
      const Rgb rest = stored_.Total(where, wo, task.work.basis.data()) -
                       stored_.Direct(where, wo, task.work.basis.data());
      *way.indirect += way.throughput * rest.max(0.0f);
      task.light.clamped += way.throughput * (rest.max(0.0f) - rest);
      if (!surface.sampler.black()) {
        Sample(paths_.VertexAt(hit, wo), surface.sampler, task.options.light_samples, /*gather=*/false, way,
               task);
      }
      break;
    }
    case Reading::kGather: {
      const Rgb base = stored_.Base(where, wo, task.work.basis.data());
      const Rgb direct =
          task.split ? stored_.DirectBase(where, wo, task.work.basis.data()).max(0.0f) : Rgb(Rgb::Zero());
      *way.direct += way.throughput * direct;
      *way.indirect += way.throughput * (base.max(0.0f) - direct);
      task.light.clamped += way.throughput * (base.max(0.0f) - base);
      Sample(paths_.VertexAt(hit, wo), gloss_[material], task.options.gather_samples, /*gather=*/true, way,
             task);
      break;
    }
    case Reading::kGatherAll:
      if (!surface.sampler.black()) {
        Sample(paths_.VertexAt(hit, wo), surface.sampler, task.options.gather_samples, /*gather=*/true, way,
               task);
      }
      break;
  }

  if (solution_.material_kinds[material] != GlossKind::kMirror) return;
  const HitPoint at = FindHitPoint(solution_.scene, solution_.mesh, ray, hit, where);
  const float cosine = std::clamp(wo.dot(at.normal), 0.0f, 1.0f);
  Way next = way;
  next.throughput *=
      std::get<MetallicRoughness>(solution_.scene.materials[material].reflectance).Fresnel(cosine);
  if ((next.throughput <= 0).all()) return;
  if (way.mirrors == task.options.max_mirror_depth) {
    task.work.cut_off += next.throughput.sum();
    return;
  }
  ++next.mirrors;
  next.key = Mix(way.key, kReflected);
  next.direction_pdf = 0;
  // A gathered way stays with what its gatherer reflects.
  next.direct = next.indirect = way.gathered ? way.indirect : &task.light.specular;
  const Ray reflected{at.position + at.geometric_normal * paths_.tracer().epsilon(), 0.0f,
                      MirrorDirection(wo, at), std::numeric_limits<float>::infinity()};
  ++task.work.rays;
  Follow(reflected, paths_.tracer().Intersect(reflected), next, task);
}

void EyeShader::Read(const Mesh::Location& where, const Vec3& wo, bool split, const Way& way,
                     Task& task) const {
  const Rgb total = stored_.Total(where, wo, task.work.basis.data());
  const Rgb shown = total.max(0.0f);
  const Rgb direct = split ? stored_.Direct(where, wo, task.work.basis.data()).max(0.0f) : Rgb(Rgb::Zero());
  *way.direct += way.throughput * direct;
  *way.indirect += way.throughput * (shown - direct);
  task.light.clamped += way.throughput * (shown - total);
}

// Lamps are aimed at and directions drawn, equally many of both, weighed by the power heuristic.
void EyeShader::Sample(const PathScene::Vertex& vertex, const ReflectanceSampler& sampler, int samples,
                       bool gather, const Way& way, Task& task) const {
  const RayTracer& tracer = paths_.tracer();
  const SobolPoints directions(Mix(way.key, 1)), choices(Mix(way.key, 2)), places(Mix(way.key, 3));
  Way next = way;
  next.throughput /= float(samples);
  next.gathered = true;
  for (int j = 0; j < samples; ++j) {
    const uint32_t index = task.sample * uint32_t(samples) + uint32_t(j);
    const auto choice = choices.BitsAt(index);
    if (paths_.has_lamps()) {
      const auto place = places.At(index);
      const PathScene::LampSample lamp =
          paths_.SampleLamp(vertex, sampler, uint64_t(choice[0]) << 32, place[0], place[1]);
      if (lamp.light_pdf > 0) {
        ++task.work.rays;
        if (!tracer.Occluded(lamp.shadow)) {
          *way.direct += next.throughput * lamp.value * PowerWeight(lamp.light_pdf, lamp.direction_pdf);
        }
      }
    }
    const auto u = directions.At(index);
    const PathScene::Scattered scattered =
        paths_.Scatter(vertex, sampler, u[0], u[1], float(choice[1] >> 8) * 0x1p-24f);
    // Ideal reflections are followed by Follow.
    if (!scattered.alive || scattered.pdf == 0) continue;
    ++task.work.rays;
    const RayHit hit = tracer.Intersect(scattered.ray);
    if (!hit.hit()) continue;
    Way found = next;
    found.throughput *= scattered.weight;
    found.key = Mix(way.key, index);
    found.direction_pdf = paths_.has_lamps() ? scattered.pdf : 0;
    if (gather) {
      Follow(scattered.ray, hit, found, task);
    } else if (paths_.Emits(hit)) {
      const float weight = PowerWeight(scattered.pdf, paths_.LightPdf(hit, -scattered.ray.direction));
      *way.direct += found.throughput * (weight * paths_.surface(hit.face).emission);
    }
  }
}

}  // namespace lobe
