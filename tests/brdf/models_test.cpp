// The laws that every reflectance model keeps, over one list of models, and the closed forms of each.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "brdf/lobe_recipe.h"
#include "brdf/material_lobes.h"
#include "tests/support/adaptive_albedo.h"
#include "tests/support/brdf_models.h"
#include "tests/support/slow_albedo.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;
const Vec3d kNormal(0, 0, 1);
const Rgb kColour = test::kModelColour;
using test::ModelCase;

// gtest prints a parameter's bytes otherwise.
struct Named {
  ModelCase model;
  friend std::ostream& operator<<(std::ostream& out, const Named& n) { return out << Describe(n.model.r); }
};

std::vector<Named> Cases() {
  std::vector<Named> out;
  for (const ModelCase& m : test::ModelsBeyondGltf()) out.push_back({m});
  return out;
}

class EveryModelTest : public testing::TestWithParam<Named> {
 protected:
  const Reflectance& r() const { return GetParam().model.r; }
};
INSTANTIATE_TEST_SUITE_P(Models, EveryModelTest, testing::ValuesIn(Cases()));

TEST_P(EveryModelTest, IsReciprocalIsotropicPositiveAndReflectsNoMoreThanItPromises) {
  ExpectBrdfLaws(r(), GetParam().model.albedo_bound);
}

// Also where brute force in the outgoing hemisphere sees nothing: sharp lobes near grazing. The figures
// recorded are docs/validation.md#models.
TEST_P(EveryModelTest, AlbedoOfItsLobesNeverExceedsWhatItPromises) {
  TableCache cache;
  const MaterialLobes lobes(r(), LobeOptions{}, cache);
  float least = 1e9f, most = 0;
  for (float cosine = 0; cosine <= 1; cosine += 0.01f) {
    const Rgb albedo = lobes.Albedo(cosine);
    EXPECT_LE(albedo.maxCoeff(), GetParam().model.albedo_bound + 2e-4) << "cos " << cosine;
    EXPECT_GE(albedo.minCoeff(), 0) << "cos " << cosine;
    least = std::min(least, albedo.minCoeff());
    most = std::max(most, albedo.maxCoeff());
  }
  const auto part = [&](const std::string& name, const PartLobes& lobe) {
    RecordProperty(name, std::to_string(lobe.l_max) + ", " + std::to_string(100 * lobe.error.total) + " %");
  };
  part("base", lobes.base);
  part("gloss", lobes.gloss);
  RecordProperty("albedo", std::to_string(least) + " to " + std::to_string(most));
}

// Smooth models to the error of single precision; those with kinks to that of the rule made for them, and
// data, linear between points and so with a kink at each, to that and the slow midpoint rule's.
TEST_P(EveryModelTest, FluxOfItsLobeTablesIsTheIntegralOfTheClosedForm) {
  TableCache cache;
  const MaterialLobes lobes(r(), LobeOptions{.l_max = 4}, cache);
  const ModelCase& model = GetParam().model;
  const auto gloss_value = [&](const Vec3d& a, const Vec3d& b) {
    return double(EvaluateGloss(r(), a, b)[1]);
  };
  const auto base_value = [&](const Vec3d& a, const Vec3d& b) { return double(EvaluateBase(r(), a, b)[1]); };
  for (const double cosine : {1.0, 0.83, 0.4, 0.12}) {
    const double gloss = std::holds_alternative<Measured>(r())
                             ? test::SlowAlbedo(gloss_value, cosine, model.width, 600, 200)
                             : test::AdaptiveAlbedo(gloss_value, cosine, model.width);
    const double base = test::AdaptiveAlbedo(base_value, cosine, 1);
    // Between fine angles the albedo is linear: 2e-5 of it.
    EXPECT_NEAR(lobes.gloss.Albedo(float(cosine))[1], gloss, model.flux_error + 2e-5)
        << "gloss at cos " << cosine;
    EXPECT_NEAR(lobes.base.Albedo(float(cosine))[1], base, model.flux_error + 2e-5)
        << "base at cos " << cosine;
  }
}

TEST_P(EveryModelTest, ProjectionErrorFallsWithEveryDegree) {
  for (const auto& recipe : {GlossRecipe(r()), BaseRecipe(r())}) {
    if (!recipe) continue;
    const auto tables = recipe->channels ? ScalarTable::BuildChannels(recipe->channels, 16, recipe->rule, 20)
                                         : std::vector{ScalarTable::Build(recipe->f, 16, recipe->rule, 20)};
    for (const ScalarTable& table : tables) {
      for (int l = 1; l <= 16; ++l) EXPECT_LE(table.Error(l), table.Error(l - 1)) << recipe->key;
    }
  }
}

TEST_P(EveryModelTest, SaysItsColourAtNormalIncidence) {
  const Rgb albedo = NormalAlbedo(r());
  EXPECT_TRUE((albedo >= 0).all() && (albedo <= 1).all()) << albedo.transpose();
}

// ---- Projection

// At normal incidence a lobe exp(-theta_h^2 / alpha^2) is exp(-theta_o^2 / 4 alpha^2) in the outgoing angle,
// and its coefficients fall as exp(-(n + 1)^2 alpha^2). There m is 0 and n even, so a cut after degree l
// leaves out n = l + 2, l + 4 ..., which by the midpoint rule is exp(-(l + 2)^2 alpha^2) of it, up to the
// curvature of the sphere and the models' own corrections, of relative order alpha^2 l.
TEST(ProjectionRateTest, GaussianLobesConvergeAsGaussiansDo) {
  const struct {
    Reflectance r;
    double alpha;
  } models[] = {{CookTorrance{Rgb::Constant(1), 0.15f}, 0.15},
                {CookTorrance{Rgb::Constant(1), 0.1f}, 0.1},
                {BlinnPhong{Rgb::Constant(1), 100}, std::sqrt(2.0 / 100)},
                {AshikhminShirley{Rgb::Zero(), Rgb::Constant(1), 200}, std::sqrt(2.0 / 200)},
                {Ward{Rgb::Constant(1), 0.15f}, 0.15}};
  for (const auto& [r, alpha] : models) {
    const LobeRecipe recipe = *GlossRecipe(r);
    const auto table = ScalarTable::Build(recipe.f, 24, recipe.rule, 8);
    for (const int l : {4, 6, 8, 10, 12}) {
      const double lost2 = table.norm2[0] - table.zernike.col(0).head(ScalarTable::RowCount(l)).squaredNorm();
      const double exponent = -std::log(std::sqrt(lost2 / table.norm2[0]));
      const double expected = (l + 2) * (l + 2) * alpha * alpha;
      if (expected > 3) continue;  // the tail's own shape shows
      EXPECT_NEAR(exponent, expected, 0.12 * expected) << Describe(r) << " l_max " << l;
    }
  }
}

// ---- Blinn-Phong

TEST(BlinnPhongTest, ReflectsItsAlbedoAtNormalIncidence) {
  for (const float n : {0.0f, 1.0f, 7.5f, 60.0f}) {
    const auto albedo = SlowAlbedo(
        [n](const Vec3d& wi, const Vec3d& wo) {
          return EvaluateBrdf(BlinnPhong{kColour, n}, wi, wo);
        },
        0.0);
    EXPECT_LT((albedo - kColour.cast<double>()).abs().maxCoeff(), 1e-6) << n;
  }
}

TEST(BlinnPhongTest, IsACosinePowerOfTheHalfAngleAndLambertAtExponentZero) {
  const Vec3d wi = SphericalDirection(0.2, 0.4), wo = SphericalDirection(0.8, 0.4);  // half vector at 0.5
  const double ratio = EvaluateGloss(BlinnPhong{kColour, 13}, wi, wo)[1] /
                       EvaluateGloss(BlinnPhong{kColour, 13}, kNormal, kNormal)[1];
  EXPECT_NEAR(ratio, std::pow(std::cos(0.5), 13), 1e-6);
  EXPECT_FLOAT_EQ(EvaluateGloss(BlinnPhong{kColour, 0}, wi, wo)[1], float(0.5 / kPi));
}

// ---- Cook-Torrance

TEST(CookTorranceTest, DistributionIsNormalised) {
  for (const double alpha : {0.05, 0.3, 1.0}) {
    const GaussLegendre rule(2000, 0, kPi / 2);
    double sum = 0;
    for (int i = 0; i < 2000; ++i) {
      const double t = rule.nodes[i];
      HalfAngles<double> h(kNormal, kNormal);
      h.tan2 = std::tan(t) * std::tan(t);
      sum += 2 * kPi * rule.weights[i] * CookTorrance::BeckmannD(h, alpha) * std::cos(t) * std::sin(t);
    }
    EXPECT_NEAR(sum, 1.0, 1e-9) << alpha;
  }
}

TEST(CookTorranceTest, MatchesThePapersEquationsInAngles) {
  // Out of the plane of incidence, once with G = 1 and once with masked grooves.
  for (const auto& [ti, to] : {std::pair{0.3, 0.5}, {1.4, 1.3}}) {
    const Vec3d wi = SphericalDirection(ti, 0.4), wo = SphericalDirection(to, 2.6);
    const Vec3d h = (wi + wo).normalized();
    const double alpha = 0.4f, tan_h = std::tan(std::acos(h.z())), vh = wo.dot(h);
    const double d = std::exp(-std::pow(tan_h / alpha, 2)) / (kPi * alpha * alpha * std::pow(h.z(), 4));
    const double g = std::min({1.0, 2 * h.z() * wo.z() / vh, 2 * h.z() * wi.z() / vh});
    EXPECT_EQ(g<1, ti> 1);
    const double f = 0.5 + 0.5 * std::pow(1 - vh, 5);
    const double expected = f * d * g / (4 * wi.z() * wo.z());
    EXPECT_NEAR(EvaluateGloss(CookTorrance{Rgb::Constant(0.5f), 0.4f}, wi, wo)[0], expected, 2e-6 * expected);
  }
}

TEST(CookTorranceTest, SharpGroovesReflectAllThatTheirFacetsDo) {
  const Reflectance r = CookTorrance{Rgb::Constant(1), 0.03f};
  const double albedo = test::AdaptiveAlbedo(
      [&](const Vec3d& a, const Vec3d& b) { return double(EvaluateGloss(r, a, b)[0]); }, std::cos(0.5), 0.03);
  EXPECT_NEAR(albedo, 1, 1e-3);
}

// ---- Oren-Nayar

double OrenNayarAlbedo(double sigma, double t) {
  return OrenNayar::WhiteAlbedo(std::cos(t), OrenNayar::A(sigma), OrenNayar::B(sigma));
}

TEST(OrenNayarTest, AlbedoInClosedFormIsTheIntegralOfItsEquation) {
  for (const double sigma : {0.1, 0.5, 1.5}) {
    for (const double t : {0.0, 0.3, 0.8, 1.2, 1.5}) {
      const Reflectance r = OrenNayar{Rgb::Constant(1), float(sigma)};
      const double integral = test::AdaptiveAlbedo(
          [&](const Vec3d& a, const Vec3d& b) { return double(EvaluateBase(r, a, b)[0]); }, std::cos(t), 1);
      EXPECT_NEAR(OrenNayarAlbedo(float(sigma), t), integral, 2e-6) << sigma << ' ' << t;
    }
  }
}

TEST(OrenNayarTest, ExceedsItsAlbedoByNoMoreThanDocumented) {
  double most = 0;
  for (double sigma = 0; sigma < 1.57; sigma += 0.001) {
    most = std::max(most, OrenNayarAlbedo(sigma, 1.5707));
  }
  EXPECT_GT(most, OrenNayar::kMostAlbedo - 3e-4) << "the documented excess is met";
  EXPECT_LT(most, OrenNayar::kMostAlbedo);
  EXPECT_LT(OrenNayarAlbedo(0.33, 1.5707), 1);
}

TEST(OrenNayarTest, MatchesEquation30InAngles) {
  const double sigma = 0.45f, s2 = sigma * sigma;
  const double a = 1 - 0.5 * s2 / (s2 + 0.33), b = 0.45 * s2 / (s2 + 0.09);
  for (const double phi : {0.6, 2.9}) {  // forward and backward: the peak is towards the light
    const Vec3d wi = SphericalDirection(0.9, 0.1), wo = SphericalDirection(0.5, 0.1 + phi);
    const double expected = (a + b * std::max(0.0, std::cos(phi)) * std::sin(0.9) * std::tan(0.5)) / kPi;
    EXPECT_NEAR(EvaluateBase(OrenNayar{Rgb::Constant(1), 0.45f}, wi, wo)[0], expected, 1e-7);
  }
}

TEST(OrenNayarTest, SmoothFacetsAreLambertAndCostOneCoefficient) {
  TableCache cache;
  const MaterialLobes lobes(OrenNayar{kColour, 0}, LobeOptions{}, cache);
  EXPECT_TRUE(lobes.diffuse());
  EXPECT_FLOAT_EQ(lobes.DiffuseAlbedo()[0], kColour[0]);
}

// ---- Ashikhmin-Shirley

TEST(AshikhminShirleyTest, BaseReflectsWhatTheEquationLeavesIt) {
  for (const double t : {0.0, 0.7, 1.3, 1.55}) {
    const auto albedo = SlowAlbedo(
        [](const Vec3d& wi, const Vec3d& wo) {
          return EvaluateBase(AshikhminShirley{kColour, Rgb::Constant(0.1f), 20}, wi, wo);
        },
        t, 60);
    const double expected = 0.9 * (1 - std::pow(1 - std::cos(t) / 2, 5));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(albedo[c], kColour[c] * expected, 1e-6) << t;
  }
}

TEST(AshikhminShirleyTest, MatchesEquation4InAngles) {
  const Vec3d wi = SphericalDirection(0.7, 0.4), wo = SphericalDirection(1.1, 2.6);
  const Vec3d h = (wi + wo).normalized();
  const double n = 37, hk = h.dot(wi), f = 0.2f + (1 - 0.2f) * std::pow(1 - hk, 5);
  const double expected = (n + 1) / (8 * kPi) * std::pow(h.z(), n) / (hk * std::cos(0.7)) * f;
  EXPECT_NEAR(EvaluateGloss(AshikhminShirley{kColour, Rgb::Constant(0.2f), 37}, wi, wo)[1], expected,
              2e-6 * expected);
}

// ---- Plastic

TEST(PlasticTest, AWhiteBodyReflectsEverythingAtEveryAngle) {
  for (const float roughness : {0.1f, 0.3f, 1.0f}) {
    for (const float ior : {1.2f, 1.5f, 2.4f}) {
      const Reflectance r = Plastic(Rgb::Constant(1), ior, roughness);
      for (const double cosine : {1.0, 0.9, 0.5, 0.2, 0.1}) {
        const double alpha = roughness * roughness;
        const double gloss = test::AdaptiveAlbedo(
            [&](const Vec3d& a, const Vec3d& b) { return double(EvaluateGloss(r, a, b)[0]); }, cosine, alpha);
        const double base = test::AdaptiveAlbedo(
            [&](const Vec3d& a, const Vec3d& b) { return double(EvaluateBase(r, a, b)[0]); }, cosine, 1);
        // Linear interpolation of T between fine angles: 2e-5.
        EXPECT_NEAR(gloss + base, 1, 3e-5) << Describe(r) << " cos " << cosine;
      }
    }
  }
}

// The series of reflections under the coat, summed term by term: T rho (1 - R) (1 + rho R + (rho R)^2 + ...).
TEST(PlasticTest, BaseIsTheSumOfReflectionsUnderTheCoat) {
  const Plastic m(kColour, 1.5f, 0.4f);
  const double cosine = 0.6, through = m.Through(float(cosine)), inner = m.InnerReflectance();
  double light = through * 0.5, sum = 0;  // green
  for (int bounce = 0; bounce < 200; ++bounce) {
    sum += light * (1 - inner);
    light *= inner * 0.5;
  }
  const double base = test::AdaptiveAlbedo(
      [&](const Vec3d& a, const Vec3d& b) { return double(EvaluateBase(m, a, b)[1]); }, cosine, 1);
  EXPECT_NEAR(base, sum, 1e-6);
}

// Exact Fresnel at index 1.5: 0.0918 of diffuse light is reflected outside and 0.596 inside. Schlick's curve
// and a sharp coat: 0.04 + 0.96 / 21 and by etendue 1 - (1 - that) / 1.5^2.
TEST(PlasticTest, InnerReflectanceFollowsFromTheOuterByEtendue) {
  const Plastic sharp(kColour, 1.5f, 0.05f);
  const double outer = 0.04 + 0.96 / 21;
  EXPECT_NEAR(sharp.InnerReflectance(), 1 - (1 - outer) / 2.25, 2e-3);
  EXPECT_NEAR(sharp.InnerReflectance(), 0.596, 5e-3);
}

TEST(PlasticTest, SaturatesColoursAsInnerReflectionDoes) {
  // Light that is thrown back meets the pigment again: a darker, purer colour than albedo times T.
  const Rgb colour = NormalAlbedo(Plastic(kColour, 1.5f, 0.1f)) - 0.04f;
  EXPECT_LT(colour[2] / colour[0], 0.6f * kColour[2] / kColour[0]);
}

TEST(PlasticTest, SharesItsGlossTableWithGltfsOfTheSameRoughness) {
  EXPECT_EQ(GlossRecipe(Plastic(kColour, 1.5f, 0.4f))->key, GlossRecipe(test::Gltf(0, 0.4f))->key);
}

// ---- Measured

TEST(MeasuredBrdfTest, HasTheGridsValuesAtItsPoints) {
  const Measured m = test::MeasuredFrom(Ward{kColour, 0.3f}, 30, 10);
  const auto& axes = m.data->axes();
  for (const auto& [i, j, k] : {std::array{0, 3, 4}, {7, 2, 9}, {15, 5, 0}}) {
    const auto [wi, wo] = test::FromHalfDifference(axes[0][i], axes[1][j], axes[2][k]);
    const Rgb expected = EvaluateBrdf(Ward{kColour, 0.3f}, wi, wo);
    EXPECT_TRUE(((m.data->Value(wi, wo) - expected).abs() <= 1e-4f * expected).all())
        << i << ' ' << j << ' ' << k;
  }
}

TEST(MeasuredBrdfTest, IsLinearBetweenPointsAndConstantBeyond) {
  // f = theta_h at three rings.
  const MeasuredBrdf f("ramp", MeasuredBrdf::Coordinates::kHalfDifference,
                       {{{0.1f, 0.3f, 0.7f}, {0.5f}, {0.5f}}},
                       {0.1f, 0.1f, 0.1f, 0.3f, 0.3f, 0.3f, 0.7f, 0.7f, 0.7f});
  for (const auto& [theta, value] : {std::pair{0.02, 0.1}, {0.15, 0.15}, {0.5, 0.5}, {0.9, 0.7}}) {
    const auto [wi, wo] = test::FromHalfDifference(theta, 0.2, 1.0);
    EXPECT_NEAR(f.Value(wi, wo)[1], value, 1e-6) << theta;
  }
}

// Whatever lies at its very peak, even nothing.
TEST(MeasuredBrdfTest, WidthIsThatOfItsPeak) {
  EXPECT_NEAR(test::MeasuredFrom(CookTorrance{kColour, 0.1f}, 90, 10).data->Width() * 0.6436,
              0.1 * std::sqrt(std::log(2.0)), 0.01)
      << "half the peak at tan^2 = alpha^2 log 2";
  const Measured m = test::MeasuredFrom(CookTorrance{kColour, 0.1f}, 90, 10);
  std::vector<float> holed = m.data->values();
  std::fill_n(holed.begin(), 2 * 10 * 10 * 3, 0.0f);
  const MeasuredBrdf hole("hole", m.data->coordinates(), m.data->axes(), holed);
  EXPECT_NEAR(hole.Width(), m.data->Width(), 0.05 * m.data->Width());
  EXPECT_EQ(
      MeasuredBrdf("black", MeasuredBrdf::Coordinates::kHalfDifference, {{{0}, {0}, {0}}}, {0, 0, 0}).Width(),
      1);
}

TEST(MeasuredBrdfTest, AnglesMeasuredOneWayBecomeReciprocalByTheirMean) {
  // f = 1 + theta_i, whatever theta_o: not reciprocal. Different axes.
  const std::vector<float> in = {0, 1}, out = {0, 0.5f, 1}, azimuth = {0, 3};
  std::vector<float> values;
  for (const float i : in) values.insert(values.end(), out.size() * azimuth.size() * 3, 1 + i);
  const MeasuredBrdf f = MeasuredBrdf::FromAngles("one way", in, out, azimuth, values);
  EXPECT_EQ(f.axes()[0], (std::vector<float>{0, 0.5f, 1}));
  const Vec3d a = SphericalDirection(0.2, 0.3), b = SphericalDirection(0.9, 1.3);
  EXPECT_NEAR(f.Value(a, b)[0], 1 + 0.5 * (0.2 + 0.9), 1e-6);
  EXPECT_NEAR(f.Value(b, a)[0], 1 + 0.5 * (0.2 + 0.9), 1e-6);
}

TEST(MeasuredBrdfTest, EqualContentHasOneDigestAndSharesTables) {
  const Measured a = test::MeasuredFrom(Ward{kColour, 0.3f}, 20, 8),
                 b = test::MeasuredFrom(Ward{kColour, 0.3f}, 20, 8),
                 c = test::MeasuredFrom(Ward{kColour, 0.31f}, 20, 8);
  EXPECT_EQ(a.data->digest(), b.data->digest());
  EXPECT_NE(a.data->digest(), c.data->digest());
  EXPECT_EQ(GlossRecipe(a)->key, GlossRecipe(b)->key);
  EXPECT_NE(GlossRecipe(a)->key, GlossRecipe(c)->key);
}

TEST(MeasuredBrdfTest, RefusesGridsThatAreNone) {
  using C = MeasuredBrdf::Coordinates;
  const std::vector<float> three = {1, 1, 1};
  EXPECT_EQ(MeasuredBrdf::Problem(C::kHalfDifference, {{{0}, {0}, {0}}}, three), "");
  EXPECT_NE(MeasuredBrdf::Problem(C::kHalfDifference, {{{0}, {}, {0}}}, three), "");
  EXPECT_NE(MeasuredBrdf::Problem(C::kHalfDifference, {{{0}, {0}, {3}}}, three), "") << "beyond pi / 2";
  EXPECT_EQ(MeasuredBrdf::Problem(C::kIncidentOutgoing, {{{0}, {0}, {3}}}, three), "");
  EXPECT_NE(MeasuredBrdf::Problem(C::kHalfDifference, {{{0, 0}, {0}, {0}}}, {1, 1, 1, 1, 1, 1}), "");
  EXPECT_NE(MeasuredBrdf::Problem(C::kHalfDifference, {{{0}, {0}, {0}}}, {1, 1}), "");
  EXPECT_NE(MeasuredBrdf::Problem(C::kHalfDifference, {{{0}, {0}, {0}}}, {1, -1, 1}), "");
  EXPECT_NE(MeasuredBrdf::Problem(C::kHalfDifference, {{{0}, {0}, {0}}}, {1, NAN, 1}), "");
  EXPECT_NE(MeasuredBrdf::Problem(C::kIncidentOutgoing, {{{0, 1}, {0, 1}, {0}}},
                                  {1, 1, 1, 2, 2, 2, 3, 3, 3, 1, 1, 1}),
            "")
      << "not reciprocal";
  EXPECT_THROW(MeasuredBrdf("x", C::kHalfDifference, {{{0}, {0}, {0}}}, {1, 1}), std::invalid_argument);
}

// Lobes of data follow those of the model it came from, as closely as the grid tells it.
TEST(MeasuredBrdfTest, LobesOfFineDataAreThoseOfItsModel) {
  TableCache cache;
  LobeOptions options;
  options.force_l_max = 8;
  const Reflectance model = Ward{kColour, 0.3f};
  const MaterialLobes exact(model, options, cache), data(test::MeasuredFrom(model, 90, 30), options, cache);
  for (const float cosine : {0.95f, 0.6f, 0.3f}) {
    // Ward falls as 1 / cos_d^2 around theta_d = theta_i: linear between points a step apart, f is off by
    // step^2 / 8 f'' = step^2 / 8 (6 tan^2 + 2); along theta_h, where steps are finer, by less.
    const double step = 0.5 * kPi / 30, tan2 = 1 / (double(cosine) * cosine) - 1;
    const float bound = float(1.5 * step * step / 8 * (6 * tan2 + 2) + 2e-3);
    EXPECT_TRUE(((data.Albedo(cosine) - exact.Albedo(cosine)).abs() < bound * exact.Albedo(cosine)).all())
        << cosine << ": " << data.Albedo(cosine).transpose() << " against "
        << exact.Albedo(cosine).transpose();
  }
  EXPECT_NEAR(data.gloss.error.total, exact.gloss.error.total, 0.05 * exact.gloss.error.total);
}

}  // namespace
}  // namespace lobe
