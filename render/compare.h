#pragma once

#include <optional>

#include "render/image.h"
#include "render/png.h"

namespace lobe {

/// The error figures of docs/conventions.md#error.
struct Comparison {
  double pixel_error = 0;               ///< relative rms over all channels of the compared pixels, fraction
  double block_error = 0;               ///< the same after averaging 8 x 8 pixels
  double mean = 0, reference_mean = 0;  ///< all channels of the compared pixels together
  /// What errors are relative to: reference_mean, or with ErrorScale::kMeanAbsolute the mean of |reference|.
  double scale = 0;
  double bias = 0;  ///< (mean - reference_mean) / scale
  /// Mean over channels and pixels of (a - r)^2 / (r^2 + kRelMseEpsilon scale^2): dark places count as
  /// much as bright ones, whatever the exposure.
  double relative_mse = 0;
  /// Of a pixel's relative error, whose square is the mean over its channels of what relative_mse averages.
  /// The value that so many percent of the pixels do not exceed (nearest rank).
  struct Percentiles {
    double p50 = 0, p90 = 0, p99 = 0, max = 0;
  } relative_error;
  /// Two references only: relative rms noise of one reference (pixel and block), from their difference.
  std::optional<double> reference_pixel_noise, reference_block_noise;
  size_t pixels = 0;  ///< compared, after the mask
};

/// Chosen, as the 0.01 that is customary for pictures of mean 1.
inline constexpr double kRelMseEpsilon = 0.01;

enum class ErrorScale {
  kMean,          ///< light
  kMeanAbsolute,  ///< layers whose values have signs, such as normals
};

/// With `reference2` the squared error is mean((a - r)(a - s)): unbiased, reference noise cancels; a
/// negative estimate gives 0, below noise. The mean that errors are relative to is then that of (r+s)/2.
/// relative_mse does the same with (r+s)/2 in its denominator, whose noise leaves a bias of second order;
/// percentiles, which are no means, are those of a against (r+s)/2 and hold its noise. With one reference
/// all figures hold the reference's noise.
///
/// A block averages its unmasked pixels and weighs as many as it has, so that both figures are relative
/// to the same mean and a block of one pixel beside a lamp does not speak for 64; one with none is left out.
///
/// Throws InputError when sizes differ, a compared value is not finite, nothing is left to compare, or
/// what errors are relative to is not positive.
Comparison Compare(const Image& a, const Image& reference, const Image* reference2, const Mask* mask,
                   ErrorScale scale = ErrorScale::kMean);

/// (r + s) / 2, or `reference` alone.
Image MiddleOf(const Image& reference, const Image* reference2);

/// LDR-FLIP (render/flip.h) of the pictures as shown, averaged over the compared pixels. Masked pixels are
/// taken from the reference in both, so that they do not weigh on their neighbours. Sizes must agree.
double MeanFlip(const Image& a, const Image& reference, const Mask* mask, float exposure, ToneCurve curve,
                double pixels_per_degree);

/// |a - reference| over `scale`, averaged over channels, as false colour: black is 0, pale
/// yellow kDifferenceFullScale and more; the mask in grey. Linear values, to be written by WritePng.
Image DifferencePicture(const Image& a, const Image& reference, const Mask* mask, double scale);
inline constexpr double kDifferenceFullScale = 0.5;

/// Pictures of one height in a row, from the left.
Image SideBySide(const std::vector<const Image*>& pictures);

}  // namespace lobe
