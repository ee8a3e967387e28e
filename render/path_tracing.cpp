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

  struct Scratch {
    std::vector<Ray> rays;
    std::vector<RayHit> hits;
  };
  tbb::enumerable_thread_specific<Scratch> scratches;
  std::vector<uint64_t> traced(TileCount(options, kSmallTile), 0);

  const auto render_tile = [&](const Tile& tile) {
    Scratch& scratch = scratches.local();
    uint64_t rays = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        if (!window.Contains(x, y)) continue;  // a pixel's paths depend on nothing beside it
        scratch.rays.clear();
        eye_rays.Append(x, y, &scratch.rays);
        scratch.hits.resize(scratch.rays.size());
        paths.tracer().Intersect(scratch.rays, scratch.hits, /*coherent=*/true);
        rays += scratch.rays.size();
        RandomStream random(Mix(Mix(options.seed, 0x9a7b), uint64_t(y) * options.width + x));
        Eigen::Array3d sum = Eigen::Array3d::Zero();
        for (int s = 0; s < samples; ++s) {
          sum +=
              paths.RadianceFrom(scratch.hits[s], -scratch.rays[s].direction, random, &rays).cast<double>();
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
