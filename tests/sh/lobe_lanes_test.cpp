#include "sh/lobe_lanes.h"

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "sh/hemisphere_basis.h"

namespace lobe {
namespace {

// Basis and dot product in double are the second opinion. Rounding: as LobeReaderTest, a few units in the
// last place of the sum of the terms' absolute values.
TEST(LobeLanesTest, AgreesWithBasisAndDotProductAndAdds) {
  constexpr double kRounding = 2e-6;
  std::mt19937 bits(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  alignas(64) float x[kLanes], y[kLanes], z[kLanes], out[3 * kLanes];
  for (int i = 0; i < kLanes; ++i) {  // the pole, the horizon, and generic ones
    const double theta = i == 0 ? 0 : i == 1 ? M_PI / 2 : 0.1 * i - 0.1, phi = 2.3 * i;
    x[i] = float(std::sin(theta) * std::cos(phi));
    y[i] = float(std::sin(theta) * std::sin(phi));
    z[i] = float(std::max(0.0, std::cos(theta)));
  }
  for (const int table : {0, 7, 20, 64}) {
    const LobeLanes lanes(table);
    for (const int l : {0, 1, 2, 7, 12, 20, 33, 64}) {
      if (l > table) continue;
      const int count = CoefficientCount(l);
      std::vector<float> lobe(size_t(3) * count);
      for (float& c : lobe) c = uniform(bits);
      std::fill(out, out + 3 * kLanes, 0.5f);
      lanes.Add(lobe.data(), l, x, y, z, out);
      const HemisphereBasis<double> basis(l);
      std::vector<double> h(count);
      for (int i = 0; i < kLanes; ++i) {
        basis.Evaluate(x[i], y[i], z[i], h.data());
        for (int c = 0; c < 3; ++c) {
          double expected = 0.5, scale = 0.5;
          for (int k = 0; k < count; ++k) {
            expected += lobe[size_t(c) * count + k] * h[k];
            scale += std::abs(lobe[size_t(c) * count + k] * h[k]);
          }
          EXPECT_NEAR(out[c * kLanes + i], expected, kRounding * scale) << table << " " << l << " " << i;
        }
      }
    }
  }
}

TEST(LobeLanesTest, RefusesDegreesOutOfRange) {
  EXPECT_THROW(LobeLanes(-1), std::invalid_argument);
  EXPECT_THROW(LobeLanes(65), std::invalid_argument);
}

}  // namespace
}  // namespace lobe
