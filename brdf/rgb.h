#pragma once

#include <Eigen/Core>

namespace lobe {

/// Linear Rec. 709 red, green, blue. Arithmetic is per channel.
using Rgb = Eigen::Array3f;

/// Relative luminance of linear Rec. 709 (ITU-R BT.709-6, item 3.2).
inline float Luminance(const Rgb& c) { return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]; }

}  // namespace lobe
