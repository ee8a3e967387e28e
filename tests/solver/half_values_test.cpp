#include "solver/half_values.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace lobe {
namespace {

TEST(HalfValuesTest, ErrorsAreWithinWhatIsStated) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> mantissa(-1, 1), exponent(-45, 0);
  for (const float largest : {1e-30f, 3e-5f, 1.0f, 65504.0f, 7e20f, 3.4e38f}) {
    std::vector<float> values = {largest, -largest, 0};
    for (int i = 0; i < 5000; ++i) {
      values.push_back(largest * mantissa(random) * std::exp2(exponent(random)));
    }
    const HalfValues halves = ToHalf(values);
    for (size_t i = 0; i < values.size(); ++i) {
      const double v = values[i], error = std::abs(double(FromHalf(halves.bits[i], halves.scale)) - v);
      const double stated = std::abs(v) > std::ldexp(double(largest), -28) ? std::ldexp(std::abs(v), -11)
                                                                           : std::ldexp(double(largest), -39);
      EXPECT_LE(error, stated) << v << " of " << largest;
    }
  }
}

TEST(HalfValuesTest, ScaleIsAPowerOfTwoThatLeavesHeadroom) {
  for (const float largest : {1e-20f, 0.1f, 1.0f, 2.0f, 12345.0f, 3e38f}) {
    const HalfValues halves = ToHalf(std::vector<float>{0.01f * largest, -largest});
    int exponent = 0;
    EXPECT_EQ(std::frexp(halves.scale, &exponent), 0.5f);
    EXPECT_GE(largest / halves.scale, 16384);
    EXPECT_LT(largest / halves.scale, 32768);
  }
}

TEST(HalfValuesTest, WhatHalvesHoldComesBackExactly) {
  const std::vector<float> values = {0.0f, 1.0f, -0.5f, 1.5f, 0.0009765625f};
  const HalfValues halves = ToHalf(values);
  for (size_t i = 0; i < values.size(); ++i) EXPECT_EQ(FromHalf(halves.bits[i], halves.scale), values[i]);
}

TEST(HalfValuesTest, DarknessAndOverflowStayWhatTheyAre) {
  const HalfValues dark = ToHalf(std::vector<float>{0, 0});
  EXPECT_EQ(dark.scale, 1);
  EXPECT_EQ(FromHalf(dark.bits[1], dark.scale), 0);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const HalfValues lost = ToHalf(std::vector<float>{kInfinity, -kInfinity, std::nanf(""), 3});
  EXPECT_EQ(FromHalf(lost.bits[0], lost.scale), kInfinity);
  EXPECT_EQ(FromHalf(lost.bits[1], lost.scale), -kInfinity);
  EXPECT_TRUE(std::isnan(FromHalf(lost.bits[2], lost.scale)));
  EXPECT_EQ(FromHalf(lost.bits[3], lost.scale), 3);
}

TEST(HalfValuesTest, TheDimmestFloatsLoseDigitsButTheScaleStaysNormal) {
  const HalfValues halves = ToHalf(std::vector<float>{1e-42f, 0});
  EXPECT_GE(halves.scale, std::numeric_limits<float>::min());
}

}  // namespace
}  // namespace lobe
