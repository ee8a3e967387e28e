#include "render/image.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "render/false_colour.h"

namespace lobe {
namespace {

TEST(ImageTest, RowsRunFromTheTopLeft) {
  Image image(3, 2);
  image.at(2, 1) = Rgb(1, 2, 3);
  EXPECT_EQ(image.pixels.size(), 6u);
  EXPECT_EQ(image.pixels[5][1], 2);
  EXPECT_EQ(image.pixels[4][1], 0);
}

// Values of IEC 61966-2-1's own formula, worked by hand: 0.2140 shows as half, 0.0031308 is the joint.
TEST(Srgb8Test, FollowsTheStandardsTransferFunction) {
  EXPECT_EQ(ToSrgb8(0.0f), 0);
  EXPECT_EQ(ToSrgb8(1.0f), 255);
  EXPECT_EQ(ToSrgb8(0.2140f), 127);  // 1.055 * 0.2140^(1/2.4) - 0.055 = 0.49998, times 255 is 127.49
  EXPECT_EQ(ToSrgb8(0.2145f), 128);
  EXPECT_EQ(ToSrgb8(0.0031308f), 10);  // 12.92 * 0.0031308 * 255 = 10.31
  EXPECT_EQ(ToSrgb8(0.18f), 118);      // 0.46136 * 255 = 117.65
}

TEST(Srgb8Test, ExposureIsInStops) {
  EXPECT_EQ(ToSrgb8(0.045f, 2), ToSrgb8(0.18f));
  EXPECT_EQ(ToSrgb8(0.72f, -2), ToSrgb8(0.18f));
}

TEST(Srgb8Test, ClampsWhatDoesNotFit) {
  EXPECT_EQ(ToSrgb8(7.0f), 255);
  EXPECT_EQ(ToSrgb8(std::numeric_limits<float>::infinity()), 255);
  EXPECT_EQ(ToSrgb8(-0.3f), 0);
  EXPECT_EQ(ToSrgb8(std::nanf("")), 0);
}

TEST(Srgb8Test, RoundTripsEveryByte) {
  for (int byte = 0; byte < 256; ++byte) {
    EXPECT_EQ(ToSrgb8(FromSrgb8(static_cast<unsigned char>(byte))), byte);
  }
}

TEST(FalseColourTest, LightnessRisesAllTheWay) {
  float previous = -1;
  for (int i = 0; i <= 100; ++i) {
    const float y = Luminance(FalseColour(i / 100.0));
    EXPECT_GT(y, previous) << "at " << i << " %";
    previous = y;
  }
  EXPECT_EQ(FalseColourBytes(-1), FalseColourBytes(0));
  EXPECT_EQ(FalseColourBytes(2), FalseColourBytes(1));
}

}  // namespace
}  // namespace lobe
