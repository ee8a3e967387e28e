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
  /// Two references only: relative rms noise of one reference (pixel and block), from their difference.
  std::optional<double> reference_pixel_noise, reference_block_noise;
  size_t pixels = 0;  ///< compared, after the mask
};

/// With `reference2` the squared error is mean((a - r)(a - s)): unbiased, reference noise cancels; a
/// negative estimate gives 0, below noise. The mean that errors are relative to is then that of (r+s)/2.
///
/// Blocks of 8 x 8 pixels count from the top left; those at the right and bottom edges may be smaller.
/// A block averages its unmasked pixels and weighs as many as it has, so that both figures are relative
/// to the same mean and a block of one pixel beside a lamp does not speak for 64; one with none is left out.
///
/// Throws InputError when sizes differ, a compared value is not finite, nothing is left to compare, or
/// the reference's mean is not positive.
Comparison Compare(const Image& a, const Image& reference, const Image* reference2, const Mask* mask);

/// |a - reference| over mean(reference), averaged over channels, as false colour: black is 0, pale
/// yellow kDifferenceFullScale and more; the mask in grey. Linear values, to be written by WritePng.
Image DifferencePicture(const Image& a, const Image& reference, const Mask* mask);
inline constexpr double kDifferenceFullScale = 0.5;

}  // namespace lobe
