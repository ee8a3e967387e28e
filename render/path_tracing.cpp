#include "render/path_tracing.h"

#include <chrono>

#include <tbb/enumerable_thread_specific.h>

#include "render/eye_rays.h"

namespace lobe {

Image RenderPathTraced(const PathTracer& paths, const CameraView& view, const RenderOptions& options,
                       RenderReport* report, const std::function<bool(double)>& progress) {
  const auto start = std::chrono::steady_clock::now();
  const EyeRays eye_rays(view, options);
  const int samples = eye_rays.per_pixel();
  const PixelRect window = options.Window();
  Image image(window.width(), window.height());

  tbb::enumerable_thread_specific<PixelRays> scratches;
  std::vector<uint64_t> traced(TileCount(options, kSmallTile), 0);

  const auto render_tile = [&](const Tile& tile) {
    PixelRays& pixel = scratches.local();
    uint64_t rays = 0;
    // A pixel's paths depend on nothing beside it.
    const PixelRect part = Intersection(tile.rect(), window);
    for (int y = part.y0; y < part.y1; ++y) {
      for (int x = part.x0; x < part.x1; ++x) {
        pixel.Trace(eye_rays, paths.tracer(), x, y);
        rays += pixel.rays.size();
        RandomStream random(Mix(Mix(options.seed, 0x9a7b), uint64_t(y) * options.width + x));
        Eigen::Array3d sum = Eigen::Array3d::Zero();
        for (int s = 0; s < samples; ++s) {
          sum += paths.RadianceFrom(pixel.hits[s], -pixel.rays[s].direction, random, &rays).cast<double>();
        }
        image.at(x - window.x0, y - window.y0) = (sum / samples).cast<float>();
      }
    }
    traced[tile.index] = rays;
  };
  const bool complete = ForEachTile(options, kSmallTile, render_tile, progress);

  if (report) {
    *report = {};
    for (const uint64_t rays : traced) report->rays += rays;
    report->samples_per_pixel = samples;
    report->complete = complete;
    report->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return image;
}

}  // namespace lobe
