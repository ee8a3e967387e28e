#include "brdf/knot_choice.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "brdf/incident_moments.h"
#include "sh/hemisphere_basis.h"
#include "sh/zernike.h"

namespace lobe {
namespace {

ScalarBrdf Ggx(double roughness) {
  const double a = roughness * roughness;
  return [a](const Vec3d& wi, const Vec3d& wo) {
    const Vec3d h = (wi + wo).normalized();
    return GgxD(h.z(), a) * GgxV(wi.z(), wo.z(), a);
  };
}

HalfVectorRule GgxRule(double roughness) { return {.width = roughness * roughness}; }

MetallicRoughness Mirrorlike(float roughness) {  // F = 1
  MetallicRoughness m;
  m.roughness = roughness;
  return m;
}

/// Errors of what IncidentMoments makes of a material's gloss, against exact projections of `f` at many
/// angles that the material has never seen.
LobeError MeasureFromOutside(const MaterialLobes& material, const ScalarTable& truth) {
  const int degree = material.gloss.l_max;
  const ZernikeTransform transform(degree);
  const IncidenceSpline angles(truth.knots);
  LobeError out;
  double weights = 0;
  for (int j = 0; j < truth.knots; ++j) {
    const double cosine = angles.KnotCosine(j);
    IncidentMoments moments;
    moments.Start(material);
    moments.Add(Vec3(float(std::sqrt(1 - cosine * cosine)), 0, float(cosine)), Rgb::Constant(1));
    Eigen::MatrixXf lobe = Eigen::MatrixXf::Zero(material.gloss.count(), 3);
    moments.Finish(nullptr, lobe.data());
    const Eigen::VectorXd z = transform.ToZernike(lobe.leftCols(1).cast<double>());
    double between2 = 0, kept2 = 0;
    for (int n = 0; n <= degree; ++n) {
      for (int m = n % 2; m <= n; m += 2) {
        const double exact = truth.zernike(ScalarTable::RowIndex(n, m), j);
        between2 += std::pow(z[CoefficientIndex(n, m)] - exact, 2);
        kept2 += exact * exact;
      }
    }
    const double w = truth.FluxWeight(j), lost2 = std::max(0.0, truth.norm2[j] - kept2);
    out.truncated += w * std::sqrt(lost2 / truth.norm2[j]);
    out.between += w * std::sqrt(between2 / truth.norm2[j]);
    out.total += w * std::sqrt((lost2 + between2) / truth.norm2[j]);
    weights += w;
  }
  out.truncated /= weights;
  out.between /= weights;
  out.total /= weights;
  return out;
}

// What is said of a material is measured on some thirty angles; here on a hundred others. A table of
// l_max + 9 angles has its own splines between them, and knots that fall upon its angles hide a part:
// a quarter of what is lost between knots, at most, is not seen (docs/validation.md#knots).
TEST(KnotChoiceTest, StatedErrorsAreThoseAtAnglesNeverSeen) {
  TableCache cache;
  for (const float roughness : {1.0f, 0.5f, 0.4f, 0.2f}) {
    for (const int l_max : {6, 12, 20}) {
      LobeOptions options;
      options.force_l_max = l_max;
      const MaterialLobes material(Mirrorlike(roughness), options, cache);
      const auto truth = ScalarTable::Build(Ggx(roughness), l_max, GgxRule(roughness), 98);
      const LobeError stated = material.gloss.error, real = MeasureFromOutside(material, truth);
      const std::string where = "roughness " + std::to_string(roughness) + ", l_max " + std::to_string(l_max);
      EXPECT_NEAR(stated.truncated, real.truncated, 0.02 * real.truncated) << where;
      EXPECT_NEAR(stated.total, real.total, 0.02 * real.total) << where;
      EXPECT_LT(real.between, 1.4 * stated.between) << where;
      EXPECT_GT(real.between, 0.5 * stated.between) << where;
      EXPECT_LT(real.between, 0.0125) << where;  // a tenth of the tolerance, and that quarter
    }
  }
}

TEST(KnotChoiceTest, OneKnotFewerMissesTheTolerance) {
  for (const double roughness : {1.0, 0.5, 0.3}) {
    const auto table = ScalarTable::Build(Ggx(roughness), 16, GgxRule(roughness));
    const KnotChoice choice(table.knots);
    for (const double tolerance : {0.02, 0.005, 0.001}) {
      const int knots = choice.Fewest(table, 12, tolerance);
      if (knots == table.knots) {
        EXPECT_GT(choice.Measure(table, 12, choice.MostMeasured()).between, tolerance);
        continue;
      }
      EXPECT_LE(choice.Measure(table, 12, knots).between, tolerance);
      if (knots > 5) {
        EXPECT_GT(choice.Measure(table, 12, knots - 1).between, tolerance);
      }
    }
  }
}

TEST(KnotChoiceTest, LooserTolerancesTakeFewerKnots) {
  TableCache cache;
  int last = 1000;
  for (const double tolerance : {0.01, 0.05, 0.2, 1.0}) {
    const MaterialLobes m(Mirrorlike(0.4f), LobeOptions{.l_max = 32, .error = tolerance}, cache);
    EXPECT_LT(m.spline().knots(), last) << tolerance;
    EXPECT_LE(m.gloss.error.total, std::max(tolerance, 0.035)) << "l_max 32 leaves 3.4 %";
    last = m.spline().knots();
  }
}

// A spline reproduces what it was given, at the knots and as the run-time stencil reads it.
TEST(IncidenceSplineTest, InterpolationIsWhatTheStencilReads) {
  const IncidenceSpline spline(11);
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(23, 0.02, 1.0);
  for (const bool odd : {false, true}) {
    Eigen::VectorXd values(11);
    for (int j = 0; j < 11; ++j) values[j] = odd ? std::sin(0.3 * j) : std::cos(0.3 * j);
    const Eigen::VectorXd read = spline.Interpolation(t, odd) * values;
    const Eigen::MatrixXd control = spline.ControlValues(values, odd);
    for (int i = 0; i < t.size(); ++i) {
      const auto s = spline.At(float(IncidenceSpline::CosineOfParameter(t[i])));
      double sum = 0;
      for (int k = 0; k < 4; ++k) {
        sum += (k == 0 && s.mirrored && odd ? -1 : 1) * double(s.weight[k]) * control(s.bin[k], 0);
      }
      EXPECT_NEAR(read[i], sum, 2e-5) << "t " << t[i];  // float loses digits of t near 0
    }
    EXPECT_LT((spline.Interpolation(spline.KnotParameters(), odd) * values - values).cwiseAbs().maxCoeff(),
              1e-12);
  }
}

}  // namespace
}  // namespace lobe
