#include "render/tile_renderer.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <tbb/enumerable_thread_specific.h>

#include "render/film_grid.h"
#include "render/packet_light.h"
#include "scene/element_locator.h"

namespace lobe {
namespace {

// Sums up the lanes that are for the same pixel into the first `pixels`, by channel. Loops of known length,
// so that they become a handful of instructions.
template <int pixels>
void Fold(float* sum) {
  for (int half = kLanes / 2; half >= pixels; half /= 2) {
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < half; ++i) sum[c * kLanes + i] += sum[c * kLanes + half + i];
    }
  }
}

void Fold(int pixels, float* sum) {
  if (pixels == 1) Fold<1>(sum);
  if (pixels == 4) Fold<4>(sum);  // where there are 16, every lane is a pixel's
}

}  // namespace

struct TileRenderer::Impl {
  const RayTracer& tracer;
  const ElementLocator& locator;
  const std::vector<uint8_t> handled, except;
  const int l_max;
  tbb::enumerable_thread_specific<PacketLight> lights;

  Impl(const Solution& solution, const RayTracer& t, const ElementLocator& l, std::vector<uint8_t> h,
       std::vector<uint8_t> e)
      : tracer(t),
        locator(l),
        handled(std::move(h)),
        except(std::move(e)),
        l_max(solution.total.max_degree()),
        lights([this, &solution] { return PacketLight(solution, locator, handled, except); }) {}
};

TileRenderer::TileRenderer(const Solution& solution, const RayTracer& tracer, const ElementLocator& locator,
                           std::vector<uint8_t> handled, std::vector<uint8_t> except)
    : impl_(std::make_unique<Impl>(solution, tracer, locator, std::move(handled), std::move(except))) {}
TileRenderer::~TileRenderer() = default;

int TileRenderer::TileSide(const EyeRays& eye_rays, int width, int height) const {
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

void TileRenderer::Render(const EyeRays& eye_rays, const Tile& tile, const PixelRect& window,
                          const General& general, Image* image, Sums* sums) const {
  PacketLight& light = impl_->lights.local();
  const float beyond = eye_rays.reach() - 0.5f;  // filters look over a tile's edge
  light.Start(eye_rays.film(), float(tile.x0) - beyond, float(tile.y0) - beyond, float(tile.x1) + beyond,
              float(tile.y1) + beyond);
  const int block = eye_rays.block_side(), pixels = block * block, samples = eye_rays.per_pixel();
  const float per_sample = 1.0f / float(samples);
  Rgb shown = Rgb::Zero();
  EyePacket rays;
  PacketHits hits;
  alignas(64) float radiance[3 * kLanes], sum[3 * kLanes];
  for (int y = tile.y0; y < tile.y1; y += block) {
    for (int x = tile.x0; x < tile.x1; x += block) {
      const int columns = std::min(block, tile.x1 - x), rows = std::min(block, tile.y1 - y);
      uint32_t lanes = 0xffff;  // whose pixels are in the tile
      if (columns < block || rows < block) {
        lanes = 0;
        for (int i = 0; i < kLanes; ++i) {
          if (i % pixels % block < columns && i % pixels / block < rows) lanes |= 1u << i;
        }
      }
      for (int k = 0; k < eye_rays.packets_per_block(); ++k) {
        eye_rays.Packet(x, y, k, &rays);
        impl_->tracer.IntersectPacket(eye_rays.eye(), rays.x, rays.y, rays.z, &hits);
        float* into = k == 0 ? sum : radiance;
        uint32_t unhandled = light.Read(rays, hits, lanes, into);
        for (; unhandled != 0; unhandled &= unhandled - 1) {
          const int lane = std::countr_zero(unhandled);
          const int p = lane % pixels;
          const Rgb one = general(rays.ray(eye_rays.eye(), lane), hits.at(lane), x + p % block, y + p / block,
                                  k * (kLanes / pixels) + lane / pixels);
          for (int c = 0; c < 3; ++c) into[c * kLanes + lane] = one[c];
        }
        if (k > 0) {
          for (int i = 0; i < 3 * kLanes; ++i) sum[i] += radiance[i];
        }
      }
      Fold(pixels, sum);
      for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
          const float* of_pixel = sum + row * block + column;
          const Rgb pixel(of_pixel[0], of_pixel[kLanes], of_pixel[2 * kLanes]);
          shown += pixel;
          if (!window.Contains(x + column, y + row)) continue;
          image->at(x + column - window.x0, y + row - window.y0) = pixel * per_sample;
        }
      }
      sums->rays += uint64_t(columns) * rows * samples;
    }
  }
  sums->shown += shown.cast<double>().sum();
  sums->clamped += light.TakeClamped();
}

}  // namespace lobe
