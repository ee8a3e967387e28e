#include "render/eye_rays.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numbers>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "solver/hash.h"

namespace lobe {
namespace {

constexpr int kTile = 8;  // pixels a side; their rays are traced together
constexpr int kInverse = 512;

// Blackman-Harris window, 4 terms, over [-1.5, 1.5] pixels.
std::vector<float> InverseOfBlackmanHarris() {
  constexpr int kSteps = 1024;
  constexpr double kRadius = 1.5;
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
    inverse.push_back(float(((at + u) / kSteps * 2.0 - 1.0) * kRadius));
  }
  return inverse;
}

}  // namespace

EyeRays::EyeRays(const CameraView& view, const RenderOptions& options) : view_(view) {
  if (const std::string wrong = options.Validate(); !wrong.empty()) throw std::invalid_argument(wrong);
  width_ = options.width;
  side_ = int(std::ceil(std::sqrt(double(options.samples_per_pixel))));
  seed_ = Mix(options.seed, 0xca3);
  if (options.filter == PixelFilter::kBlackmanHarris) inverse_ = InverseOfBlackmanHarris();
}

float EyeRays::Offset(float u) const {
  if (inverse_.empty()) return u - 0.5f;
  const float s = u * kInverse;
  const int i = std::min(int(s), kInverse - 1);
  return inverse_[i] + (s - float(i)) * (inverse_[i + 1] - inverse_[i]);
}

void EyeRays::Append(int x, int y, std::vector<Ray>* rays) const {
  RandomStream random(Mix(seed_, uint64_t(y) * width_ + x));
  for (int s = 0; s < per_pixel(); ++s) {
    const float u = (float(s % side_) + random.Next()) / side_,
                v = (float(s / side_) + random.Next()) / side_;
    rays->push_back(view_.EyeRay(x + 0.5f + Offset(u), y + 0.5f + Offset(v)));
  }
}

namespace {

/// The window in tiles of the full picture.
PixelRect TilesOf(const PixelRect& window) {
  return {window.x0 / kTile, window.y0 / kTile, (window.x1 + kTile - 1) / kTile,
          (window.y1 + kTile - 1) / kTile};
}

}  // namespace

int TileCount(const RenderOptions& options) {
  const PixelRect grid = TilesOf(options.Window());
  return grid.width() * grid.height();
}

bool ForEachTile(const RenderOptions& options, const std::function<void(const Tile&)>& render,
                 const std::function<bool(double)>& progress) {
  const PixelRect grid = TilesOf(options.Window());
  const int tiles = grid.width() * grid.height();
  std::atomic<int> done{0};
  std::atomic<bool> stop{false};
  std::mutex progress_mutex;
  tbb::parallel_for(0, tiles, [&](int index) {
    if (stop.load(std::memory_order_relaxed)) return;
    const int x0 = (grid.x0 + index % grid.width()) * kTile, y0 = (grid.y0 + index / grid.width()) * kTile;
    render({index, x0, y0, std::min(x0 + kTile, options.width), std::min(y0 + kTile, options.height)});
    const int finished = ++done;
    if (progress) {
      const std::unique_lock lock(progress_mutex, std::try_to_lock);
      if (lock.owns_lock() && !progress(double(finished) / tiles)) stop = true;
    }
  });
  return !stop;
}

}  // namespace lobe
