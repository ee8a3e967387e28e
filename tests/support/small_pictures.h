#pragma once

#include <functional>
#include <string>

#include "render/path_tracing.h"
#include "render/renderer.h"

namespace lobe::test {

/// One of the ways to read a solution, as tests run through them.
struct NamedMode {
  const char* name;
  RenderMode mode;
  bool gather_base = false;
};
inline constexpr NamedMode kStoredMode{"stored", RenderMode::kStored},
    kDirectMode{"direct", RenderMode::kDirect}, kGatherMode{"gather", RenderMode::kGather},
    kGatherAllMode{"gather with base", RenderMode::kGather, true}, kAutoMode{"auto", RenderMode::kAuto};
inline constexpr NamedMode kAllModes[] = {kStoredMode, kDirectMode, kGatherMode, kGatherAllMode, kAutoMode};

inline RenderOptions OptionsFor(const NamedMode& mode, int size, int samples_per_pixel, uint64_t seed = 1) {
  RenderOptions o;
  o.width = o.height = size;
  o.samples_per_pixel = samples_per_pixel;
  o.mode = mode.mode;
  o.gather_base = mode.gather_base;
  o.seed = seed;
  return o;
}

inline Eigen::Array3d MeanOf(const Image& image) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (const Rgb& p : image.pixels) sum += p.cast<double>();
  return sum / double(image.pixels.size());
}

/// Mean of a whole picture over pictures of independent seeds 1, 2 ..., and its standard error.
inline Estimate MeanOverSeeds(int seeds, const std::function<Image(uint64_t seed)>& render) {
  Eigen::Array3d sum = Eigen::Array3d::Zero(), sum2 = sum;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Eigen::Array3d x = MeanOf(render(uint64_t(seed)));
    sum += x;
    sum2 += x * x;
  }
  const Eigen::Array3d mean = sum / seeds;
  return {mean, ((sum2 / seeds - mean * mean).max(0.0) / (seeds - 1)).sqrt()};
}

}  // namespace lobe::test
