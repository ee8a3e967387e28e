#include "render/tone.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace lobe {
namespace {

constexpr ToneCurve kAll[] = {ToneCurve::kSrgb, ToneCurve::kReinhard, ToneCurve::kFilmic};

TEST(ToneTest, CurvesNeverFallAndStayWithinZeroAndOne) {
  for (const ToneCurve curve : kAll) {
    float last = ToneMap(curve, 0);
    EXPECT_EQ(last, 0);
    for (float x = 1e-6f; x < 1e9f; x *= 1.01f) {
      const float y = ToneMap(curve, x);
      ASSERT_GE(y, last) << x;
      ASSERT_LE(y, 1) << x;
      last = y;
    }
    EXPECT_EQ(last, 1);
  }
}

TEST(ToneTest, EachReachesOneAtItsOwnWhiteAndNotBefore) {
  const std::pair<ToneCurve, float> whites[] = {
      {ToneCurve::kSrgb, 1.0f}, {ToneCurve::kReinhard, kReinhardWhite}, {ToneCurve::kFilmic, kFilmicWhite}};
  for (const auto& [curve, white] : whites) {
    EXPECT_EQ(ToneMap(curve, white), 1);
    EXPECT_NEAR(ToneMap(curve, 0.9999f * white), 1, 1e-3) << "no jump where it is cut";
    EXPECT_LT(ToneMap(curve, 0.97f * white), 1);
  }
}

// Reinhard: 1 (1 + 1/16) / 2. Hable, by hand: h(x) = (x(0.15x+0.05)+0.004)/(x(0.15x+0.5)+0.06) - 1/15;
// h(2) = 0.704/1.66 - 1/15 = 0.357430, h(11.2) = 19.38/24.476 - 1/15 = 0.725129.
TEST(ToneTest, PublishedCurvesHaveTheirPublishedValues) {
  EXPECT_FLOAT_EQ(ToneMap(ToneCurve::kSrgb, 0.37f), 0.37f);
  EXPECT_NEAR(ToneMap(ToneCurve::kReinhard, 1), 0.53125, 1e-6);
  EXPECT_NEAR(ToneMap(ToneCurve::kFilmic, 1), 0.357430 / 0.725129, 2e-5);
}

TEST(ToneTest, BrokenValuesShowAsBlackAndInfinityAsWhite) {
  for (const ToneCurve curve : kAll) {
    EXPECT_EQ(ToneMap(curve, std::nanf("")), 0);
    EXPECT_EQ(ToneMap(curve, -1), 0);
    EXPECT_EQ(ToneMap(curve, std::numeric_limits<float>::infinity()), 1);
    EXPECT_EQ(ToneMap(curve, std::numeric_limits<float>::max()), 1);
  }
}

TEST(ToneTest, ExposureComesBeforeTheCurve) {
  Image image(1, 1);
  image.at(0, 0) = Rgb(0.1f, 0.2f, 0.6f);
  for (const ToneCurve curve : kAll) {
    const Image shown = ToneMapped(image, 2, curve);
    for (int c = 0; c < 3; ++c) {
      EXPECT_FLOAT_EQ(shown.at(0, 0)[c], ToneMap(curve, 4 * image.at(0, 0)[c]));
    }
  }
}

TEST(ToneTest, NamesAreKnown) {
  EXPECT_EQ(ToneCurveNamed("srgb"), ToneCurve::kSrgb);
  EXPECT_EQ(ToneCurveNamed("reinhard"), ToneCurve::kReinhard);
  EXPECT_EQ(ToneCurveNamed("filmic"), ToneCurve::kFilmic);
  EXPECT_FALSE(ToneCurveNamed("sRGB2"));
}

}  // namespace
}  // namespace lobe
