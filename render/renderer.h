#pragma once

#include <functional>

#include "render/camera_view.h"
#include "render/image.h"
#include "render/layers.h"
#include "solver/solution.h"

namespace lobe {

/// How eye rays near a pixel weigh in it.
enum class PixelFilter {
  kBox,             ///< the pixel's square: sharpest, and what most path tracers' references use
  kBlackmanHarris,  ///< radius 1.5 pixels (Harris 1978, 4 terms): smoother edges
};

/// Where a picture's light comes from.
enum class RenderMode {
  kStored,  ///< lobes, read towards the eye
  kDirect,  ///< lamps are sampled at every eye ray's end: crisp shadows; the rest is read from lobes
  kGather,  ///< gloss is traced from there until it meets lobes; the base is read
  kAuto,    ///< gather for materials too sharp for their lobes, stored for the others
};

struct RenderOptions {
  int width = 512, height = 512;
  /// The part of the picture to render, in its pixels; empty (the default): all of it. The image has the
  /// part's size, and its pixels are those of the full picture bit for bit.
  PixelRect crop = {};
  /// Eye rays per pixel, stratified; rounded up to a square.
  int samples_per_pixel = 16;
  PixelFilter filter = PixelFilter::kBox;
  /// Mirrors and glass surfaces in a row that are followed, and the least throughput (largest channel) with
  /// which a way by them is followed on. What is lost: RenderReport::cut_off.
  int max_mirror_depth = 16;
  float specular_cutoff = 1e-3f;
  RenderMode mode = RenderMode::kAuto;
  int light_samples = 1;     ///< per eye ray, in mode direct
  int gather_samples = 4;    ///< per eye ray and gathered surface; powers of two spread best
  bool gather_base = false;  ///< in mode gather: trace all that is reflected, of every material
  uint64_t seed = 1;
  /// A sentence saying what is out of range, or an empty string.
  std::string Validate() const;
  /// `crop`, or all of the picture.
  PixelRect Window() const { return crop == PixelRect{} ? PixelRect{0, 0, width, height} : crop; }
};

struct RenderReport {
  double seconds = 0;
  uint64_t rays = 0;          ///< of all kinds
  int samples_per_pixel = 0;  ///< eye rays, rounded up
  /// What the picture lost, as fractions of its mean: negative lobe values clamped to zero, and light
  /// by way of mirrors and glass that was not followed to its end (as if it were as bright as the mean).
  double clamped = 0, cut_off = 0;
  bool complete = true;  ///< false: stopped early
};

/// Renders views of one solution, which must outlive it; construction prepares what all views share.
class Renderer {
 public:
  explicit Renderer(const Solution& solution);
  ~Renderer();

  /// `options` and `view` must agree on the size; throws std::invalid_argument if options.Validate()
  /// complains. Filters are sampled by importance, so every eye ray counts the same. `progress` gets 0..1
  /// from one thread at a time; if it returns false the picture is abandoned (report->complete). Same bits
  /// for any number of threads.
  Image Render(const CameraView& view, const RenderOptions& options, RenderReport* report,
               const std::function<bool(double)>& progress = {}) const;

  /// The same with layers. With any of them every lobe is read where it is needed, not interpolated over the
  /// film (FilmGrid::kTolerance).
  LayeredImage Render(const CameraView& view, const RenderOptions& options, const LayerSet& wanted,
                      RenderReport* report, const std::function<bool(double)>& progress = {}) const;

  /// Radiance arriving at the ray's origin along it, after at most the default number of mirrors.
  Rgb Radiance(const Ray& ray) const;

  /// Of the solution's scene.
  const RayTracer& tracer() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobe
