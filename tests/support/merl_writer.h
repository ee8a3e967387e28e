#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "scene/merl_file.h"
#include "tests/support/brdf_models.h"
#include "tests/support/scratch_folder.h"

namespace lobe::test {

/// What a MERL file of this model holds: its value at the centre of each bin, -1 where a direction is below
/// the horizon. The format written out anew: shares no code with the reader but its constants.
inline std::string MerlBytes(const Reflectance& r) {
  const int32_t size[3] = {90, 90, 180};
  const size_t bins = size_t{90} * 90 * 180;
  std::vector<double> values(3 * bins);
  constexpr double kDegree = std::numbers::pi / 180;
  for (size_t bin = 0; bin < bins; ++bin) {
    const double ring = double(bin / (90 * 180)) + 0.5;
    const auto [wi, wo] =
        FromHalfDifference(ring * ring / 90 * kDegree, (double(bin / 180 % 90) + 0.5) * kDegree,
                           (double(bin % 180) + 0.5) * kDegree);
    const bool above = wi.z() > 0 && wo.z() > 0;
    const Rgb f = above ? EvaluateBrdf(r, wi, wo) : Rgb::Constant(-1);
    const double scale[3] = {1 / 1500.0, 1.15 / 1500, 1.66 / 1500};
    for (int c = 0; c < 3; ++c) values[c * bins + bin] = above ? f[c] / scale[c] : -1;
  }
  std::string bytes(sizeof size + values.size() * sizeof(double), '\0');
  std::memcpy(bytes.data(), size, sizeof size);
  std::memcpy(bytes.data() + sizeof size, values.data(), values.size() * sizeof(double));
  return bytes;
}

}  // namespace lobe::test
