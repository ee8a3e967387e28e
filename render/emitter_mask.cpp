#include "render/emitter_mask.h"

#include <algorithm>

#include <tbb/enumerable_thread_specific.h>

#include "render/eye_rays.h"

namespace lobe {
namespace {

constexpr int kGrowth = 2;

bool Emits(const Scene& scene, const RayHit& hit) {
  if (!hit.hit()) return false;
  const Material& material = scene.materials[scene.faces[hit.face].material];
  return hit.side == Side::kFront ? material.emits() : material.emits_behind();
}

}  // namespace

Mask EmitterMask(const Scene& scene, const RayTracer& tracer, const CameraView& view,
                 const RenderOptions& options) {
  const EyeRays eye_rays(view, options);
  const PixelRect window = options.Window();
  RenderOptions wider = options;
  wider.crop = {std::max(window.x0 - kGrowth, 0), std::max(window.y0 - kGrowth, 0),
                std::min(window.x1 + kGrowth, options.width), std::min(window.y1 + kGrowth, options.height)};
  const PixelRect seen = wider.crop;
  std::vector<uint8_t> emitter(size_t(seen.width()) * seen.height(), 0);  // bits would be shared by threads

  tbb::enumerable_thread_specific<PixelRays> scratches;
  ForEachTile(wider, kSmallTile,
              [&](const Tile& tile) {
                PixelRays& pixel = scratches.local();
                const PixelRect part = Intersection(tile.rect(), seen);
                for (int y = part.y0; y < part.y1; ++y) {
                  for (int x = part.x0; x < part.x1; ++x) {
                    pixel.Trace(eye_rays, tracer, x, y);
                    emitter[size_t(y - seen.y0) * seen.width() + (x - seen.x0)] =
                        std::any_of(pixel.hits.begin(), pixel.hits.end(),
                                    [&](const RayHit& hit) { return Emits(scene, hit); });
                  }
                }
              },
              {});

  Mask mask{window.width(), window.height(), {}};
  mask.set.resize(size_t(mask.width) * mask.height);
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x) {
      bool set = false;
      for (int v = std::max(y - kGrowth, seen.y0); v <= std::min(y + kGrowth, seen.y1 - 1); ++v) {
        for (int u = std::max(x - kGrowth, seen.x0); u <= std::min(x + kGrowth, seen.x1 - 1); ++u) {
          set = set || emitter[size_t(v - seen.y0) * seen.width() + (u - seen.x0)];
        }
      }
      mask.set[size_t(y - window.y0) * mask.width + (x - window.x0)] = set;
    }
  }
  return mask;
}

}  // namespace lobe
