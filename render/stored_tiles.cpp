#include "render/stored_tiles.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <tbb/enumerable_thread_specific.h>

#include "render/film_grid.h"
#include "render/stored_light.h"
#include "scene/element_locator.h"

namespace lobe {

struct StoredTiles::Impl {
  const RayTracer& tracer;
  const ElementLocator& locator;
  const std::vector<uint8_t> handled;
  int l_max = 0;
  tbb::enumerable_thread_specific<StoredLight> lights;

  Impl(const Solution& solution, const RayTracer& t, const ElementLocator& l, std::vector<uint8_t> h)
      : tracer(t),
        locator(l),
        handled(std::move(h)),
        lights([this, &solution] { return StoredLight(solution, locator, handled); }) {
    for (uint32_t p = 0; p < solution.total.patch_count(); ++p) {
      l_max = std::max(l_max, solution.total.patch_degrees(p).max_degree());
    }
  }
};

StoredTiles::StoredTiles(const Solution& solution, const RayTracer& tracer, const ElementLocator& locator,
                         std::vector<uint8_t> handled)
    : impl_(std::make_unique<Impl>(solution, tracer, locator, std::move(handled))) {}
StoredTiles::~StoredTiles() = default;

int StoredTiles::TileSide(const EyeRays& eye_rays, int width, int height) const {
  constexpr int kEnough = 64;  // tiles; chosen: some for each of 16 threads or more
  int side = 32;
  while (side > kSmallTile) {
    // Widest seen from the eye is a tile in the middle.
    const float x = 0.5f * float(width), y = 0.5f * float(height);
    const float half = 0.5f * float(side - 1) + eye_rays.reach();
    const double rho = FilmGrid::Rho(eye_rays.film(), x - half, y - half, x + half, y + half);
    if ((width / side) * (height / side) >= kEnough && FilmGrid::Points(impl_->l_max, rho) > 0) break;
    side /= 2;
  }
  return side;
}

void StoredTiles::Render(const EyeRays& eye_rays, const Tile& tile, const PixelRect& window,
                         const General& general, Image* image, Sums* sums) const {
  StoredLight& light = impl_->lights.local();
  const float beyond = eye_rays.reach() - 0.5f;  // filters look over a tile's edge
  light.Start(eye_rays.film(), float(tile.x0) - beyond, float(tile.y0) - beyond, float(tile.x1) + beyond,
              float(tile.y1) + beyond);
  const int block = eye_rays.block_side(), pixels = block * block, samples = eye_rays.per_pixel();
  EyePacket rays;
  PacketHits hits;
  alignas(64) float radiance[3 * kLanes], sum[3 * kLanes];
  for (int y = tile.y0; y < tile.y1; y += block) {
    for (int x = tile.x0; x < tile.x1; x += block) {
      uint32_t lanes = 0;  // whose pixels are in the picture
      int inside = 0;
      for (int i = 0; i < kLanes; ++i) {
        const int px = x + i % pixels % block, py = y + i % pixels / block;
        if (px >= tile.x1 || py >= tile.y1 || !window.Contains(px, py)) continue;
        lanes |= 1u << i;
        inside += i < pixels;
      }
      if (lanes == 0) continue;
      std::fill_n(sum, 3 * kLanes, 0.0f);
      for (int k = 0; k < eye_rays.packets_per_block(); ++k) {
        eye_rays.Packet(x, y, k, &rays);
        impl_->tracer.IntersectPacket(eye_rays.eye(), rays.x, rays.y, rays.z, &hits);
        uint32_t unhandled = light.Read(rays, hits, lanes, radiance);
        for (; unhandled != 0; unhandled &= unhandled - 1) {
          const int lane = std::countr_zero(unhandled);
          const int p = lane % pixels;
          const Rgb one = general(rays.ray(eye_rays.eye(), lane), hits.at(lane), x + p % block, y + p / block,
                                  k * (kLanes / pixels) + lane / pixels);
          for (int c = 0; c < 3; ++c) radiance[c * kLanes + lane] = one[c];
        }
        for (int i = 0; i < 3 * kLanes; ++i) sum[i] += radiance[i];
      }
      for (int p = 0; p < pixels; ++p) {
        if ((lanes >> p & 1) == 0) continue;
        Rgb pixel = Rgb::Zero();
        for (int i = p; i < kLanes; i += pixels) pixel += Rgb(sum[i], sum[kLanes + i], sum[2 * kLanes + i]);
        image->at(x + p % block - window.x0, y + p / block - window.y0) = pixel / float(samples);
        sums->shown += pixel.sum();
      }
      sums->rays += uint64_t(inside) * samples;
    }
  }
  sums->clamped += light.TakeClamped();
}

}  // namespace lobe
