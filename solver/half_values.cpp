#include "solver/half_values.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <Eigen/Core>

namespace lobe {

HalfValues ToHalf(std::span<const float> values) {
  float largest = 0;
  for (const float v : values) {
    if (std::isfinite(v)) largest = std::max(largest, std::abs(v));
  }
  int exponent = 15;  // nothing but zeros: scale 1
  if (largest > 0) std::frexp(largest, &exponent);
  exponent = std::max(exponent - 15, -126);

  HalfValues out;
  out.scale = std::ldexp(1.0f, exponent);
  out.bits.reserve(values.size());
  for (const float v : values) {
    out.bits.push_back(Eigen::numext::bit_cast<uint16_t>(Eigen::half(std::ldexp(v, -exponent))));
  }
  return out;
}

float FromHalf(uint16_t bits, float scale) {
  return float(Eigen::numext::bit_cast<Eigen::half>(bits)) * scale;
}

}  // namespace lobe
