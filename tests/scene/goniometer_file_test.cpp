#include "scene/goniometer_file.h"

#include <cmath>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

#include "scene/measured_file.h"
#include "tests/support/brdf_laws.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace lobe {
namespace {

using test::ExpectInputError;

constexpr double kDegree = std::numbers::pi / 180;

MeasuredBrdf Read(const std::string& text) {
  const test::ScratchFolder folder;
  test::WriteWholeFile(folder.File("paint.csv"), text);
  return *ReadMeasuredFile(folder.File("paint.csv")).data;
}

// Two of each angle: eight rows.
const char* const kSmall =
    "0 0 0 0.1\n0 0 180 0.1\n0 60 0 0.2\n0 60 180 0.2\n60 0 0 0.2\n60 0 180 0.2\n60 60 0 0.3\n60 60 180 "
    "0.5\n";

TEST(GoniometerFileTest, AModelComesBackWithinTheErrorOfLinearInterpolation) {
  const Phong model{Rgb(0.8f, 0.5f, 0.2f), 4};
  std::ostringstream text;
  text.precision(9);
  text << "# a test\ntheta_i,theta_o,dphi,R,G,B\n";
  constexpr int kStep = 3;
  for (int i = 0; i <= 90; i += kStep) {
    for (int o = 0; o <= 90; o += kStep) {
      for (int phi = 0; phi <= 180; phi += kStep) {
        // At 90 degrees the closed form is 0, and what it tends to is 89.9999's.
        const Rgb f = EvaluateBrdf(model, SphericalDirection(std::min(i * kDegree, 1.5707), 0),
                                   SphericalDirection(std::min(o * kDegree, 1.5707), phi * kDegree));
        text << i << ',' << o << ',' << phi << ',' << f[0] << ", " << f[1] << ';' << f[2] << "\r\n";
      }
    }
  }
  const MeasuredBrdf f = Read(text.str());
  EXPECT_EQ(f.name(), "paint.csv");
  EXPECT_EQ(f.coordinates(), MeasuredBrdf::Coordinates::kIncidentOutgoing);
  // cos^n has second derivatives of at most n f_max along any great circle, theta and phi being no longer
  // than such; three axes, step^2 / 8 each.
  const double step = kStep * kDegree, peak = 0.8 * 6 / (2 * std::numbers::pi);
  const double bound = 3 * step * step / 8 * 4 * peak;
  for (const double ti : {0.01, 0.4, 1.1, 1.5}) {
    for (const double to : {0.2, 0.93, 1.4}) {
      for (const double phi : {0.1, 1.7, 3.1, 4.4}) {
        const Vec3d wi = SphericalDirection(ti, 0.3), wo = SphericalDirection(to, 0.3 + phi);
        EXPECT_LT((f.Value(wi, wo) - EvaluateBrdf(model, wi, wo)).abs().maxCoeff(), bound)
            << ti << ' ' << to << ' ' << phi;
      }
    }
  }
}

TEST(GoniometerFileTest, GreyTablesCommentsHeadingsAndSeparatorsAreRead) {
  for (const std::string& text :
       {std::string(kSmall), "theta_i theta_o dphi f_r\n" + std::string(kSmall),
        "# made by hand\n\n  # more\n" + std::string(kSmall) + "\n\n# end",
        std::string(
            "0,0,0,0.1\n0;0;180;0.1\n0\t60\t0\t0.2 # here\n0,60,180,+0.2\n60,0,0,2e-1\n60,0,180,.2\n60,60,0,"
            "0.3\n60,60,180,0.5")}) {
    const MeasuredBrdf f = Read(text);
    EXPECT_EQ(f.values().size(), 24u);
    const Vec3d wi = SphericalDirection(60 * kDegree, 0);
    EXPECT_NEAR(f.Value(wi, SphericalDirection(60 * kDegree, std::numbers::pi))[2], 0.5, 1e-6) << "dphi 180";
    EXPECT_NEAR(f.Value(wi, wi)[0], 0.3, 1e-6) << "dphi 0: back to the light";
    EXPECT_NEAR(f.Value(wi, SphericalDirection(30 * kDegree, 0.5 * std::numbers::pi))[1], 0.5 * (0.2 + 0.4),
                1e-6);
    EXPECT_NEAR(f.Value(SphericalDirection(80 * kDegree, 0), SphericalDirection(70 * kDegree, 0))[1], 0.3,
                1e-6)
        << "beyond the last angle the value there is kept";
  }
}

TEST(GoniometerFileTest, GapsDisorderAndRubbishAreRefusedByTheirLine) {
  const auto refused = [](const std::string& text, std::initializer_list<std::string> words) {
    ExpectInputError([&] { Read(text); }, {"paint.csv: "});
    ExpectInputError([&] { Read(text); }, words);
  };
  const std::string small = kSmall;
  const auto without = [&](int line) {
    size_t at = 0;
    for (int i = 1; i < line; ++i) at = small.find('\n', at) + 1;
    return small.substr(0, at) + small.substr(small.find('\n', at) + 1);
  };
  refused("", {"has no row"});
  refused("# nothing\n", {"has no row"});
  refused("0 0 0\n", {"line 1: has 3 numbers", "theta_i, theta_o, dphi"});
  refused(small + "60 60 190 1\n", {"line 9: dphi is 190, expected 0 to 180"});
  refused("0 95 0 1\n", {"line 1: theta_o is 95, expected 0 to 90"});
  refused("-1 0 0 1\n", {"line 1: theta_i is -1"});
  refused("0 0 0 -0.5\n", {"line 1: f_r is -0.5, expected 0 to 1e9"});
  refused("0 0 0 nan\n", {"line 1: f_r is nan"});
  refused("0 0 0 1e300\n", {"line 1: f_r is 1e300"});
  refused("0 0 0 1\n0 0 x 1\n", {"line 2: 'x' found, expected a number"});
  refused(std::string("0 0 0 1\n0 0 \0x 1\n", 17), {"line 2: '\\u0000x' found, expected a number"});
  refused("0 0 0 1\n0 0 \x1b[31m 1\n", {"line 2: '\\u001b[31m' found, expected a number"});
  refused("0 0 0 1\n0 0 180 1 1 1\n", {"line 2: has 6 numbers, expected 4 as before"});
  refused(without(3),
          {"line 3: theta_i 0, theta_o 60, dphi 180 found, expected theta_i 0, theta_o 60, dphi 0"});
  refused(without(5),
          {"line 5: theta_i 60, theta_o 0, dphi 180 found, expected theta_i 60, theta_o 0, dphi 0"});
  refused(without(8), {"ends after line 7, expected a row for theta_i 60, theta_o 60, dphi 180"});
  refused(small + "30 0 0 1\n", {"line 9: theta_i 30, theta_o 0, dphi 0 found, expected larger angles"});
  refused("0 0 180 1\n0 0 0 1\n", {"line 2: theta_i 0, theta_o 0, dphi 0 found"});
  refused("0 0 0 1\n0 0 0 1\n", {"line 2: "});
  refused("0 0 0 1\n0 0 180 1\n", {"has one angle theta_i, expected at least 2"});
  refused(
      "0 0 0 1\n0 0 1e-12 1\n0 60 0 1\n0 60 1e-12 1\n60 0 0 1\n60 0 1e-12 1\n60 60 0 1\n60 60 1e-12 1\n"
      "0 0 0 1\n",
      {"line 9"});
  ExpectInputError([] { ReadMeasuredFile("no/such.csv"); }, {"no/such.csv: no such file"});
}

TEST(GoniometerFileTest, AnglesThatAreOneInSinglePrecisionAreRefused) {
  ExpectInputError(
      [] {
        Read(
            "0 0 10 1\n0 0 10.0000000001 1\n0 60 10 1\n0 60 10.0000000001 1\n60 0 10 1\n60 0 "
            "10.0000000001 1\n60 60 10 1\n60 60 10.0000000001 1\n");
      },
      {"two angles of about 10 degrees"});
}

}  // namespace
}  // namespace lobe
