#include "render/compare.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/exr.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Image Constant(int width, int height, const Rgb& value) {
  Image image(width, height);
  for (Rgb& p : image.pixels) p = value;
  return image;
}

Mask NoMask(int width, int height) {
  return {width, height, std::vector<bool>(size_t(width) * height, false)};
}

std::string ErrorOf(const Image& a, const Image& r, const Image* s = nullptr, const Mask* mask = nullptr) {
  try {
    Compare(a, r, s, mask);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

Image WithNoise(const Image& image, float sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, sigma);
  Image noisy = image;
  for (Rgb& p : noisy.pixels) p += Rgb(normal(random), normal(random), normal(random));
  return noisy;
}

TEST(CompareTest, EqualPicturesHaveNoError) {
  const Image image = Constant(16, 16, Rgb(1, 2, 3));
  const Comparison c = Compare(image, image, nullptr, nullptr);
  EXPECT_EQ(c.pixel_error, 0);
  EXPECT_EQ(c.block_error, 0);
  EXPECT_EQ(c.pixels, 256u);
  EXPECT_DOUBLE_EQ(c.mean, 2);
  EXPECT_DOUBLE_EQ(c.reference_mean, 2);
  EXPECT_FALSE(c.reference_pixel_noise);
}

// rms over channels of (0.1, 0.2, -0.2) is sqrt(0.09 / 3); the mean over channels together is 2.
TEST(CompareTest, ConstantOffsetIsItsRmsOverTheMean) {
  const Comparison c =
      Compare(Constant(20, 13, Rgb(1.1f, 2.2f, 2.8f)), Constant(20, 13, Rgb(1, 2, 3)), nullptr, nullptr);
  EXPECT_NEAR(c.pixel_error, std::sqrt(0.03) / 2, 1e-7);
  EXPECT_NEAR(c.block_error, std::sqrt(0.03) / 2, 1e-7) << "a bias survives averaging";
}

TEST(CompareTest, BlocksAverageAwayACheckerboard) {
  const Image reference = Constant(16, 16, Rgb::Constant(2));
  Image a = reference;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) a.at(x, y) += (x + y) % 2 ? 0.5f : -0.5f;
  }
  const Comparison c = Compare(a, reference, nullptr, nullptr);
  EXPECT_DOUBLE_EQ(c.pixel_error, 0.25);
  EXPECT_DOUBLE_EQ(c.block_error, 0);
}

// 10 x 9 pixels: blocks of 64, 2 x 8, 8 x 1 and 2 x 1. Only the right edge's block of 16 is off, by 3.
TEST(CompareTest, EdgeBlocksWeighAsManyPixelsAsTheyHave) {
  const Image reference = Constant(10, 9, Rgb::Constant(1));
  Image a = reference;
  for (int y = 0; y < 8; ++y) a.at(8, y) += 6;  // block mean of the error: 3
  const Comparison c = Compare(a, reference, nullptr, nullptr);
  EXPECT_NEAR(c.block_error, std::sqrt(16 * 9 / 90.0), 1e-12);
  EXPECT_NEAR(c.pixel_error, std::sqrt(8 * 36 / 90.0), 1e-12);
}

TEST(CompareTest, MaskedPixelsCountNowhere) {
  const Image reference = Constant(16, 8, Rgb::Constant(1));
  Image r = reference, a = reference;
  Mask mask = NoMask(16, 8);
  // The left block: three pixels stay, of which one is wrong by 0.6. The right block: wrong by 0.1.
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const bool keep = y == 2 && x < 3;
      mask.set[size_t(y) * 16 + x] = !keep;
      if (!keep) a.at(x, y).setConstant(std::nanf("")), r.at(x, y).setConstant(1000);
      a.at(x + 8, y) += 0.1f;
    }
  }
  a.at(1, 2) += 0.6f;
  const Comparison c = Compare(a, r, nullptr, &mask);
  EXPECT_EQ(c.pixels, 67u);
  EXPECT_NEAR(c.reference_mean, 1, 1e-12) << "the mean is over the same pixels";
  EXPECT_NEAR(c.pixel_error, std::sqrt((0.36 + 64 * 0.01) / 67), 1e-6);
  EXPECT_NEAR(c.block_error, std::sqrt((3 * 0.04 + 64 * 0.01) / 67), 1e-6);
}

TEST(CompareTest, ABlockWithNothingLeftIsLeftOut) {
  const Image reference = Constant(16, 8, Rgb::Constant(1));
  Image a = reference;
  Mask mask = NoMask(16, 8);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) mask.set[size_t(y) * 16 + x] = true, a.at(x + 8, y) += 0.5f;
  }
  EXPECT_DOUBLE_EQ(Compare(a, reference, nullptr, &mask).block_error, 0.5);
}

// With noise sigma in each of two references and a true error of e, the estimate of e^2 has standard
// deviation sqrt(sigma^4 + 2 e^2 sigma^2) / sqrt(N): here 0.04 / 443, 9e-5 of 0.01; five of them.
TEST(CompareTest, TwoNoisyReferencesGiveTheTrueErrorOnAverage) {
  const int n = 256;
  const Image truth = Constant(n, n, Rgb::Constant(1));
  const Image a = Constant(n, n, Rgb::Constant(1.1f));
  const Image r = WithNoise(truth, 0.2f, 1), s = WithNoise(truth, 0.2f, 2);
  const Comparison c = Compare(a, r, &s, nullptr);
  const double sigma_of_square = std::sqrt(std::pow(0.2, 4) + 2 * 0.01 * 0.04) / std::sqrt(3.0 * n * n);
  EXPECT_NEAR(c.pixel_error * c.pixel_error, 0.01, 5 * sigma_of_square + 2e-5);
  EXPECT_NEAR(c.block_error, 0.1, 2e-3);
  // One reference alone would blame its noise on the picture.
  EXPECT_NEAR(Compare(a, r, nullptr, nullptr).pixel_error, std::sqrt(0.05), 2e-3);
}

TEST(CompareTest, ReferenceNoiseIsThatOfOneReference) {
  const int n = 256;
  const Image truth = Constant(n, n, Rgb::Constant(2));
  const Image r = WithNoise(truth, 0.3f, 3), s = WithNoise(truth, 0.3f, 4);
  const Comparison c = Compare(truth, r, &s, nullptr);
  // Relative standard deviation of an rms over N values is 1 / sqrt(2 N): 0.16 % and 1.3 %; five of them.
  EXPECT_NEAR(*c.reference_pixel_noise, 0.15, 0.15 * 0.008);
  EXPECT_NEAR(*c.reference_block_noise, 0.15 / 8, 0.15 / 8 * 0.065);
}

TEST(CompareTest, NegativeEstimatePrintsAsZero) {
  const Image a = Constant(8, 8, Rgb::Constant(1));
  const Image r = Constant(8, 8, Rgb::Constant(1.2f)), s = Constant(8, 8, Rgb::Constant(0.8f));
  const Comparison c = Compare(a, r, &s, nullptr);
  EXPECT_EQ(c.pixel_error, 0);
  EXPECT_EQ(c.block_error, 0);
  EXPECT_NEAR(c.reference_mean, 1, 1e-7);
  EXPECT_NEAR(*c.reference_pixel_noise, 0.4 / std::sqrt(2.0), 1e-6);
}

// a and b are independent renderings of one view with equal noise: their rms distance is sqrt(2) times
// the noise of one, relative to the mean of one (a few parts in 1e4 from the mean of both).
TEST(CompareTest, TheTruthsPairsDifferByRootTwoTimesTheirNoise) {
  for (const std::string view : {"cornell_diffuse.view0", "cornell_diffuse.view1", "cornell_glossy.view0"}) {
    const std::string stem = std::string(LOBE_TEST_DATA) + "/truth/" + view;
    const Image a = ReadExr(stem + ".a.exr"), b = ReadExr(stem + ".b.exr");
    const Mask mask = ReadPngMask(stem + ".mask.png");
    const Comparison pair = Compare(a, b, nullptr, &mask);
    const Comparison noise = Compare(a, a, &b, &mask);
    EXPECT_EQ(noise.pixel_error, 0) << "a against a and b: (a - a)(a - b) = 0";
    EXPECT_NEAR(pair.pixel_error / *noise.reference_pixel_noise, std::sqrt(2.0), 5e-3) << view;
    EXPECT_NEAR(pair.block_error / *noise.reference_block_noise, std::sqrt(2.0), 5e-3) << view;
    EXPECT_GT(*noise.reference_pixel_noise, 2 * *noise.reference_block_noise)
        << view << ": noise averages out";
    EXPECT_LT(*noise.reference_block_noise, 0.02) << view;
  }
}

// Per channel (0.3 / 3)^2 with the epsilon of the mean 2: 0.09 / (1 + 0.04) and so on, averaged.
TEST(CompareTest, RelativeMseDividesByTheReferencesOwnSquare) {
  const Image reference = Constant(9, 5, Rgb(1, 2, 3)), a = Constant(9, 5, Rgb(1.3f, 2, 2.4f));
  const Comparison c = Compare(a, reference, nullptr, nullptr);
  const double expected = (0.09 / 1.04 + 0.36 / 9.04) / 3;
  EXPECT_NEAR(c.relative_mse, expected, 1e-7);
  EXPECT_NEAR(c.relative_error.p50, std::sqrt(expected), 1e-6) << "equal pixels: each is the rms";
  EXPECT_NEAR(c.relative_error.max, std::sqrt(expected), 1e-6);
  EXPECT_NEAR(c.bias, (5.7 - 6) / 6, 1e-7);
}

TEST(CompareTest, NoFigureDependsOnTheExposure) {
  const Image truth = Constant(16, 16, Rgb(1, 2, 3));
  Image a = WithNoise(truth, 0.2f, 5);
  const Comparison c = Compare(a, truth, nullptr, nullptr);
  Image bright = truth;
  for (Rgb& p : bright.pixels) p *= 1024;
  for (Rgb& p : a.pixels) p *= 1024;
  const Comparison d = Compare(a, bright, nullptr, nullptr);
  EXPECT_NEAR(d.relative_mse, c.relative_mse, 1e-12);
  EXPECT_NEAR(d.bias, c.bias, 1e-12);
  EXPECT_NEAR(d.relative_error.p99, c.relative_error.p99, 1e-6);
}

// Of 100 pixels, number i is off by i percent: the value that 50, 90 and 99 of them do not exceed.
TEST(CompareTest, PercentilesAreThoseOfTheSortedErrors) {
  const Image reference = Constant(10, 10, Rgb::Constant(1));
  Image a = reference;
  for (int i = 0; i < 100; ++i) a.pixels[(i * 37) % 100] += float(i + 1) / 100;
  const Comparison c = Compare(a, reference, nullptr, nullptr);
  const double unit = 1 / std::sqrt(1 + kRelMseEpsilon);
  EXPECT_NEAR(c.relative_error.p50, 0.50 * unit, 1e-6);
  EXPECT_NEAR(c.relative_error.p90, 0.90 * unit, 1e-6);
  EXPECT_NEAR(c.relative_error.p99, 0.99 * unit, 1e-6);
  EXPECT_NEAR(c.relative_error.max, 1.00 * unit, 1e-6);
}

// relMSE 0.01 / 1.01 from the offset e = 0.1 alone; one reference adds its variance of 0.01 / 1.01. What
// stays is of second order: the denominator's noise n, variance 0.005, is also in the numerator, and the mean
// of (e - n)^2 / (1 + n)^2 exceeds that of e^2 + n^2 by (4 e + 3 e^2) n^2, 0.0022.
TEST(CompareTest, RelativeMseOfTwoReferencesIsFreeOfTheirNoiseToFirstOrder) {
  const int n = 256;
  const Image truth = Constant(n, n, Rgb::Constant(1)), a = Constant(n, n, Rgb::Constant(1.1f));
  const Image r = WithNoise(truth, 0.1f, 1), s = WithNoise(truth, 0.1f, 2);
  EXPECT_NEAR(Compare(a, r, &s, nullptr).relative_mse, 0.01 / 1.01 + 0.0022, 4e-4);
  EXPECT_GT(Compare(a, r, nullptr, nullptr).relative_mse, 0.018);
  const Comparison perfect = Compare(truth, r, &s, nullptr);
  EXPECT_LT(perfect.relative_mse, 1e-3);
}

TEST(CompareTest, LayersWithSignsAreMeasuredByTheirAbsoluteMean) {
  const Image reference = Constant(8, 8, Rgb(-1, 0.5f, 0)), a = Constant(8, 8, Rgb(-1, 0.5f, 0.3f));
  EXPECT_THAT(ErrorOf(a, reference), HasSubstr("mean"));
  const Comparison c = Compare(a, reference, nullptr, nullptr, ErrorScale::kMeanAbsolute);
  EXPECT_NEAR(c.pixel_error, std::sqrt(0.09 / 3) / 0.5, 1e-6);
  EXPECT_NEAR(c.bias, 0.1 / 0.5, 1e-6);
}

TEST(MeanFlipTest, MaskedPixelsWeighNeitherThemselvesNorOnNeighbours) {
  const Image reference = Constant(24, 24, Rgb::Constant(0.3f));
  Image a = reference;
  Mask mask = NoMask(24, 24);
  for (int y = 8; y < 16; ++y) {
    for (int x = 8; x < 16; ++x) {
      a.at(x, y).setConstant(std::nanf(""));
      mask.set[size_t(y) * 24 + x] = true;
    }
  }
  EXPECT_EQ(MeanFlip(a, reference, &mask, 0, ToneCurve::kSrgb, 67.02), 0);
  EXPECT_GT(MeanFlip(a, reference, nullptr, 0, ToneCurve::kSrgb, 67.02), 0.01);
}

TEST(MeanFlipTest, ItSeesWhatTheExposureShows) {
  const Image reference = Constant(16, 16, Rgb::Constant(4)), a = Constant(16, 16, Rgb::Constant(6));
  EXPECT_EQ(MeanFlip(a, reference, nullptr, 0, ToneCurve::kSrgb, 67.02), 0) << "both are white";
  EXPECT_GT(MeanFlip(a, reference, nullptr, -3, ToneCurve::kSrgb, 67.02), 0.1);
}

TEST(SideBySideTest, KeepsEveryPictureWhole) {
  Image a = Constant(2, 2, Rgb::Constant(1)), b = Constant(3, 2, Rgb::Constant(2));
  a.at(1, 1) = Rgb(5, 6, 7);
  b.at(2, 1) = Rgb(8, 9, 10);
  const Image row = SideBySide({&a, &b});
  ASSERT_EQ(row.width, 5);
  ASSERT_EQ(row.height, 2);
  EXPECT_TRUE((row.at(1, 1) == Rgb(5, 6, 7)).all());
  EXPECT_TRUE((row.at(4, 1) == Rgb(8, 9, 10)).all());
  EXPECT_TRUE((row.at(2, 0) == 2).all());
}

TEST(CompareTest, BadInputIsRefusedWithASentence) {
  const Image a = Constant(8, 8, Rgb::Constant(1)), small = Constant(8, 4, Rgb::Constant(1));
  EXPECT_THAT(ErrorOf(a, small), AllOf(HasSubstr("8 x 8"), HasSubstr("8 x 4")));
  EXPECT_THAT(ErrorOf(a, a, &small), HasSubstr("second reference"));
  const Mask small_mask = NoMask(4, 8);
  EXPECT_THAT(ErrorOf(a, a, nullptr, &small_mask), AllOf(HasSubstr("mask"), HasSubstr("4 x 8")));

  Image nan = a;
  nan.at(3, 5)[1] = std::nanf("");
  EXPECT_THAT(ErrorOf(nan, a), AllOf(HasSubstr("the picture"), HasSubstr("(3, 5)"), HasSubstr("channel G")));
  EXPECT_THAT(ErrorOf(a, nan), HasSubstr("the reference"));
  EXPECT_THAT(ErrorOf(a, a, &nan), HasSubstr("the second reference"));

  Mask everything = NoMask(8, 8);
  everything.set.assign(64, true);
  EXPECT_THAT(ErrorOf(a, a, nullptr, &everything), HasSubstr("every pixel"));
  EXPECT_THAT(ErrorOf(a, Constant(8, 8, Rgb::Zero())), HasSubstr("mean"));
}

TEST(DifferencePictureTest, GrowsLighterWithTheError) {
  const Image reference = Constant(8, 8, Rgb::Constant(1));
  Image a = reference;
  a.at(1, 0) += 0.1f;
  a.at(2, 0) -= 0.4f;
  Mask mask = NoMask(8, 8);
  mask.set[3] = true;
  const Image picture = DifferencePicture(a, reference, &mask, 1);
  EXPECT_LT(Luminance(picture.at(0, 0)), Luminance(picture.at(1, 0)));
  EXPECT_LT(Luminance(picture.at(1, 0)), Luminance(picture.at(2, 0)));
  EXPECT_TRUE((picture.at(3, 0) == picture.at(3, 0)[0]).all()) << "the mask is grey";
}

}  // namespace
}  // namespace lobe
