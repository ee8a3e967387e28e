#include "sh/quadrature.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace lobe {
namespace {

TEST(GaussLegendreTest, IntegratesPolynomialsOfDegree2nMinus1Exactly) {
  for (const int n : {1, 2, 5, 16, 65}) {
    const GaussLegendre rule(n, -0.5, 2.0);
    const int degree = 2 * n - 1;
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += rule.weights[i] * std::pow(rule.nodes[i], degree);
    const double exact = (std::pow(2.0, degree + 1) - std::pow(-0.5, degree + 1)) / (degree + 1);
    EXPECT_NEAR(sum / exact, 1.0, 1e-12) << n << " points";
  }
}

TEST(GaussLegendreTest, HasPositiveWeightsAndOrderedNodesAtTenThousandPoints) {
  const GaussLegendre rule(10000, 0.0, 1.0);
  double sum = 0;
  for (size_t i = 0; i < rule.nodes.size(); ++i) {
    ASSERT_GT(rule.weights[i], 0);
    if (i > 0) {
      ASSERT_GT(rule.nodes[i], rule.nodes[i - 1]);
    }
    sum += rule.weights[i];
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(HemisphereQuadratureTest, KnowsSolidAngleProjectedAreaAndSecondMoments) {
  const HemisphereQuadrature rule(3);
  double area = 0, projected = 0, xx = 0, xy = 0;
  for (size_t i = 0; i < rule.weights.size(); ++i) {
    const Vec3d& w = rule.directions[i];
    EXPECT_NEAR(w.norm(), 1.0, 1e-15);
    area += rule.weights[i];
    projected += rule.weights[i] * w.z();
    xx += rule.weights[i] * w.x() * w.x();
    xy += rule.weights[i] * w.x() * w.y();
  }
  EXPECT_NEAR(area, 2 * std::numbers::pi, 1e-13);
  EXPECT_NEAR(projected, std::numbers::pi, 1e-13);
  EXPECT_NEAR(xx, 2 * std::numbers::pi / 3, 1e-13);
  EXPECT_NEAR(xy, 0.0, 1e-14);
}

}  // namespace
}  // namespace lobe
