#include "render/flip.h"

#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/slow_flip.h"

namespace lobe {
namespace {

Image Constant(int width, int height, const Rgb& value) {
  Image image(width, height);
  for (Rgb& p : image.pixels) p = value;
  return image;
}

double Mean(const std::vector<float>& map) {
  return std::accumulate(map.begin(), map.end(), 0.0) / double(map.size());
}

/// FLIP of two even pictures: filters and features do nothing, so it is the colour part alone.
double OfConstants(const Rgb& a, const Rgb& b) {
  const auto map = FlipMap(Constant(8, 8, a), Constant(8, 8, b));
  for (const float v : map) EXPECT_NEAR(v, map[0], 1e-5f);
  return map[0];
}

/// White from column `left` on, `width` columns of it, on black.
Image Bar(int left, int width) {
  Image image(64, 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = left; x < left + width; ++x) image.at(x, y).setOnes();
  }
  return image;
}

TEST(FlipTest, EqualPicturesDoNotDiffer) {
  const Image bar = Bar(20, 9);
  for (const float v : FlipMap(bar, bar)) EXPECT_EQ(v, 0);
}

// By hand from the paper's section 4. Green is L*a*b* (87.74, -86.18, 83.19), Hunt-adjusted (87.74, -75.61,
// 72.98); blue (32.30, 79.20, -107.86), adjusted (32.30, 25.58, -34.84); their HyAB distance 203.3, to the
// power 0.7: 41.277, is the largest there is and becomes 1. Black and white are 100 apart, 100^0.7 = 25.119,
// beyond the knee at 0.4 x 41.277 = 16.511: 0.95 + 0.05 (25.119 - 16.511) / (41.277 - 16.511) = 0.96738.
TEST(FlipTest, ColourPartIsThatOfThePaper) {
  EXPECT_NEAR(OfConstants(Rgb(0, 1, 0), Rgb(0, 0, 1)), 1, 1e-4);
  EXPECT_NEAR(OfConstants(Rgb::Zero(), Rgb::Ones()), 0.96738, 1e-4);
  // Greys of 0.2 and 0.25 have L* 51.837 and 57.075: 5.238^0.7 x 0.95 / 16.511.
  EXPECT_NEAR(OfConstants(Rgb::Constant(0.2f), Rgb::Constant(0.25f)), 0.18340, 1e-4);
  // (56.963, 31.356, 16.673) and (73.856, -36.909, 22.371), Hunt-adjusted.
  EXPECT_NEAR(OfConstants(Rgb(0.8f, 0.1f, 0.1f), Rgb(0.1f, 0.6f, 0.2f)), 0.96207, 1e-4);
}

// From so near that colours are not blurred (5 pixels per degree), a step of 0.05 beside an even picture: on
// its right the colour part of the test above, raised in the first column to the power
// 1 - sqrt(0.05 / sqrt 2) = 0.81197, since the edge filter answers with the whole step there.
TEST(FlipTest, AnEdgeThatTheOtherPictureLacksShowsMore) {
  const Image even = Constant(16, 8, Rgb::Constant(0.2f));
  Image step = even;
  for (int y = 0; y < 8; ++y) {
    for (int x = 8; x < 16; ++x) step.at(x, y).setConstant(0.25f);
  }
  const auto map = FlipMap(step, even, 5);
  const size_t row = 4 * 16;
  EXPECT_NEAR(map[row + 3], 0, 1e-4);
  EXPECT_NEAR(map[row + 13], 0.18340, 1e-4);
  EXPECT_NEAR(map[row + 8], std::pow(0.18340, 0.81197), 1e-3);
}

// Two routes: separated kernels in float, and the paper's square ones in double, on a picture of everything.
TEST(FlipTest, AgreesWithThePapersSquareKernels) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  Image a(40, 30), b(40, 30);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      // Left: smooth colours against others; right: coarse noise against the same but darker.
      a.at(x, y) =
          x < 20 ? Rgb(x / 20.0f, y / 30.0f, 0.5f) : Rgb(uniform(random), uniform(random), uniform(random));
      b.at(x, y) = x < 20 ? Rgb(y / 30.0f, 0.3f, x / 20.0f) : Rgb(0.7f * a.at(x, y));
    }
  }
  for (const double ppd : {12.0, kFlipPixelsPerDegree}) {
    const test::SlowFlip slow(ppd);
    const auto map = FlipMap(a, b, ppd);
    for (const auto& [x, y] :
         {std::pair(0, 0), {39, 29}, {5, 17}, {19, 11}, {20, 12}, {31, 3}, {27, 22}, {12, 29}}) {
      const double expected = slow.At(a, b, x, y);
      EXPECT_GT(expected, 0.02) << x << "," << y;
      EXPECT_NEAR(map[y * 40 + x], expected, 2e-4) << x << "," << y << " at " << ppd;
    }
  }
}

TEST(FlipTest, IsSymmetric) {
  const Image a = Bar(20, 9), b = Bar(23, 5);
  const auto ab = FlipMap(a, b), ba = FlipMap(b, a);
  for (size_t i = 0; i < ab.size(); ++i) ASSERT_EQ(ab[i], ba[i]);
}

TEST(FlipTest, GrowsWithAShift) {
  double last = 0;
  for (int shift = 1; shift <= 5; ++shift) {
    const double flip = Mean(FlipMap(Bar(20, 8), Bar(20 + shift, 8)));
    EXPECT_GT(flip, last) << shift;
    last = flip;
  }
}

TEST(FlipTest, FinePatternsMeltIntoTheirMeanFromAfar) {
  const Image grey = Constant(64, 64, Rgb::Constant(0.5f));
  Image pattern = grey;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) pattern.at(x, y).setConstant((x + y) % 2 ? 1.0f : 0.0f);
  }
  EXPECT_GT(Mean(FlipMap(pattern, grey, 10)), 0.5);
  EXPECT_LT(Mean(FlipMap(pattern, grey, 300)), 0.05);
}

// Turning both pictures turns the map: no filter prefers an axis. Rounding of 1e-4 in L*a*b* becomes 1e-4 of
// FLIP by the power 0.7, and more where features raise it.
TEST(FlipTest, AxesAreAlike) {
  const Image a = Bar(10, 6), b = Bar(12, 3);
  Image ta(16, 64), tb(16, 64);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 64; ++x) ta.at(y, x) = a.at(x, y), tb.at(y, x) = b.at(x, y);
  }
  const auto map = FlipMap(a, b), turned = FlipMap(ta, tb);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 64; ++x) ASSERT_NEAR(map[y * 64 + x], turned[x * 16 + y], 1e-3f);
  }
}

TEST(FlipTest, RefusesWhatItCannotCompare) {
  EXPECT_THROW(FlipMap(Image(2, 2), Image(2, 3)), std::invalid_argument);
  EXPECT_THROW(FlipMap(Image(2, 2), Image(2, 2), 4.9), std::invalid_argument);
  EXPECT_THROW(FlipMap(Image(2, 2), Image(2, 2), std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace lobe
