#pragma once

#include <cstdint>

#include "render/path_scene.h"
#include "solver/hash.h"

namespace lobe {

/// Which of the two ways to meet a lamp is used. All three have the same mean; the single ones are second
/// opinions for tests, and noisy: lights alone near lamps and on sharp gloss, directions alone with small
/// lamps.
enum class LightSampling {
  kBoth,        ///< multiple importance sampling
  kLights,      ///< shadow rays to points of lamps; lamps in mirrors are seen by the mirror's ray
  kDirections,  ///< whatever rays drawn from the reflectance hit
};

struct PathTracerOptions {
  LightSampling light_sampling = LightSampling::kBoth;
  /// Scatterings of a path at most; 1: direct light alone. The default is a guard against hanging, not
  /// a limit: paths live on with at most 98 % a bounce, so one in 1e87 gets there.
  int max_bounces = 10000;
};

/// A point of one side of a face, at barycentrics (1 - u - v, u, v).
struct SurfacePoint {
  uint32_t face;
  Side side = Side::kFront;
  float u = 1.0f / 3, v = 1.0f / 3;
};

/// A mean of independent samples and the standard error of that mean, per channel.
struct Estimate {
  Eigen::Array3d mean = Eigen::Array3d::Zero(), standard_error = Eigen::Array3d::Zero();
};

/// Light of a scene by path tracing, without lobes: the yardstick solutions are checked with.
///
/// Unbiased (Kajiya, "The Rendering Equation", SIGGRAPH 1986): directions drawn from the reflectance, shadow
/// rays to points drawn evenly from emitting triangles that were chosen by power, the two combined by the
/// power heuristic (Veach and Guibas, "Optimally Combining Sampling Techniques", SIGGRAPH 1995); Russian
/// roulette by throughput after 8 bounces; nothing is clamped. The models are those of brdf/reflectance.h to
/// the letter, so they may reflect more than arrives where these do (docs/conventions.md#gltf-albedo).
///
/// Backs are black and opaque; doubleSided faces have two sides, and thin sheets pass light from one of them
/// to the other. Interpolated normals: render/path_scene.h.
///
/// Glass is ideal (scene/specular.h). Reflection, transmission and base are chosen by their weights. Straight
/// ways through panes keep the density of the direction they began with, so that lamps behind panes are met
/// both by directions and by shadow rays; what has been refracted only by directions.
///
/// Keeps what it needs of the scene. Const methods may run in many threads.
class PathTracer {
 public:
  explicit PathTracer(const Scene& scene, const PathTracerOptions& options = {});

  /// One sample of the radiance arriving at the ray's origin along it; its direction is unit. `rays`, if
  /// given, is increased by the rays traced.
  Rgb Radiance(const Ray& ray, RandomStream& random, uint64_t* rays = nullptr) const;
  /// The same for a ray already traced; `wo` points back along it.
  Rgb RadianceFrom(const RayHit& hit, const Vec3& wo, RandomStream& random, uint64_t* rays = nullptr) const;

  /// Radiance leaving a point towards `wo` (world, unit), without the surface's own emission: what a lobe
  /// holds. Same bits for any number of threads. Throws std::invalid_argument if wo is not above the
  /// point's side, or if samples < 2.
  Estimate ExitantRadiance(const SurfacePoint& at, const Vec3& wo, int samples, uint64_t seed = 1) const;
  /// Irradiance of a point, about its shading normal, W m^-2; of black backs too.
  Estimate Irradiance(const SurfacePoint& at, int samples, uint64_t seed = 1) const;

  const RayTracer& tracer() const { return scene_.tracer(); }

 private:
  struct WalkState;

  // One sample of the light straight from lamps, scattered towards the vertex's wo; weighed against
  // directions. It comes through `medium`, and through panes.
  Rgb LampLight(const PathScene::Vertex& vertex, const ReflectanceSampler& sampler, uint32_t medium,
                RandomStream& random, uint64_t* traced) const;
  bool PassGlass(const PathScene::Vertex& vertex, const RayHit& hit, const Vec3& wo, bool has_base,
                 RandomStream& random, WalkState* walk, PathScene::Scattered* next) const;
  // One path. `first`: how the surface it starts from scatters, if not as its material says.
  Rgb Walk(const RayHit& start, const Vec3& wo, bool count_emission, const ReflectanceSampler* first,
           RandomStream& random, uint64_t* rays) const;
  template <typename Sample>
  Estimate Average(int samples, uint64_t seed, const Sample& sample) const;

  PathTracerOptions options_;
  PathScene scene_;
};

}  // namespace lobe
