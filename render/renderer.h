#pragma once

#include <functional>

#include "render/camera_view.h"
#include "render/image.h"
#include "solver/solution.h"

namespace lobe {

/// How eye rays near a pixel weigh in it.
enum class PixelFilter {
  kBox,             ///< the pixel's square: sharpest, and what most path tracers' references use
  kBlackmanHarris,  ///< radius 1.5 pixels (Harris 1978, 4 terms): smoother edges
};

struct RenderOptions {
  int width = 512, height = 512;
  /// The part of the picture to render, in its pixels; empty (the default): all of it. The image has the
  /// part's size, and its pixels are those of the full picture bit for bit.
  PixelRect crop = {};
  /// Eye rays per pixel, stratified; rounded up to a square.
  int samples_per_pixel = 16;
  PixelFilter filter = PixelFilter::kBox;
  int max_mirror_depth = 16;
  uint64_t seed = 1;
  /// A sentence saying what is out of range, or an empty string.
  std::string Validate() const;
  /// `crop`, or all of the picture.
  PixelRect Window() const { return crop == PixelRect{} ? PixelRect{0, 0, width, height} : crop; }
};

struct RenderReport {
  double seconds = 0;
  uint64_t rays = 0;
  /// What the picture lost, as fractions of its mean: negative lobe values clamped to zero, and light
  /// behind more mirrors than max_mirror_depth (estimated from the throughput cut).
  double clamped = 0, cut_off = 0;
  bool complete = true;  ///< false: stopped early
};

/// Renders views of one solution, which must outlive it; construction prepares what all views share.
class Renderer {
 public:
  explicit Renderer(const Solution& solution);
  ~Renderer();

  /// Stored mode: nearest hit, its three nodes' lobes read towards the eye, mirrors traced recursively.
  /// `options` and `view` must agree on the size; throws std::invalid_argument if options.Validate()
  /// complains. Filters are sampled by importance, so every eye ray counts the same. `progress` gets 0..1
  /// from one thread at a time; if it returns false the picture is abandoned (report->complete). Same bits
  /// for any number of threads.
  Image Render(const CameraView& view, const RenderOptions& options, RenderReport* report,
               const std::function<bool(double)>& progress = {}) const;

  /// Radiance arriving at the ray's origin along it, after at most the default number of mirrors.
  Rgb Radiance(const Ray& ray) const;

  /// Of the solution's scene.
  const RayTracer& tracer() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobe
