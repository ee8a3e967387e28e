#include "sh/hemisphere_basis.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <boost/math/special_functions/spherical_harmonic.hpp>

#include "sh/quadrature.h"

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace lobe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Real Y_lm without Condon-Shortley sign, from Boost's complex one: the second opinion.
double SphericalHarmonic(int l, int m, double theta, double phi) {
  const double sign = m % 2 == 0 ? 1.0 : -1.0;  // Boost's has the Condon-Shortley sign
  if (m == 0) return boost::math::spherical_harmonic_r(l, 0, theta, phi);
  if (m > 0) return sign * std::numbers::sqrt2 * boost::math::spherical_harmonic_r(l, m, theta, phi);
  return sign * std::numbers::sqrt2 * boost::math::spherical_harmonic_i(l, -m, theta, phi);
}

Vec3d Direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

TEST(HemisphereBasisTest, LinearBandHasTheDocumentedSigns) {
  const Vec3d w = Direction(0.7, 0.4);
  double h[3];
  HemisphereBasis<double>(1).Evaluate(w.x(), w.y(), w.z(), h);
  const double y00 = 1.0 / std::sqrt(4.0 * std::numbers::pi), y11 = std::sqrt(3.0 / (4.0 * std::numbers::pi));
  EXPECT_NEAR(h[CoefficientIndex(0, 0)], std::numbers::sqrt2 * y00, 1e-15);
  EXPECT_NEAR(h[CoefficientIndex(1, 1)], std::numbers::sqrt2 * y11 * w.x(), 1e-15);
  EXPECT_NEAR(h[CoefficientIndex(1, -1)], std::numbers::sqrt2 * y11 * w.y(), 1e-15);
}

TEST(HemisphereBasisTest, IndexRunsThroughEveryEvenPairOnce) {
  int next = 0;
  for (int l = 0; l <= 20; ++l) {
    for (int m = -l; m <= l; m += 2) EXPECT_EQ(CoefficientIndex(l, m), next++);
    EXPECT_EQ(CoefficientCount(l), next);
  }
}

TEST(HemisphereBasisTest, AgreesWithBoostAtGenericDirections) {
  const HemisphereBasis<double> basis(24);
  VectorXd h(basis.size());
  for (const auto& [theta, phi] : {std::pair{0.3, 0.9}, {1.1, -2.2}, {1.5, 3.0}, {0.01, 5.0}}) {
    const Vec3d w = Direction(theta, phi);
    basis.Evaluate(w.x(), w.y(), w.z(), h.data());
    for (int l = 0; l <= 24; ++l) {
      for (int m = -l; m <= l; m += 2) {
        EXPECT_NEAR(h[CoefficientIndex(l, m)], std::numbers::sqrt2 * SphericalHarmonic(l, m, theta, phi),
                    2e-12)
            << "l " << l << " m " << m;
      }
    }
  }
}

// 1e-12: rounding of 65 x 129 terms of size up to a few tens.
TEST(HemisphereBasisTest, IsOrthonormalOnTheHemisphereUpToDegree64) {
  const HemisphereBasis<double> basis(64);
  const HemisphereQuadrature rule(64);
  MatrixXd values(basis.size(), rule.weights.size());
  for (size_t i = 0; i < rule.weights.size(); ++i) {
    const Vec3d& w = rule.directions[i];
    basis.Evaluate(w.x(), w.y(), w.z(), values.col(i).data());
    values.col(i) *= std::sqrt(rule.weights[i]);
  }
  MatrixXd gram = MatrixXd::Zero(basis.size(), basis.size());
  gram.selfadjointView<Eigen::Lower>().rankUpdate(values);
  gram.diagonal().array() -= 1.0;
  EXPECT_LT(gram.triangularView<Eigen::Lower>().toDenseMatrix().cwiseAbs().maxCoeff(), 1e-12);
}

TEST(HemisphereBasisTest, BatchesEqualSingleEvaluations) {
  const HemisphereBasis<float> basis(13);
  std::vector<float> x, y, z;
  for (int i = 0; i < 37; ++i) {
    const Vec3d w = Direction(0.04 * i + 0.01, 0.7 * i);
    x.push_back(float(w.x()));
    y.push_back(float(w.y()));
    z.push_back(float(w.z()));
  }
  std::vector<float> batch(basis.size() * x.size()), single(basis.size());
  basis.EvaluateBatch(x.data(), y.data(), z.data(), int(x.size()), batch.data());
  for (size_t i = 0; i < x.size(); ++i) {
    basis.Evaluate(x[i], y[i], z[i], single.data());
    for (int k = 0; k < basis.size(); ++k) {
      // Fused multiply-adds may fall differently.
      EXPECT_NEAR(batch[k * x.size() + i], single[k], 1e-5 * std::max(1.0f, std::abs(single[k])));
    }
  }
}

// Basis values reach about 8 at degree 64; float's rounding grows with the recurrence's length.
// docs/validation.md#basis-precision has the curve.
TEST(HemisphereBasisTest, FloatFollowsDoubleUpToDegree64) {
  const HemisphereBasis<float> single(64);
  const HemisphereBasis<double> exact(64);
  std::vector<float> a(single.size());
  VectorXd b(exact.size());
  double worst = 0;
  for (int i = 0; i <= 200; ++i) {
    const double theta = 0.5 * std::numbers::pi * i / 200.0;
    const float x = float(std::sin(theta) * 0.6), y = float(std::sin(theta) * 0.8),
                z = float(std::cos(theta));
    single.Evaluate(x, y, z, a.data());
    exact.Evaluate(x, y, z, b.data());
    for (int k = 0; k < single.size(); ++k) worst = std::max(worst, std::abs(double(a[k]) - b[k]));
  }
  EXPECT_LT(worst, 2e-4);
}

#ifdef __SSE2__
TEST(HemisphereBasisTest, SurvivesFlushToZeroInFloatAtDegree64) {
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | 0x8040);  // flush results and denormal operands
  const HemisphereBasis<float> single(64);
  std::vector<float> a(single.size());
  single.Evaluate(std::sin(0.05f), 0.0f, std::cos(0.05f), a.data());
  _mm_setcsr(before);
  const HemisphereBasis<double> exact(64);
  VectorXd b(exact.size());
  exact.Evaluate(double(std::sin(0.05f)), 0.0, double(std::cos(0.05f)), b.data());
  for (int k = 0; k < single.size(); ++k) ASSERT_NEAR(a[k], b[k], 2e-4);
}
#endif

// By the addition theorem the H_lm of one degree, which are the part of degree l even in z, have
// sum H^2 = (2l+1)/(4 pi) (1 + (-1)^l P_l(w . w')) with w' the mirror image of w in the horizon... at the
// horizon both coincide up to sign, leaving (2l+1)/(2 pi).
TEST(HemisphereBasisTest, KeepsTheAdditionTheoremAtDegree1000) {
  const HemisphereBasis<double> basis(1000);
  VectorXd h(basis.size());
  basis.Evaluate(0.6, 0.8, 0.0, h.data());
  for (const int l : {0, 1, 10, 100, 500, 999, 1000}) {
    double sum = 0;
    for (int m = -l; m <= l; m += 2) sum += h[CoefficientIndex(l, m)] * h[CoefficientIndex(l, m)];
    const double expected = (2.0 * l + 1.0) / (2.0 * std::numbers::pi);
    EXPECT_NEAR(sum / expected, 1.0, 1e-10) << "l " << l;
  }
  for (const double theta : {0.0, 1e-8, 1e-3, 0.3, 1.2}) {
    basis.Evaluate(std::sin(theta), 0.0, std::cos(theta), h.data());
    EXPECT_TRUE(h.allFinite()) << "theta " << theta;
  }
}

TEST(HemisphereBasisTest, RefusesDegreesOutOfRange) {
  EXPECT_THROW(HemisphereBasis<float>(-1), std::invalid_argument);
  EXPECT_THROW(HemisphereBasis<float>(65), std::invalid_argument);
  EXPECT_THROW(HemisphereBasis<double>(1001), std::invalid_argument);
}

}  // namespace
}  // namespace lobe
