#include "solver/form_factor.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sh/quadrature.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;
using Triangle = std::array<Vec3, 3>;

// Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-11: equal parallel squares, side 1,
// distance 1; and C-14: unit squares at a right angle with a common edge.
double ParallelUnitSquares() {
  return 2 / kPi *
         (std::log(std::sqrt(4.0 / 3.0)) + 2 * std::sqrt(2.0) * std::atan(1 / std::sqrt(2.0)) -
          2 * std::atan(1.0));
}
double PerpendicularUnitSquares() {
  return 1 / kPi *
         (2 * std::atan(1.0) - std::sqrt(2.0) * std::atan(1 / std::sqrt(2.0)) + 0.25 * std::log(3.0 / 4.0));
}

// Mean over a unit square in the plane z = 0, normal up, of the irradiance from two triangles of radiance 1.
double MeanFormFactor(const Triangle& a, const Triangle& b) {
  const GaussLegendre rule(24, 0, 1);
  double sum = 0;
  for (int i = 0; i < 24; ++i) {
    for (int j = 0; j < 24; ++j) {
      const Vec3 x(float(rule.nodes[i]), float(rule.nodes[j]), 0);
      sum +=
          rule.weights[i] * rule.weights[j] *
          (LightOfTriangle(x, Vec3::UnitZ(), a).irradiance + LightOfTriangle(x, Vec3::UnitZ(), b).irradiance);
    }
  }
  return sum / kPi;
}

TEST(FormFactorTest, ParallelSquaresHaveTheClosedForm) {
  const Vec3 p00(0, 0, 1), p10(1, 0, 1), p11(1, 1, 1), p01(0, 1, 1);
  EXPECT_NEAR(MeanFormFactor({p00, p11, p10}, {p00, p01, p11}), ParallelUnitSquares(), 1e-5);
}

// The kernel is singular along the common edge: the plain product rule here converges slowly, hence 5e-4.
TEST(FormFactorTest, PerpendicularSquaresHaveTheClosedForm) {
  const Vec3 p0(0, 0, 0), p1(0, 1, 0), p2(0, 1, 1), p3(0, 0, 1);
  EXPECT_NEAR(MeanFormFactor({p0, p1, p2}, {p0, p2, p3}), PerpendicularUnitSquares(), 5e-4);
}

TEST(FormFactorTest, ATriangleAllAroundFillsTheHemisphere) {
  // Huge and close above: irradiance pi.
  const Triangle above = {Vec3(-1e4f, -1e4f, 0.01f), Vec3(0, 1e4f, 0.01f), Vec3(1e4f, -1e4f, 0.01f)};
  EXPECT_NEAR(ExactTriangleLight(Vec3(0, 0, 0), Vec3::UnitZ(), above).irradiance, kPi, 1e-4);
}

TEST(FormFactorTest, IsClippedAtTheHorizon) {
  // Upright triangle, half above and half below: as much as its upper part alone.
  const Triangle whole = {Vec3(1, -1, -1), Vec3(1, -1, 1), Vec3(1, 1, 1)};
  const Triangle upper_a = {Vec3(1, -1, 0), Vec3(1, -1, 1), Vec3(1, 1, 1)};
  const Triangle upper_b = {Vec3(1, -1, 0), Vec3(1, 1, 1), Vec3(1, 0, 0)};
  const auto at = [](const Triangle& t) {
    return ExactTriangleLight(Vec3::Zero(), Vec3::UnitZ(), t).irradiance;
  };
  EXPECT_GT(at(whole), 0);
  EXPECT_NEAR(at(whole), at(upper_a) + at(upper_b), 1e-6);
}

TEST(FormFactorTest, ABackFaceGivesNothing) {
  const Triangle away = {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0, 1, 1)};
  EXPECT_EQ(ExactTriangleLight(Vec3::Zero(), Vec3::UnitZ(), away).irradiance, 0);
  EXPECT_EQ(FarTriangleLight(Vec3::Zero(), Vec3::UnitZ(), away).irradiance, 0);
}

// Error of the point form falls as the square of size over distance.
TEST(FormFactorTest, FarFormConvergesQuadratically) {
  double before = 0;
  for (const float distance : {6.0f, 12.0f, 24.0f}) {
    const Triangle t = {Vec3(1.5f, 0, distance), Vec3(1, 1, distance), Vec3(2, 0.7f, distance)};
    const double exact = ExactTriangleLight(Vec3::Zero(), Vec3(0.1f, 0.2f, 0.97f).normalized(), t).irradiance;
    const double far = FarTriangleLight(Vec3::Zero(), Vec3(0.1f, 0.2f, 0.97f).normalized(), t).irradiance;
    const double error = std::abs(far / exact - 1);
    if (before > 0) {
      EXPECT_LT(error, before / 3);
    }
    before = error;
  }
  EXPECT_LT(before, 4e-4);
}

TEST(FormFactorTest, DegenerateTrianglesGiveNothing) {
  const Vec3 p(0, 0, 1);
  EXPECT_EQ(LightOfTriangle(Vec3::Zero(), Vec3::UnitZ(), {p, p, p}).irradiance, 0);
  EXPECT_EQ(LightOfTriangle(p, Vec3::UnitZ(), {p, p, p}).irradiance, 0);
}

}  // namespace
}  // namespace lobe
