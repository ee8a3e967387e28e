#pragma once

#include <functional>
#include <vector>

#include "render/renderer.h"
#include "sh/lanes.h"

namespace lobe {

/// Eye rays side by side. They start at the camera's eye.
struct EyePacket {
  alignas(64) float x[kLanes], y[kLanes], z[kLanes];  ///< unit directions
  alignas(64) float film_x[kLanes], film_y[kLanes];   ///< where they pass the film, in pixels
  Ray ray(const Vec3& eye, int lane) const;
};

/// The eye rays of a picture: stratified over the pixel's filter, which is sampled by importance, so that
/// every ray counts the same. Every way of rendering takes them from here, whatever it does with them. A ray
/// depends on seed, pixel and sample alone and has the same bits whichever way it is asked for.
///
/// In packets: a *block* is a square of pixels, block_side() wide, so small that a packet holds whole
/// samples of all its pixels and that all packets of a block are full. Lane i of packet k is sample
/// k * (kLanes / n) + i / n of the block's pixel i % n, row by row, n = block_side()².
class EyeRays {
 public:
  /// Throws std::invalid_argument if options.Validate() complains.
  EyeRays(const CameraView& view, const RenderOptions& options);

  int per_pixel() const { return side_ * side_; }  ///< samples_per_pixel rounded up to a square
  const Vec3& eye() const { return eye_; }
  const CameraView::Film& film() const { return film_; }
  float reach() const { return reach_; }  ///< of the filter, from a pixel's centre along an axis, in pixels

  int block_side() const { return block_side_; }  ///< 1, 2 or 4
  int packets_per_block() const { return per_pixel() * block_side_ * block_side_ / kLanes; }
  /// Packet k of the block whose top left pixel is (x, y). Pixels beyond the picture get rays too.
  void Packet(int x, int y, int k, EyePacket* out) const;

  /// Appends the rays of pixel (x, y), sample after sample.
  void Append(int x, int y, std::vector<Ray>* rays) const;

 private:
  struct Layout {  // which pixel and sample each lane of a packet is for
    alignas(64) uint32_t dx[kLanes], dy[kLanes], sample[kLanes];
  };
  void Make(const Layout& layout, int x, int y, int first_sample, EyePacket* out) const;

  Vec3 eye_;
  CameraView::Film film_;
  uint32_t width_, seeds_[2];
  int side_, block_side_;
  float reach_ = 0.5f;
  Layout block_layout_, pixel_layout_;
  std::vector<float> inverse_;  // of the cumulative filter, one axis; empty for the box
};

/// One pixel's eye rays and what they hit: a thread's scratch where every ray is looked at on its own.
struct PixelRays {
  std::vector<Ray> rays;
  std::vector<RayHit> hits;
  void Trace(const EyeRays& eye_rays, const RayTracer& tracer, int x, int y);
};

/// A square of pixels of the full picture whose eye rays go together, [x0, x1) x [y0, y1). With a crop the
/// tiles are those of the full picture that meet it, whole: rays that are traced together then stay together,
/// and so do their bits; pixels outside options.Window() are to be dropped.
struct Tile {
  int index, x0, y0, x1, y1;  // index: 0 to TileCount - 1
  PixelRect rect() const { return {x0, y0, x1, y1}; }
};
inline constexpr int kSmallTile = 8;  ///< pixels a side
int TileCount(const RenderOptions& options, int tile_side);

/// Calls `render` for every tile, in parallel and in no order. `progress` gets 0..1 from one thread at a
/// time; if it returns false no further tiles begin. True if all were rendered.
bool ForEachTile(const RenderOptions& options, int tile_side, const std::function<void(const Tile&)>& render,
                 const std::function<bool(double)>& progress);

}  // namespace lobe
