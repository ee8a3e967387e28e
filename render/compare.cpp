#include "render/compare.h"

#include <algorithm>
#include <cmath>

#include "render/false_colour.h"
#include "render/flip.h"
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
  double a = 0, reference = 0, absolute_reference = 0;
  double weight = 0;

  void Add(const Eigen::Array3d& va, const Eigen::Array3d& vr, const Eigen::Array3d& vs, double w) {
    error2 += w * ((va - vr) * (va - vs)).sum();
    noise2 += w * (vr - vs).square().sum();
    a += w * va.sum();
    reference += w * 0.5 * (vr + vs).sum();
    absolute_reference += w * 0.5 * (vr + vs).abs().sum();
    weight += 3 * w;
  }
  double Mean(double sum) const { return sum / weight; }
  double Error() const { return std::sqrt(std::max(0.0, Mean(error2))); }
  // The difference of two independent pictures has twice the variance of one.
  double Noise() const { return std::sqrt(Mean(noise2) / 2); }
};

bool Masked(const Mask* mask, int x, int y) { return mask && mask->set[size_t(y) * mask->width + x]; }

/// The smallest of the sorted values that `percent` of them do not exceed.
double Percentile(const std::vector<float>& sorted, double percent) {
  const auto rank = static_cast<size_t>(std::ceil(percent / 100 * double(sorted.size())));
  return sorted[std::clamp<size_t>(rank, 1, sorted.size()) - 1];
}

/// relative_mse and relative_error; every compared value is known to be finite.
void AddRelativeFigures(const Image& a, const Image& r, const Image& s, const Mask* mask,
                        Comparison* result) {
  const double epsilon = kRelMseEpsilon * result->scale * result->scale;
  double sum = 0;
  std::vector<float> errors;
  errors.reserve(result->pixels);
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (Masked(mask, x, y)) continue;
      const Eigen::Array3d va = a.at(x, y).cast<double>(), vr = r.at(x, y).cast<double>(),
                           vs = s.at(x, y).cast<double>(), middle = 0.5 * (vr + vs);
      const Eigen::Array3d denominator = middle.square() + epsilon;
      sum += ((va - vr) * (va - vs) / denominator).mean();
      errors.push_back(float(std::sqrt(((va - middle).square() / denominator).mean())));
    }
  }
  result->relative_mse = std::max(0.0, sum / double(errors.size()));
  std::sort(errors.begin(), errors.end());
  result->relative_error = {Percentile(errors, 50), Percentile(errors, 90), Percentile(errors, 99),
                            errors.back()};
}

}  // namespace

Comparison Compare(const Image& a, const Image& reference, const Image* reference2, const Mask* mask,
                   ErrorScale error_scale) {
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
  const bool absolute = error_scale == ErrorScale::kMeanAbsolute;
  const double scale = pixels.Mean(absolute ? pixels.absolute_reference : pixels.reference);
  if (!(scale > 0)) {
    throw InputError(std::string("the reference's mean ") + (absolute ? "absolute value " : "") +
                     "over the compared pixels is " + std::to_string(scale) +
                     "; errors are relative to it, so it must be positive");
  }

  Comparison result;
  result.scale = scale;
  result.pixel_error = pixels.Error() / scale;
  result.block_error = blocks.Error() / scale;
  result.mean = pixels.Mean(pixels.a);
  result.reference_mean = pixels.Mean(pixels.reference);
  result.bias = (result.mean - result.reference_mean) / scale;
  result.pixels = static_cast<size_t>(pixels.weight / 3);
  if (reference2) {
    result.reference_pixel_noise = pixels.Noise() / scale;
    result.reference_block_noise = blocks.Noise() / scale;
  }
  AddRelativeFigures(a, reference, second, mask, &result);
  return result;
}

Image MiddleOf(const Image& reference, const Image* reference2) {
  Image middle = reference;
  for (size_t i = 0; reference2 && i < middle.pixels.size(); ++i) {
    middle.pixels[i] = 0.5f * reference.pixels[i] + 0.5f * reference2->pixels[i];
  }
  return middle;
}

double MeanFlip(const Image& a, const Image& reference, const Mask* mask, float exposure, ToneCurve curve,
                double pixels_per_degree) {
  Image shown = ToneMapped(a, exposure, curve);
  const Image shown_reference = ToneMapped(reference, exposure, curve);
  const auto masked = [&](size_t i) { return mask && mask->set[i]; };
  for (size_t i = 0; i < shown.pixels.size(); ++i) {
    if (masked(i)) shown.pixels[i] = shown_reference.pixels[i];
  }
  const std::vector<float> flip = FlipMap(shown, shown_reference, pixels_per_degree);
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < flip.size(); ++i) {
    if (masked(i)) continue;
    sum += flip[i];
    ++count;
  }
  return count > 0 ? sum / double(count) : 0;
}

Image DifferencePicture(const Image& a, const Image& reference, const Mask* mask, double scale) {
  Image picture(a.width, a.height);
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const double difference = double((a.at(x, y) - reference.at(x, y)).abs().mean()) / scale;
      picture.at(x, y) =
          Masked(mask, x, y) ? Rgb::Constant(0.2f) : FalseColour(difference / kDifferenceFullScale);
    }
  }
  return picture;
}

Image SideBySide(const std::vector<const Image*>& pictures) {
  int width = 0;
  for (const Image* picture : pictures) width += picture->width;
  Image out(width, pictures.front()->height);
  int left = 0;
  for (const Image* picture : pictures) {
    for (int y = 0; y < out.height; ++y) {
      std::copy_n(&picture->at(0, y), picture->width, &out.at(left, y));
    }
    left += picture->width;
  }
  return out;
}

}  // namespace lobe
