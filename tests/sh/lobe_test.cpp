#include "sh/lobe.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sh/quadrature.h"
#include "sh/zernike.h"

namespace lobe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A lobe about a tilted axis; negative nowhere, smooth, of degree 10 in direction.
double Lobe(const Vec3d& w) {
  const Vec3d axis = Vec3d(0.5, -0.2, 0.8).normalized();
  return std::pow(0.5 * (1.0 + w.dot(axis)), 10);
}

double FluxByQuadrature(const VectorXd& c, int degree) {
  const HemisphereBasis<double> basis(DegreeOf(int(c.size())));
  const HemisphereQuadrature rule(degree);
  VectorXd h(basis.size());
  double flux = 0;
  for (size_t i = 0; i < rule.weights.size(); ++i) {
    const Vec3d& w = rule.directions[i];
    basis.Evaluate(w.x(), w.y(), w.z(), h.data());
    flux += rule.weights[i] * w.z() * h.dot(c);
  }
  return flux;
}

TEST(ZernikeTest, RadialsAreOrthonormalOverTheDisc) {
  const GaussLegendre rule(48, 0.0, 1.0);
  for (const int m : {0, 1, 4, 9}) {
    const int n_max = 30, size = (n_max - m) / 2 + 1;
    MatrixXd gram = MatrixXd::Zero(size, size);
    VectorXd r(size);
    for (size_t i = 0; i < rule.nodes.size(); ++i) {
      ZernikeRadial(m, n_max, rule.nodes[i], r.data());
      gram += rule.weights[i] * rule.nodes[i] * (m == 0 ? 2.0 : 1.0) * std::numbers::pi * r * r.transpose();
    }
    EXPECT_LT((gram - MatrixXd::Identity(size, size)).cwiseAbs().maxCoeff(), 1e-12) << "m " << m;
  }
}

TEST(ZernikeTest, TransformsAreEachOthersInverse) {
  for (const int l_max : {0, 1, 7, 32}) {
    const ZernikeTransform t(l_max);
    const MatrixXd h = MatrixXd::Random(CoefficientCount(l_max), 2);
    EXPECT_LT((t.ToHemisphere(t.ToZernike(h)) - h).cwiseAbs().maxCoeff(), 1e-12) << "l_max " << l_max;
  }
}

TEST(ProjectionTest, ReproducesWhatTheBasisHolds) {
  const int l_max = 9;
  const VectorXd c = VectorXd::Random(CoefficientCount(l_max));
  const HemisphereBasis<double> basis(l_max);
  VectorXd h(basis.size());
  const auto f = [&](const Vec3d& w) {
    basis.Evaluate(w.x(), w.y(), w.z(), h.data());
    return h.dot(c);
  };
  EXPECT_LT((ProjectCosineWeighted(f, l_max, l_max) - c).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ProjectionTest, KeepsTheFluxAtEveryDegree) {
  const double flux = FluxByQuadrature(ProjectCosineWeighted(Lobe, 20, 40), 40);
  for (int l_max = 0; l_max <= 20; ++l_max) {
    const VectorXd c = ProjectCosineWeighted(Lobe, l_max, 40);
    EXPECT_NEAR(FluxByQuadrature(c, 40), flux, 1e-10) << "l_max " << l_max;
    EXPECT_NEAR(LobeFlux(c)(0), flux, 1e-10);
  }
}

// Normal equations: what is left over is orthogonal to the basis under the cosine.
TEST(ProjectionTest, IsTheLeastSquaresFitUnderTheCosine) {
  const int l_max = 6;
  const VectorXd c = ProjectCosineWeighted(Lobe, l_max, 40);
  const HemisphereBasis<double> basis(l_max);
  const HemisphereQuadrature rule(40);
  VectorXd h(basis.size()), left = VectorXd::Zero(basis.size());
  for (size_t i = 0; i < rule.weights.size(); ++i) {
    const Vec3d& w = rule.directions[i];
    basis.Evaluate(w.x(), w.y(), w.z(), h.data());
    left += rule.weights[i] * w.z() * (Lobe(w) - h.dot(c)) * h;
  }
  EXPECT_LT(left.cwiseAbs().maxCoeff(), 1e-9);  // Lobe is not a polynomial in (x, y): the rule's own error
}

TEST(DegreeChangeTest, KeepsTheFlux) {
  const MatrixXd c = MatrixXd::Random(CoefficientCount(24), 3);
  for (const int l_max : {0, 1, 2, 3, 8, 23, 24, 30}) {
    const MatrixXd changed = ChangeDegree(c, l_max);
    ASSERT_EQ(changed.rows(), CoefficientCount(l_max));
    EXPECT_LT((LobeFlux(changed) - LobeFlux(c)).cwiseAbs().maxCoeff(), 1e-12) << "l_max " << l_max;
  }
}

TEST(DegreeChangeTest, EqualsProjectingToTheLowerDegree) {
  const VectorXd high = ProjectCosineWeighted(Lobe, 16, 40);
  for (const int l_max : {0, 3, 8}) {
    EXPECT_LT((ChangeDegree(high, l_max) - ProjectCosineWeighted(Lobe, l_max, 40)).cwiseAbs().maxCoeff(),
              1e-10);
  }
}

// Why ChangeDegree exists: dropping coefficients of H changes the flux by half and more.
TEST(DegreeChangeTest, DroppingCoefficientsWouldNotKeepTheFlux) {
  const VectorXd high = ProjectCosineWeighted(Lobe, 16, 40);
  const double flux = LobeFlux(high)(0);
  EXPECT_GT(std::abs(LobeFlux(high.head(1))(0) / flux - 1.0), 0.05);
}

TEST(LobeTest, ConstantRadianceHasFluxPi) {
  VectorXd c = VectorXd::Zero(CoefficientCount(5));
  c[0] = std::sqrt(2.0 * std::numbers::pi);  // radiance 1
  EXPECT_NEAR(LobeFlux(c)(0), std::numbers::pi, 1e-13);
}

TEST(LobeTest, DegreeOfKnowsCountsAndRefusesOthers) {
  EXPECT_EQ(DegreeOf(1), 0);
  EXPECT_EQ(DegreeOf(91), 12);
  EXPECT_THROW(DegreeOf(0), std::invalid_argument);
  EXPECT_THROW(DegreeOf(90), std::invalid_argument);
}

}  // namespace
}  // namespace lobe
