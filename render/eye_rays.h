#pragma once

#include <functional>
#include <vector>

#include "render/renderer.h"

namespace lobe {

/// The eye rays of a picture: stratified over the pixel's filter, which is sampled by importance, so that
/// every ray counts the same. Every way of rendering takes them from here, whatever it does with them.
class EyeRays {
 public:
  /// Throws std::invalid_argument if options.Validate() complains. `view` must outlive this.
  EyeRays(const CameraView& view, const RenderOptions& options);

  int per_pixel() const { return side_ * side_; }  ///< samples_per_pixel rounded up to a square
  /// Appends the rays of pixel (x, y). They depend on seed and pixel alone.
  void Append(int x, int y, std::vector<Ray>* rays) const;

 private:
  float Offset(float u) const;  // from the pixel's centre, one axis

  const CameraView& view_;
  int width_, side_;
  uint64_t seed_;
  std::vector<float> inverse_;  // of the cumulative filter, one axis; empty for the box
};

/// A square of pixels of the full picture whose eye rays go together, [x0, x1) x [y0, y1). With a crop the
/// tiles are those of the full picture that meet it, whole: rays that are traced together then stay together,
/// and so do their bits; pixels outside options.Window() are to be dropped.
struct Tile {
  int index, x0, y0, x1, y1;  // index: 0 to TileCount - 1
};
int TileCount(const RenderOptions& options);

/// Calls `render` for every tile, in parallel and in no order. `progress` gets 0..1 from one thread at a
/// time; if it returns false no further tiles begin. True if all were rendered.
bool ForEachTile(const RenderOptions& options, const std::function<void(const Tile&)>& render,
                 const std::function<bool(double)>& progress);

}  // namespace lobe
