#include "brdf/lobe_accuracy.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "sh/hemisphere_basis.h"
#include "sh/lobe.h"
#include "tests/support/slow_albedo.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;

MetallicRoughness Ggx(float roughness) {  // F = 1
  MetallicRoughness m;
  m.roughness = roughness;
  return m;
}

LobeAccuracy Forced(const Reflectance& r, BrdfPart part, int l_max) {
  TableCache cache;
  return AccuracyMeter(r, part).Measure(MaterialLobes(r, LobeOptions{.force_l_max = l_max}, cache));
}

// DESIGN 3, from outside: the lobes as solver and renderer read them, knots, float and all.
TEST(LobeAccuracyTest, GgxIsWithinTheErrorsOfTheDesign) {
  EXPECT_LE(Forced(Ggx(1.0f), BrdfPart::kGloss, 16).error.total, 0.0125);  // 1.2 %, as printed
  EXPECT_LE(Forced(Ggx(0.7f), BrdfPart::kGloss, 16).error.total, 0.012);
  EXPECT_LE(Forced(Ggx(0.5f), BrdfPart::kGloss, 24).error.total, 0.025);
}

TEST(LobeAccuracyTest, WhatAMaterialSaysOfItselfIsWhatIsMeasured) {
  TableCache cache;
  for (const Reflectance& r : {Reflectance(Ggx(0.4f)), Reflectance(Phong{Rgb::Constant(0.8f), 20}),
                               Reflectance(Ward{Rgb::Constant(0.5f), 0.2f}),
                               Reflectance(Plastic(Rgb::Constant(0.5f), 1.5f, 0.5f))}) {
    const MaterialLobes lobes(r, LobeOptions{}, cache);
    const LobeAccuracy measured = AccuracyMeter(r, BrdfPart::kGloss).Measure(lobes);
    const LobeError& said = lobes.gloss.error;
    EXPECT_NEAR(measured.error.total, said.total, 0.02 * said.total) << Describe(r);
    EXPECT_NEAR(measured.error.truncated, said.truncated, 0.02 * said.truncated) << Describe(r);
    // Between knots both are of few angles.
    EXPECT_NEAR(measured.error.between, said.between, 0.3 * said.between) << Describe(r);
    EXPECT_NEAR(measured.negative, NegativePart(lobes, BrdfPart::kGloss), 0.1 * measured.negative)
        << Describe(r);
  }
}

// The base has a degree of its own, higher than the gloss's here.
TEST(LobeAccuracyTest, AGlossIsJudgedAtItsOwnDegree) {
  const Plastic r(Rgb::Constant(0.5f), 1.5f, 0.4f);
  TableCache cache;
  const MaterialLobes lobes(r, LobeOptions{.force_l_max = 4}, cache);
  ASSERT_GT(lobes.base.l_max, 4);
  const LobeAccuracy a = AccuracyMeter(r, BrdfPart::kGloss).Measure(lobes);
  EXPECT_NEAR(a.error.truncated, lobes.gloss.error.truncated, 0.02 * a.error.truncated);
  EXPECT_LT(a.error.between, 0.0125);
}

TEST(LobeAccuracyTest, AlbedosAreThoseOfTheBrdfAtEveryDegree) {
  for (const int l_max : {0, 5, 12}) {
    EXPECT_LT(Forced(Ggx(0.3f), BrdfPart::kGloss, l_max).albedo_error, 1e-4) << l_max;
    EXPECT_LT(Forced(Plastic(Rgb::Constant(0.7f), 1.5f, 0.4f), BrdfPart::kWhole, l_max).albedo_error, 1e-4);
  }
}

// Base and gloss have points of their own; their sum must be as if it had been integrated at once.
TEST(LobeAccuracyTest, TheWholeIsBaseAndGlossTogether) {
  const Plastic r(Rgb::Constant(0.7f), 1.5f, 0.6f);
  for (const double cosine : {0.95, 0.5, 0.2}) {
    const ExactLobe whole = ProjectExactly(r, BrdfPart::kWhole, cosine, 4);
    const auto value = [&](const Vec3d& wi, const Vec3d& wo) {
      return double(EvaluateBase(r, wi, wo)[0] + EvaluateGloss(r, wi, wo)[0]);
    };
    EXPECT_NEAR(whole.albedo, test::SlowAlbedo(value, cosine, 0.36, 400, 200), 1e-5);
    const auto square = [&](const Vec3d& wi, const Vec3d& wo) { return value(wi, wo) * value(wi, wo); };
    EXPECT_NEAR(whole.norm2, test::SlowAlbedo(square, cosine, 0.36, 400, 200), 2e-5 * whole.norm2);
    EXPECT_NEAR(whole.zernike[0], whole.albedo / std::sqrt(kPi), 1e-12);
  }
}

// H_11 = sqrt(3 / 2 pi) x: over the half disc x < 0 the integral of -x is 2/3.
TEST(LobeAccuracyTest, NegativeFluxOfALinearLobeIsKnown) {
  Eigen::VectorXd lobe = Eigen::VectorXd::Zero(CoefficientCount(1));
  lobe[CoefficientIndex(1, 1)] = 1;
  EXPECT_NEAR(NegativeFlux(lobe), std::sqrt(1.5 / kPi) * 2 / 3, 2e-3);
  lobe.setZero();
  lobe[0] = 1;
  EXPECT_EQ(NegativeFlux(lobe), 0);
}

TEST(LobeAccuracyTest, LambertIsExact) {
  const LobeAccuracy a = Forced(Lambert{Rgb::Constant(0.6f)}, BrdfPart::kBase, 8);
  EXPECT_LT(a.error.total, 1e-6);
  EXPECT_LT(a.albedo_error, 1e-6);
  EXPECT_EQ(a.negative, 0);
}

}  // namespace
}  // namespace lobe
