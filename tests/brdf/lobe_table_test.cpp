#include "brdf/lobe_table.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "brdf/reflectance.h"
#include "tests/support/adaptive_albedo.h"

namespace lobe {
namespace {

struct Model {
  std::string name;
  ScalarBrdf f;
  double width;
};

Model Ggx(double roughness) {
  const double a = roughness * roughness;
  return {"ggx " + std::to_string(roughness),
          [a](const Vec3d& wi, const Vec3d& wo) {
            const Vec3d h = (wi + wo).normalized();
            return GgxD(h.z(), a) * GgxV(wi.z(), wo.z(), a);
          },
          a};
}

Model FromReflectance(const std::string& name, const Reflectance& r, double width) {
  return {name, [r](const Vec3d& wi, const Vec3d& wo) { return double(EvaluateGloss(r, wi, wo)[0]); }, width};
}

std::vector<Model> AllModels() {
  std::vector<Model> out;
  for (const double roughness : {0.05, 0.1, 0.2, 0.3, 0.5, 1.0}) out.push_back(Ggx(roughness));
  for (const float n : {5.0f, 20.0f, 200.0f}) {
    out.push_back(
        FromReflectance("phong " + std::to_string(n), Phong{Rgb::Constant(1), n}, 1 / std::sqrt(n + 1.0)));
  }
  for (const float a : {0.1f, 0.4f}) {
    out.push_back(FromReflectance("ward " + std::to_string(a), Ward{Rgb::Constant(1), a}, a));
  }
  return out;
}

double Flux(const ScalarTable& table, int knot) {
  return std::sqrt(std::numbers::pi) * table.zernike(0, knot);
}

// At the knots 3e-7, whatever the model (Phong and Ward are evaluated in single precision).
TEST(LobeTableTest, FluxAtKnotsEqualsAnIndependentQuadrature) {
  for (const Model& model : AllModels()) {
    const auto table = ScalarTable::Build(model.f, 0, HalfVectorRule{.width = model.width}, 24);
    const IncidenceSpline spline(24);
    for (const int knot : {0, 3, 9, 15, 19, 21, 22}) {
      const double c = spline.KnotCosine(knot);
      EXPECT_NEAR(Flux(table, knot), test::AdaptiveAlbedo(model.f, c, model.width), 3e-7)
          << model.name << " at cos " << c;
    }
  }
}

// Flux does not depend on the degree: the projection keeps it.
TEST(LobeTableTest, FluxIsTheSameAtEveryDegree) {
  const Model model = Ggx(0.3);
  const HalfVectorRule rule{.width = model.width};
  const auto low = ScalarTable::Build(model.f, 0, rule, 40), high = ScalarTable::Build(model.f, 24, rule, 40);
  for (int knot = 0; knot < 40; ++knot) EXPECT_NEAR(Flux(low, knot), Flux(high, knot), 1e-12);
}

// DESIGN 3 gives this table for F = 1: its digits, or better (the last column of roughness 1 is 0.25).
TEST(LobeTableTest, ErrorByDegreeIsThatOfTheDesign) {
  struct Row {
    double roughness;
    double percent[6];
  };
  const int degrees[6] = {6, 8, 12, 16, 24, 32};
  for (const Row& row : {Row{1.0, {4.2, 3.0, 1.8, 1.2, 0.7, 0.4}}, Row{0.5, {24, 16, 8.4, 5.0, 2.3, 1.3}},
                         Row{0.3, {72, 63, 46, 34, 19, 11}}}) {
    const Model model = Ggx(row.roughness);
    const auto table = ScalarTable::Build(model.f, 32, HalfVectorRule{.width = model.width});
    for (int i = 0; i < 6; ++i) {
      const double step = row.percent[i] >= 10 ? 0.5 : 0.1;
      EXPECT_LT(100 * table.Error(degrees[i]), row.percent[i] + step) << "roughness " << row.roughness;
      EXPECT_GT(100 * table.Error(degrees[i]), row.percent[i] - 2 * step) << "roughness " << row.roughness;
    }
  }
}

// Products with the basis oscillate faster than the lobes; the points must follow. With 40 x 64 the
// coefficients were 0.4 % off, and at the last knot, 90 degrees, 10 % to degree 16 and 60 % to degree 24.
TEST(LobeTableTest, CoefficientsAreResolvedUpToTheHighestDegreeAndToGrazingIncidence) {
  for (const double roughness : {1.0, 0.7, 0.2}) {
    const Model model = Ggx(roughness);
    const HalfVectorRule finer{
        .width = model.width, .polar = GaussLegendre(160, 0, 1), .azimuth = GaussLegendre(300, -1, 1)};
    for (const int l_max : {12, 16, 24, 32}) {
      const auto table = ScalarTable::Build(model.f, l_max, {.width = model.width}, 7);
      const auto exact = ScalarTable::Build(model.f, l_max, finer, 7);
      for (int j = 0; j < 7; ++j) {
        EXPECT_LT((table.zernike.col(j) - exact.zernike.col(j)).norm(), 2e-4 * std::sqrt(exact.norm2[j]))
            << model.name << ", l_max " << l_max << ", knot " << j;
      }
    }
  }
}

TEST(LobeTableTest, ErrorFallsWithEveryDegree) {
  for (const Model& model : AllModels()) {
    const auto table = ScalarTable::Build(model.f, 16, HalfVectorRule{.width = model.width});
    for (int l = 1; l <= 16; ++l) EXPECT_LE(table.Error(l), table.Error(l - 1)) << model.name;
  }
}

double SchlickRise(const Vec3d& wi, const Vec3d& wo) {
  return std::pow(1 - wi.dot((wi + wo).normalized()), 5);
}

// The mixture, its norms included, is the table of the mixed reflectance.
TEST(SchlickTablesTest, MixIsTheTableOfTheMixedReflectance) {
  for (const Model& model : {Ggx(0.5), FromReflectance("phong", Phong{Rgb::Constant(1), 20}, 0.22)}) {
    const HalfVectorRule rule{.width = model.width};
    const ScalarTable mixed = SchlickTables::Build(model.f, 6, rule, 24).Mix(0.3, -1.7);
    const auto direct = ScalarTable::Build(
        [&](const Vec3d& wi, const Vec3d& wo) { return model.f(wi, wo) * (0.3 - 1.7 * SchlickRise(wi, wo)); },
        6, rule, 24);
    EXPECT_LT((mixed.zernike - direct.zernike).cwiseAbs().maxCoeff(), 1e-12) << model.name;
    EXPECT_LT((mixed.albedo - direct.albedo).cwiseAbs().maxCoeff(), 1e-12) << model.name;
    EXPECT_LT(((mixed.norm2 - direct.norm2).array() / direct.norm2.array()).abs().maxCoeff(), 1e-11)
        << model.name;
  }
}

// The fine grid of albedos comes from few integrals. Up to 89.83 degrees, layers as thin as roughness 0.05
// makes them included, it adds 1e-7 to the error of the half-vector rule, which is largest for Ward at
// grazing, 7e-7.
TEST(LobeTableTest, FineAlbedoEqualsAnIndependentQuadrature) {
  for (const Model& model : AllModels()) {
    const auto table = ScalarTable::Build(model.f, 0, HalfVectorRule{.width = model.width}, 24);
    for (const int i : {0, 1, 77, 160, 201, 230, 241, 249}) {
      const double c = IncidenceSpline::CosineOfParameter(double(i) / ScalarTable::kFine);
      EXPECT_NEAR(table.albedo[i], test::AdaptiveAlbedo(model.f, c, model.width), 1e-6)
          << model.name << " at cos " << c;
    }
  }
}

TEST(IncidenceSplineTest, ReproducesKnotsAndKeepsParity) {
  const IncidenceSpline spline(20);
  Eigen::MatrixXd even(20, 1), odd(20, 1);
  const auto theta = [&](double c) { return std::acos(c); };
  for (int j = 0; j < 20; ++j) {
    even(j, 0) = std::cos(2 * theta(spline.KnotCosine(j)));
    odd(j, 0) = std::sin(theta(spline.KnotCosine(j)));
  }
  const Eigen::MatrixXd ce = spline.ControlValues(even, false), co = spline.ControlValues(odd, true);
  // Read between the knots too: smooth functions of the right parity come back to the spline's order.
  for (double degrees = 0; degrees < 89.5; degrees += 0.37) {
    const double c = std::cos(degrees * std::numbers::pi / 180);
    const auto s = spline.At(float(c));
    double e = 0, o = 0;
    for (int k = 0; k < 4; ++k) {
      e += s.weight[k] * ce(s.bin[k], 0);
      o += (k == 0 && s.mirrored ? -1 : 1) * s.weight[k] * co(s.bin[k], 0);
    }
    EXPECT_NEAR(e, std::cos(2 * theta(c)), 3e-4) << degrees << " degrees";
    EXPECT_NEAR(o, std::sin(theta(c)), 3e-4) << degrees << " degrees";
  }
}

TEST(IncidenceSplineTest, RefusesTooFewKnots) { EXPECT_THROW(IncidenceSpline(4), std::invalid_argument); }

}  // namespace
}  // namespace lobe
