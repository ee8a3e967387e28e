#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lobe {

/// Floats as IEEE 754 binary16 that are to be multiplied by `scale`, a power of two.
struct HalfValues {
  std::vector<uint16_t> bits;
  float scale = 1;
};

/// The largest finite magnitude M comes to lie in [2^14, 2^15), half of what binary16 can hold, so that small
/// values keep their digits: a value v is off by at most 2^-11 |v| if |v| > 2^-28 M, and else by 2^-39 M.
/// Infinities and NaN stay what they are. The scale is never below the smallest normal float, 2^-126; light
/// so dim that it would have to be loses digits.
HalfValues ToHalf(std::span<const float> values);

/// The way back, for one value.
float FromHalf(uint16_t bits, float scale);

}  // namespace lobe
