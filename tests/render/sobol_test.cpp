#include "render/sobol.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace lobe {
namespace {

TEST(SobolPointsTest, EveryAlignedRunHasOnePointInEachElementaryInterval) {
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    const SobolPoints points(Mix(seed));
    for (int k = 0; k <= 8; ++k) {
      const uint32_t count = 1u << k;
      for (const uint32_t run : {0u, 1u, 2u, 37u, 1000u}) {
        for (int columns = 0; columns <= k; ++columns) {  // 2^columns by 2^(k - columns) cells
          std::vector<int> in_cell(count, 0);
          for (uint32_t i = 0; i < count; ++i) {
            const auto [x, y] = points.At(run * count + i);
            ASSERT_TRUE(x >= 0 && x < 1 && y >= 0 && y < 1);
            const auto column = uint32_t(std::ldexp(x, columns)), row = uint32_t(std::ldexp(y, k - columns));
            ++in_cell[(row << columns) + column];
          }
          for (const int n : in_cell) ASSERT_EQ(n, 1) << "seed " << seed << ", run of 2^" << k;
        }
      }
    }
  }
}

TEST(SobolPointsTest, EachPointAloneIsUniform) {
  constexpr int kSeeds = 8192, kBins = 8;
  for (const uint32_t index : {0u, 1u, 6u, 4097u}) {
    std::vector<int> count(kBins * kBins, 0);
    for (int seed = 0; seed < kSeeds; ++seed) {
      const auto [x, y] = SobolPoints(Mix(uint64_t(seed))).At(index);
      ++count[int(y * kBins) * kBins + int(x * kBins)];
    }
    double chi2 = 0;
    for (const int n : count) chi2 += std::pow(n - kSeeds / 64.0, 2) / (kSeeds / 64.0);
    // 63 degrees of freedom: standard deviation sqrt(126); five of them either way.
    EXPECT_NEAR(chi2, 63, 5 * std::sqrt(126.0)) << "point " << index;
  }
}

// Points of two sequences taken in one order belong together: unshuffled, the first bit of one decides that
// of the other, and half of the square of both never occurs, however many points there are.
TEST(SobolPointsTest, SequencesOfDifferentSeedsAreIndependentDimensionsOfOnePoint) {
  constexpr int kPairs = 400, kPoints = 1024;
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) {
      double sum = 0, squares = 0;
      for (int pair = 0; pair < kPairs; ++pair) {
        const SobolPoints one(Mix(uint64_t(pair), 1)), other(Mix(uint64_t(pair), 2));
        int both_low = 0;
        for (uint32_t i = 0; i < kPoints; ++i) both_low += one.At(i)[a] < 0.5f && other.At(i)[b] < 0.5f;
        // Neighbours lie in different halves, so a pair of points gives one hit or none: binomial.
        const double z = (both_low - kPoints / 4) / std::sqrt(kPoints / 8.0);
        sum += z;
        squares += z * z;
      }
      EXPECT_NEAR(sum / kPairs, 0, 5 / std::sqrt(double(kPairs))) << a << b;
      EXPECT_NEAR(squares / kPairs, 1, 5 * std::sqrt(2.0 / kPairs)) << a << b;
    }
  }
}

TEST(SobolPointsTest, MeansOfSmoothFunctionsConvergeFasterThanAtRandom) {
  const auto error = [](uint32_t count, auto&& point) {
    constexpr int kSeeds = 64;
    const double exact = std::pow(std::exp(1.0) - 1, 2);
    double squares = 0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      double sum = 0;
      for (uint32_t i = 0; i < count; ++i) {
        const auto [x, y] = point(uint64_t(seed), i);
        sum += std::exp(double(x) + double(y));
      }
      squares += std::pow(sum / count - exact, 2);
    }
    return std::sqrt(squares / kSeeds);
  };
  const auto sobol = [](uint64_t seed, uint32_t i) { return SobolPoints(Mix(seed)).At(i); };
  const auto random = [](uint64_t seed, uint32_t i) {
    RandomStream stream(Mix(seed, i));
    const float x = stream.Next();
    return std::array<float, 2>{x, stream.Next()};
  };
  EXPECT_LT(error(64, sobol), 0.1 * error(64, random));
  // Sixteen times as many points: 4 times better at random, 64 times by Owen's law.
  EXPECT_GT(error(64, sobol) / error(1024, sobol), 30);
  EXPECT_LT(error(64, random) / error(1024, random), 6);
}

}  // namespace
}  // namespace lobe
