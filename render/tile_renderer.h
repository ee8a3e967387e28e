#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "render/eye_rays.h"
#include "render/image.h"
#include "scene/element_locator.h"
#include "scene/ray_tracer.h"
#include "solver/solution.h"

namespace lobe {

/// Tiles of pictures of a solution: makes eye rays, traces and shades them packet by packet and sums them up
/// by pixel. Stored light is read here (render/packet_light.h); for every other ray a general function is
/// asked. Nothing is allocated per tile, and nothing kept of a packet.
class TileRenderer {
 public:
  /// `handled[2 * material + side]`: 1 where what the eye sees is the light stored on that side, plus the
  /// material's emission; `except[element]`: 1 for elements where it is not; empty: none. The solution, the
  /// tracer of its scene and the locator of its mesh must outlive this.
  TileRenderer(const Solution& solution, const RayTracer& tracer, const ElementLocator& locator,
               std::vector<uint8_t> handled, std::vector<uint8_t> except = {});
  ~TileRenderer();

  /// Radiance along an eye ray that hit something not handled: a sample of pixel (x, y).
  using General = std::function<Rgb(const Ray& ray, const RayHit& hit, int x, int y, int sample)>;
  struct Sums {
    double clamped = 0, shown = 0;  ///< over channels and rays; clamped by `general` is its own business
    uint64_t rays = 0;              ///< eye rays traced
  };
  /// Fills the tile's pixels that lie in `window`, which is the part of the picture that `image` is; but
  /// reads the whole tile, or an edge between elements might be seen otherwise, and counts it in `sums`. Many
  /// threads may render at once; same bits whatever their number. `general` may not call this again.
  void Render(const EyeRays& eye_rays, const Tile& tile, const PixelRect& window, const General& general,
              Image* image, Sums* sums) const;

  /// Pixels a side of the tiles of a picture, 8, 16 or 32: the larger, the more rays share what is read of a
  /// node, as long as a tile is narrow enough for interpolation of the highest degree stored and there are
  /// enough tiles to share out.
  int TileSide(const EyeRays& eye_rays, int width, int height) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobe
