#pragma once

#include <vector>

#include "render/image.h"

namespace lobe {

/// Pixels a degree of the observer's eye sees: a 0.7 m wide screen of 3840 pixels from 0.7 m away, the
/// paper's default. More: finer errors are blurred away by the eye.
inline constexpr double kFlipPixelsPerDegree = 67.02;
/// Below, the paper's filters are narrower than a pixel and vanish; above, they are just slow.
inline constexpr double kFlipMinPixelsPerDegree = 5, kFlipMaxPixelsPerDegree = 1000;

/// LDR-FLIP: the difference an observer sees when two pictures alternate in place, per pixel, row by row,
/// 0 (none) to 1. Both pictures are as shown (ToneMapped: linear Rec. 709 in 0..1, not rounded to 8 bits)
/// and of one size. Symmetric in its arguments. Beyond a picture's border its border pixels continue.
///
/// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for
/// Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2) (HPG 2020); names in flip.cpp are
/// the paper's. Time grows with pixels x pixels_per_degree. Throws std::invalid_argument when sizes
/// differ or pixels_per_degree is not within the range above.
std::vector<float> FlipMap(const Image& a, const Image& b, double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace lobe
