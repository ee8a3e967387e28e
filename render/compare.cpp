#include "render/compare.h"

#include <algorithm>
#include <cmath>

#include "render/false_colour.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

constexpr int kBlock = 8;

std::string Size(int width, int height) { return std::to_string(width) + " x " + std::to_string(height); }

void RequireSameSize(const Image& a, int width, int height, const char* what) {
  if (a.width != width || a.height != height) {
    throw InputError(std::string("the picture has ") + Size(a.width, a.height) + " pixels and the " + what +
                     " " + Size(width, height) + "; equal sizes are expected");
  }
}

/// A pixel as three doubles; refuses what cannot be averaged.
Eigen::Array3d Finite(const Image& image, int x, int y, const char* what) {
  const Rgb& value = image.at(x, y);
  for (int c = 0; c < 3; ++c) {
    if (!std::isfinite(value[c])) {
      throw InputError(std::string("the ") + what + " has the value " + std::to_string(value[c]) +
                       " in channel " + "RGB"[c] + " of pixel (" + std::to_string(x) + ", " +
                       std::to_string(y) + "); finite values are expected");
    }
  }
  return value.cast<double>();
}

/// Sums over pixels, or over blocks weighted by their pixels.
struct Sums {
  double error2 = 0;  // (a - r)(a - s)
  double noise2 = 0;  // (r - s)^2
  double a = 0, reference = 0;
  double weight = 0;

  void Add(const Eigen::Array3d& va, const Eigen::Array3d& vr, const Eigen::Array3d& vs, double w) {
    error2 += w * ((va - vr) * (va - vs)).sum();
    noise2 += w * (vr - vs).square().sum();
    a += w * va.sum();
    reference += w * 0.5 * (vr + vs).sum();
    weight += 3 * w;
  }
  double Mean(double sum) const { return sum / weight; }
  double RelativeError() const { return std::sqrt(std::max(0.0, Mean(error2))) / Mean(reference); }
  // The difference of two independent pictures has twice the variance of one.
  double RelativeNoise() const { return std::sqrt(Mean(noise2) / 2) / Mean(reference); }
};

bool Masked(const Mask* mask, int x, int y) { return mask && mask->set[size_t(y) * mask->width + x]; }

}  // namespace

Comparison Compare(const Image& a, const Image& reference, const Image* reference2, const Mask* mask) {
  RequireSameSize(a, reference.width, reference.height, "reference");
  if (reference2) RequireSameSize(a, reference2->width, reference2->height, "second reference");
  if (mask) RequireSameSize(a, mask->width, mask->height, "mask");
  const Image& second = reference2 ? *reference2 : reference;

  Sums pixels, blocks;
  for (int by = 0; by < a.height; by += kBlock) {
    for (int bx = 0; bx < a.width; bx += kBlock) {
      Eigen::Array3d block_a = Eigen::Array3d::Zero(), block_r = block_a, block_s = block_a;
      int count = 0;
      for (int y = by; y < std::min(by + kBlock, a.height); ++y) {
        for (int x = bx; x < std::min(bx + kBlock, a.width); ++x) {
          if (Masked(mask, x, y)) continue;
          const Eigen::Array3d va = Finite(a, x, y, "picture"), vr = Finite(reference, x, y, "reference");
          const Eigen::Array3d vs = reference2 ? Finite(second, x, y, "second reference") : vr;
          pixels.Add(va, vr, vs, 1);
          block_a += va;
          block_r += vr;
          block_s += vs;
          ++count;
        }
      }
      if (count > 0) blocks.Add(block_a / count, block_r / count, block_s / count, count);
    }
  }
  if (pixels.weight == 0) {
    throw InputError("the mask leaves out every pixel; at least one is needed to compare");
  }
  if (!(pixels.Mean(pixels.reference) > 0)) {
    throw InputError("the reference's mean over the compared pixels is " +
                     std::to_string(pixels.Mean(pixels.reference)) +
                     "; errors are relative to it, so it must be positive");
  }

  Comparison result;
  result.pixel_error = pixels.RelativeError();
  result.block_error = blocks.RelativeError();
  result.mean = pixels.Mean(pixels.a);
  result.reference_mean = pixels.Mean(pixels.reference);
  result.pixels = static_cast<size_t>(pixels.weight / 3);
  if (reference2) {
    result.reference_pixel_noise = pixels.RelativeNoise();
    result.reference_block_noise = blocks.RelativeNoise();
  }
  return result;
}

Image DifferencePicture(const Image& a, const Image& reference, const Mask* mask) {
  const double mean = Compare(a, reference, nullptr, mask).reference_mean;
  Image picture(a.width, a.height);
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const double difference = (a.at(x, y) - reference.at(x, y)).abs().mean() / mean;
      picture.at(x, y) =
          Masked(mask, x, y) ? Rgb::Constant(0.2f) : FalseColour(difference / kDifferenceFullScale);
    }
  }
  return picture;
}

}  // namespace lobe
