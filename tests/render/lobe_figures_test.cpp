#include "render/lobe_figures.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sh/zernike.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;

/// The same lobe in three channels, scaled by `colour`.
Eigen::MatrixXd Coloured(const Eigen::VectorXd& lobe, const Eigen::RowVector3d& colour) {
  return lobe * colour;
}

/// Linear functions of the direction are in the basis of degree 1 and more, exactly.
Eigen::VectorXd Linear(double constant, double x, double y, int l_max) {
  return ProjectCosineWeighted([=](const Vec3d& w) { return constant + x * w.x() + y * w.y(); }, l_max,
                               l_max);
}

TEST(LobeReaderTest, ReadsALinearFunctionExactly) {
  const LobeReader lobe(Coloured(Linear(1, 0.5, -0.25, 4), {1, 2, 3}));
  const Vec3d w = Vec3d(0.3, -0.5, 0.7).normalized();
  const double expected = 1 + 0.5 * w.x() - 0.25 * w.y();
  const Eigen::Array3d radiance = lobe.Radiance(w);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(radiance[c], (c + 1) * expected, 1e-12);
  EXPECT_NEAR(lobe.Luminance(w), expected * (0.2126 + 2 * 0.7152 + 3 * 0.0722), 1e-12);
  EXPECT_EQ(lobe.l_max(), 4);
}

TEST(LobeReaderTest, RefusesWhatIsNoLobe) {
  EXPECT_THROW(LobeReader(Eigen::MatrixXd::Zero(5, 3)), std::invalid_argument);
  EXPECT_THROW(LobeReader(Eigen::MatrixXd::Zero(6, 2)), std::invalid_argument);
}

TEST(LobeFiguresTest, ConstantLobeHasFluxPiAndItsPeakAtThePole) {
  for (const int l_max : {0, 6}) {
    const LobeFigures f = MeasureLobe(Coloured(Linear(1, 0, 0, l_max), {1, 0.5, 0.25}));
    EXPECT_NEAR(f.flux[0], kPi, 1e-5);
    EXPECT_NEAR(f.flux[2], kPi / 4, 1e-5);
    EXPECT_NEAR(f.peak_radiance[1], 0.5, 1e-6);
    EXPECT_EQ(f.negative_fraction, 0);
    EXPECT_NEAR(f.peak_theta_degrees(), 0, 1e-3) << "rounding does not choose the peak";
    EXPECT_EQ(f.peak_phi_degrees(), 0);
  }
}

// L = x: half of the magnitude is negative, the greatest value 1 lies on the horizon at phi = 0.
TEST(LobeFiguresTest, OddLobeIsHalfNegative) {
  const LobeFigures f = MeasureLobe(Coloured(Linear(0, 1, 0, 3), {1, 1, 1}));
  EXPECT_NEAR(f.negative_fraction, 0.5, 1e-9);
  EXPECT_NEAR(f.flux[0], 0, 1e-6);
  EXPECT_NEAR(f.peak, 1, 1e-9);
  EXPECT_LT((f.peak_direction - Vec3d(1, 0, 0)).norm(), 1e-4);
}

// L = 1 + 2 x: negative where x < -1/2. With x = sin(theta) cos(phi) uniform in its own coordinate over
// the sphere (Archimedes), and even in z, x is uniform on [-1, 1] over the hemisphere:
// negative part 1/2 int_{-1}^{-1/2} -(1 + 2x) dx = 1/8, whole 1/2 int (1 + 2x) dx = 1, magnitude 1 + 2/8.
TEST(LobeFiguresTest, NegativeFractionIsOfTheWholeMagnitude) {
  const LobeFigures f = MeasureLobe(Coloured(Linear(1, 2, 0, 5), {1, 1, 1}));
  EXPECT_NEAR(f.negative_fraction, 0.125 / 1.25, 1e-3);
}

// A parabola over the disc: the peak lies between grid points, at (0.35, -0.48), and is 1 high.
TEST(LobeFiguresTest, PeakIsFoundBetweenGridPoints) {
  const Eigen::Vector2d top(0.35, -0.48);
  const Eigen::VectorXd lobe =
      ProjectCosineWeighted([&](const Vec3d& w) { return 1 - (w.head<2>() - top).squaredNorm(); }, 4, 4);
  const LobeFigures f = MeasureLobe(Coloured(lobe, {1, 1, 1}));
  EXPECT_NEAR(f.peak, 1, 1e-9);
  EXPECT_LT((f.peak_direction.head<2>() - top).norm(), 1e-4);
  EXPECT_NEAR(f.peak_theta_degrees(), std::asin(top.norm()) * 180 / kPi, 0.01);
  EXPECT_NEAR(f.peak_phi_degrees(), 360 + std::atan2(top.y(), top.x()) * 180 / kPi, 0.01);
}

TEST(LobeFiguresTest, BlackLobeHasNoFigures) {
  const LobeFigures f = MeasureLobe(Eigen::MatrixXd::Zero(6, 3));
  EXPECT_EQ(f.peak, 0);
  EXPECT_EQ(f.negative_fraction, 0);
  EXPECT_TRUE((f.flux == 0).all());
}

}  // namespace
}  // namespace lobe
