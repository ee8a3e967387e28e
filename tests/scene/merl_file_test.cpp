#include "scene/merl_file.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "scene/measured_file.h"
#include "tests/support/input_errors.h"
#include "tests/support/merl_writer.h"

namespace lobe {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
using test::ExpectInputError;
using test::FromHalfDifference;
using test::WriteWholeFile;

const Ward& Model() {
  static const Ward model{Rgb(0.8f, 0.5f, 0.2f), 0.2f};
  return model;
}

// Written once: it has 35 megabytes.
const std::string& Bytes() {
  static const std::string bytes = test::MerlBytes(Model());
  return bytes;
}

MeasuredBrdf ReadBack(const std::string& bytes) {
  const test::ScratchFolder folder;
  WriteWholeFile(folder.File("paint.binary"), bytes);
  return *ReadMerlFile(folder.File("paint.binary")).data;
}

TEST(MerlFileTest, BinsAreReadAtTheirCentres) {
  const MeasuredBrdf f = ReadBack(Bytes());
  EXPECT_EQ(f.name(), "paint.binary");
  for (const auto& [i, j, k] :
       {std::array{0, 0, 0}, {3, 20, 100}, {17, 44, 179}, {40, 10, 91}, {30, 60, 0}}) {
    const auto [wi, wo] =
        FromHalfDifference((i + 0.5) * (i + 0.5) / 90 * kDegree, (j + 0.5) * kDegree, (k + 0.5) * kDegree);
    ASSERT_TRUE(wi.z() > 0 && wo.z() > 0);
    const Rgb expected = EvaluateBrdf(Model(), wi, wo), got = f.Value(wi, wo);
    EXPECT_TRUE(((got - expected).abs() <= 1e-5f * expected).all())
        << i << ' ' << j << ' ' << k << ": " << got.transpose() << " against " << expected.transpose();
  }
}

// As file systems without small letters bring them.
TEST(MerlFileTest, EndingsInCapitalsAreMerlsToo) {
  const test::ScratchFolder folder;
  for (const char* name : {"X.binary", "X.BINARY", "X.Binary"}) {
    WriteWholeFile(folder.File(name), "short");
    ExpectInputError([&] { ReadMeasuredFile(folder.File(name)); },
                     {std::string(name) + ": ends after 5 bytes"});
  }
}

// Between centres the format's own error: linear interpolation along an axis with a step h is off by at most
// h^2 / 8 times the largest second derivative, which is measured here on the model itself, over the bins
// around. Points whose bins reach below the horizon are left out: there data ends.
TEST(MerlFileTest, AModelComesBackWithinTheErrorOfItsSampling) {
  const MeasuredBrdf f = ReadBack(Bytes());
  const auto model = [&](double h, double d, double phi, bool* above) {
    const auto [wi, wo] = FromHalfDifference(h, d, phi);
    *above = *above && wi.z() > 0.02 && wo.z() > 0.02;
    return double(EvaluateBrdf(Model(), wi, wo)[1]);
  };
  std::mt19937_64 bits(3);
  std::uniform_real_distribution<double> u(0, 1);
  int tried = 0;
  double worst = 0, allowed_there = 0, worst_relative = 0;
  while (tried < 3000) {
    const double x[3] = {std::pow(0.85 * u(bits) + 0.03, 2) * 90 * kDegree, 80 * u(bits) * kDegree,
                         90 * u(bits) * kDegree};
    const double ring = std::sqrt(x[0] / kDegree * 90);
    const double step[3] = {(2 * ring + 1) / 90 * kDegree, kDegree, kDegree};
    bool above = true;
    const double at = model(x[0], x[1], x[2], &above);
    double bound = 0;
    for (int axis = 0; axis < 3; ++axis) {
      double most = 0;
      for (const double shift : {-1.0, -0.5, 0.0, 0.5, 1.0}) {  // centres of second differences
        const auto second = [&](double by) {
          double p[3] = {x[0], x[1], x[2]};
          p[axis] += (shift + by) * step[axis];
          return model(p[0], p[1], p[2], &above);
        };
        most = std::max(most, std::abs(second(-0.5) + second(0.5) - 2 * second(0)) / 0.25);
      }
      bound += most / 8;
    }
    if (!above) continue;
    ++tried;
    const auto [wi, wo] = FromHalfDifference(x[0], x[1], x[2]);
    const double error = std::abs(f.Value(wi, wo)[1] - at);
    EXPECT_LE(error, 1.2 * bound + 1e-5 * at)
        << x[0] / kDegree << ' ' << x[1] / kDegree << ' ' << x[2] / kDegree;
    if (at > 0.01) worst_relative = std::max(worst_relative, error / at);
    if (error > worst) worst = error, allowed_there = bound;
  }
  RecordProperty("worst_relative_above_0.01_per_sr", std::to_string(worst_relative));
  EXPECT_GT(worst, 0.2 * allowed_there) << "the bound says something";
}

// The whole reflectance: albedo of the data against the model's, up to 80 degrees.
TEST(MerlFileTest, AlbedoOfTheDataIsTheModels) {
  const MeasuredBrdf f = ReadBack(Bytes());
  for (const double theta : {0.0, 0.5, 1.0, 1.3}) {
    const auto expected =
        SlowAlbedo([](const Vec3d& wi, const Vec3d& wo) { return EvaluateBrdf(Model(), wi, wo); }, theta);
    const Rgb got = f.Albedo(std::cos(theta));
    EXPECT_TRUE(((got.cast<double>() - expected).abs() < 0.01 * expected).all())
        << theta << ": " << got.transpose() << " against " << expected.transpose();
  }
}

TEST(MerlFileTest, MirrorImagesAreAveragedAndMissingOnesLeftOut) {
  std::string bytes = Bytes();
  const auto set = [&](size_t i, size_t j, size_t k, double value) {
    std::memcpy(&bytes[12 + 8 * ((i * 90 + j) * 180 + k)], &value, 8);
  };
  set(2, 30, 10, 3000), set(2, 30, 169, 6000);  // red 2 and 4
  set(3, 40, 10, -1), set(3, 40, 169, 4500);
  set(4, 50, 10, -1), set(4, 50, 169, -7);
  const MeasuredBrdf f = ReadBack(bytes);
  const auto red = [&](int i, int j) {
    const auto [wi, wo] =
        FromHalfDifference((i + 0.5) * (i + 0.5) / 90 * kDegree, (j + 0.5) * kDegree, 10.5 * kDegree);
    return f.Value(wi, wo)[0];
  };
  EXPECT_NEAR(red(2, 30), 3, 1e-4);
  EXPECT_NEAR(red(3, 40), 3, 1e-4);
  EXPECT_NEAR(red(4, 50), red(3, 50), 1e-4 * red(3, 50)) << "of the ring before";
}

TEST(MerlFileTest, BrokenFilesAreRefusedInOneSentence) {
  const test::ScratchFolder folder;
  const std::string path = folder.File("bad.binary");
  const auto refused = [&](const std::string& bytes, std::initializer_list<std::string> words) {
    WriteWholeFile(path, bytes);
    ExpectInputError([&] { ReadMerlFile(path); }, {"bad.binary: "});
    ExpectInputError([&] { ReadMerlFile(path); }, words);
  };
  ExpectInputError([&] { ReadMerlFile(folder.File("none.binary")); }, {"none.binary: no such file"});
  ExpectInputError([&] { ReadMerlFile(folder.path()); }, {"not a regular file"});
  refused("", {"ends after 0 bytes", "34992012"});
  refused(Bytes().substr(0, 11), {"ends after 11 bytes"});
  refused(Bytes().substr(0, 1000000), {"holds 1000000 bytes, expected 34992012", "truncated"});
  refused(Bytes() + "x", {"holds 34992013 bytes, expected 34992012"});
  refused(Bytes() + Bytes() + "x", {"expected at most"});
  std::string wrong = Bytes().substr(0, 1000);
  wrong[0] = 45;
  refused(wrong, {"its dimensions are 45 x 90 x 180, expected MERL's 90 x 90 x 180"});
  const auto with = [](size_t value, double number) {
    std::string bytes = Bytes();
    std::memcpy(&bytes[12 + 8 * value], &number, 8);
    return bytes;
  };
  refused(with(1458000 + 77, NAN), {"value 77 of channel 1 is nan, expected a number"});
  refused(with(5, 1e300), {"value 5 of channel 0 is 1e+300", "at most 1e9"});
  refused(with(5, -INFINITY), {"value 5 of channel 0 is -inf"});
  // Both mirror images of the first bin of blue.
  std::string dark = with(2 * 1458000, -2);
  const double less = -2;
  std::memcpy(&dark[12 + 8 * (2 * 1458000 + 179)], &less, 8);
  refused(dark, {"channel 2 is -2 at its first bin"});
}

}  // namespace
}  // namespace lobe
