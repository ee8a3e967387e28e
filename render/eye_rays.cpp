#include "render/eye_rays.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "sh/simd.h"
#include "solver/hash.h"

namespace lobe {
namespace {

constexpr int kInverse = 512;
constexpr double kBlackmanHarrisRadius = 1.5;  // pixels

// Blackman-Harris window, 4 terms, over [-1.5, 1.5] pixels.
std::vector<float> InverseOfBlackmanHarris() {
  constexpr int kSteps = 1024;
  std::vector<double> cumulative(kSteps + 1, 0.0);
  for (int i = 0; i < kSteps; ++i) {
    const double x = 2.0 * std::numbers::pi * (i + 0.5) / kSteps;
    cumulative[i + 1] = cumulative[i] + 0.35875 - 0.48829 * std::cos(x) + 0.14128 * std::cos(2 * x) -
                        0.01168 * std::cos(3 * x);
  }
  std::vector<float> inverse;
  for (int i = 0, at = 0; i <= kInverse; ++i) {
    const double target = cumulative.back() * i / kInverse;
    while (at < kSteps - 1 && cumulative[at + 1] < target) ++at;
    const double step = cumulative[at + 1] - cumulative[at];
    const double u = step > 0 ? std::clamp((target - cumulative[at]) / step, 0.0, 1.0) : 0.0;
    inverse.push_back(float(((at + u) / kSteps * 2.0 - 1.0) * kBlackmanHarrisRadius));
  }
  return inverse;
}

// The finaliser of MurmurHash3 (Appleby, 2011), a bijection of 32 bits: SplitMix64 of solver/hash.h needs
// products of 64 bits, which few processors have side by side.
LOBE_INLINE void Scramble(UintLanes* h) {
  *h ^= *h >> 16;
  *h *= 0x85ebca6bu;
  *h ^= *h >> 13;
  *h *= 0xc2b2ae35u;
  *h ^= *h >> 16;
}

// In [0, 1).
LOBE_INLINE void ToUniform(const UintLanes& bits, FloatLanes* uniform) {
  *uniform = __builtin_convertvector((IntLanes)(bits >> 8), FloatLanes) * 0x1p-24f;
}

// From the pixel's centre, one axis; u in [0, 1].
LOBE_INLINE void ToOffset(const FloatLanes& u, const float* inverse, FloatLanes* offset) {
  if (!inverse) {
    *offset = u - 0.5f;
    return;
  }
  for (int lane = 0; lane < kLanes; ++lane) {
    const float s = u[lane] * kInverse;
    const int i = std::min(int(s), kInverse - 1);
    (*offset)[lane] = inverse[i] + (s - float(i)) * (inverse[i + 1] - inverse[i]);
  }
}

struct Lens {
  const CameraView::Film& film;
  uint32_t width, seeds[2];
  int side;
  const float* inverse;
};

LOBE_SIMD_CLONES void MakeRays(const Lens& lens, const uint32_t* dx, const uint32_t* dy,
                               const uint32_t* samples, uint32_t x, uint32_t y, uint32_t first_sample,
                               EyePacket* out) {
  const UintLanes pixel_x = AsLanes(dx) + x, pixel_y = AsLanes(dy) + y;
  const UintLanes sample = AsLanes(samples) + first_sample;
  UintLanes pixel = (pixel_y * lens.width + pixel_x) ^ lens.seeds[0];
  Scramble(&pixel);
  constexpr uint32_t kGolden = 0x9e3779b9u;  // 2^32 over the golden ratio: steps far apart
  UintLanes first = pixel + sample * kGolden, second = (pixel ^ lens.seeds[1]) + sample * kGolden;
  Scramble(&first);
  Scramble(&second);
  FloatLanes u, v;
  ToUniform(first, &u);
  ToUniform(second, &v);

  // Half a sample more keeps the quotient, rounded, on the right side of every integer.
  const FloatLanes s = __builtin_convertvector((IntLanes)sample, FloatLanes);
  const float per_side = 1.0f / float(lens.side);
  const FloatLanes row =
      __builtin_convertvector(__builtin_convertvector((s + 0.5f) * per_side, IntLanes), FloatLanes);
  FloatLanes offset_x, offset_y;
  ToOffset((s - row * float(lens.side) + u) * per_side, lens.inverse, &offset_x);
  ToOffset((row + v) * per_side, lens.inverse, &offset_y);
  const FloatLanes film_x = __builtin_convertvector((IntLanes)pixel_x, FloatLanes) + 0.5f + offset_x;
  const FloatLanes film_y = __builtin_convertvector((IntLanes)pixel_y, FloatLanes) + 0.5f + offset_y;
  const auto& [corner, along_x, along_y] = lens.film;
  const FloatLanes dir_x = corner[0] + film_x * along_x[0] + film_y * along_y[0];
  const FloatLanes dir_y = corner[1] + film_x * along_x[1] + film_y * along_y[1];
  const FloatLanes dir_z = corner[2] + film_x * along_x[2] + film_y * along_y[2];
  const FloatLanes squared = dir_x * dir_x + dir_y * dir_y + dir_z * dir_z;
  FloatLanes length;
  for (int i = 0; i < kLanes; ++i) length[i] = std::sqrt(squared[i]);
  const FloatLanes scale = 1.0f / length;
  AsLanes(out->x) = dir_x * scale;
  AsLanes(out->y) = dir_y * scale;
  AsLanes(out->z) = dir_z * scale;
  AsLanes(out->film_x) = film_x;
  AsLanes(out->film_y) = film_y;
}

}  // namespace

Ray EyePacket::ray(const Vec3& eye, int lane) const {
  return {eye, 0.0f, {x[lane], y[lane], z[lane]}, std::numeric_limits<float>::infinity()};
}

EyeRays::EyeRays(const CameraView& view, const RenderOptions& options)
    : eye_(view.camera().eye), film_(view.film()) {
  if (const std::string wrong = options.Validate(); !wrong.empty()) throw std::invalid_argument(wrong);
  width_ = uint32_t(options.width);
  side_ = int(std::ceil(std::sqrt(double(options.samples_per_pixel))));
  const uint64_t seed = Mix(options.seed, 0xca3);
  seeds_[0] = uint32_t(seed);
  seeds_[1] = uint32_t(seed >> 32);
  if (options.filter == PixelFilter::kBlackmanHarris) {
    inverse_ = InverseOfBlackmanHarris();
    reach_ = float(kBlackmanHarrisRadius);
  }
  block_side_ = side_ % 4 == 0 ? 1 : side_ % 2 == 0 ? 2 : 4;
  const uint32_t b = uint32_t(block_side_), pixels = b * b;
  for (uint32_t i = 0; i < kLanes; ++i) {
    block_layout_.dx[i] = i % pixels % b;
    block_layout_.dy[i] = i % pixels / b;
    block_layout_.sample[i] = i / pixels;
    pixel_layout_.dx[i] = pixel_layout_.dy[i] = 0;
    pixel_layout_.sample[i] = i;
  }
}

void EyeRays::Make(const Layout& layout, int x, int y, int first_sample, EyePacket* out) const {
  const Lens lens = {
      film_, width_, {seeds_[0], seeds_[1]}, side_, inverse_.empty() ? nullptr : inverse_.data()};
  MakeRays(lens, layout.dx, layout.dy, layout.sample, uint32_t(x), uint32_t(y), uint32_t(first_sample), out);
}

void EyeRays::Packet(int x, int y, int k, EyePacket* out) const {
  Make(block_layout_, x, y, k * (kLanes / (block_side_ * block_side_)), out);
}

void EyeRays::Append(int x, int y, std::vector<Ray>* rays) const {
  EyePacket packet;
  for (int s = 0; s < per_pixel(); s += kLanes) {
    Make(pixel_layout_, x, y, s, &packet);
    for (int i = 0; i < std::min(kLanes, per_pixel() - s); ++i) rays->push_back(packet.ray(eye_, i));
  }
}

void PixelRays::Trace(const EyeRays& eye_rays, const RayTracer& tracer, int x, int y) {
  rays.clear();
  eye_rays.Append(x, y, &rays);
  hits.resize(rays.size());
  tracer.Intersect(rays, hits, /*coherent=*/true);
}

namespace {

/// The window in tiles of the full picture.
PixelRect TilesOf(const PixelRect& window, int side) {
  return {window.x0 / side, window.y0 / side, (window.x1 + side - 1) / side, (window.y1 + side - 1) / side};
}

}  // namespace

int TileCount(const RenderOptions& options, int side) {
  const PixelRect grid = TilesOf(options.Window(), side);
  return grid.width() * grid.height();
}

bool ForEachTile(const RenderOptions& options, int side, const std::function<void(const Tile&)>& render,
                 const std::function<bool(double)>& progress) {
  const PixelRect grid = TilesOf(options.Window(), side);
  const int tiles = grid.width() * grid.height();
  std::atomic<int> done{0};
  std::atomic<bool> stop{false};
  std::mutex progress_mutex;
  tbb::parallel_for(0, tiles, [&](int index) {
    if (stop.load(std::memory_order_relaxed)) return;
    const int x0 = (grid.x0 + index % grid.width()) * side, y0 = (grid.y0 + index / grid.width()) * side;
    render({index, x0, y0, std::min(x0 + side, options.width), std::min(y0 + side, options.height)});
    ++done;
    if (progress) {
      const std::unique_lock lock(progress_mutex, std::try_to_lock);
      if (lock.owns_lock() && !progress(double(done.load()) / tiles)) stop = true;
    }
  });
  return done == tiles;
}

}  // namespace lobe
