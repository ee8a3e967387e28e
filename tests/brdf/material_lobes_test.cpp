#include "brdf/material_lobes.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "brdf/incident_moments.h"
#include "sh/lobe.h"
#include "sh/quadrature.h"
#include "tests/support/slow_albedo.h"

namespace lobe {
namespace {

MetallicRoughness Gltf(float base, float metallic, float roughness) {
  MetallicRoughness r;
  r.base_color = Rgb(base, 0.5f * base, base);
  r.metallic = metallic;
  r.roughness = roughness;
  return r;
}

MetallicRoughness White(float roughness) {
  MetallicRoughness r = Gltf(1, 1, roughness);
  r.base_color = Rgb::Constant(1);
  return r;
}

MetallicRoughness Diffuse() {
  MetallicRoughness r = Gltf(0.7f, 0, 1);
  r.specular = 0;
  r.has_specular = true;
  return r;
}

std::pair<Eigen::MatrixXf, Eigen::MatrixXf> Lobes(const MaterialLobes& material, const Vec3& wi) {
  IncidentMoments moments;
  moments.Start(material);
  moments.Add(wi, Rgb::Constant(1));
  Eigen::MatrixXf base = Eigen::MatrixXf::Zero(material.base.count(), 3);
  Eigen::MatrixXf gloss = Eigen::MatrixXf::Zero(material.gloss.count(), 3);
  moments.Finish(base.data(), gloss.data());
  return {base, gloss};
}

Vec3 At(double degrees, double phi) {
  const double t = degrees * std::numbers::pi / 180;
  return Vec3(float(std::sin(t) * std::cos(phi)), float(std::sin(t) * std::sin(phi)), float(std::cos(t)));
}

TEST(MaterialLobesTest, FallsIntoTheFourKinds) {
  TableCache cache;
  const LobeOptions options;
  EXPECT_EQ(MaterialLobes(Diffuse(), options, cache).kind(), GlossKind::kNone);
  EXPECT_EQ(MaterialLobes(Lambert{}, options, cache).kind(), GlossKind::kNone);
  EXPECT_EQ(MaterialLobes(Gltf(0.9f, 1, 0.5f), options, cache).kind(), GlossKind::kLobe);
  EXPECT_EQ(MaterialLobes(Gltf(0.9f, 1, 0.2f), options, cache).kind(), GlossKind::kSharp);
  EXPECT_EQ(MaterialLobes(Gltf(0.9f, 1, 0.0099f), options, cache).kind(), GlossKind::kMirror);
  EXPECT_EQ(MaterialLobes(Gltf(0.9f, 1, 0.01f), options, cache).kind(), GlossKind::kSharp);
  const MaterialLobes mirror(Gltf(0.9f, 0, 0.0f), options, cache);
  EXPECT_EQ(mirror.kind(), GlossKind::kMirror);
  EXPECT_LT(mirror.gloss.l_max, 0);
  EXPECT_GE(mirror.base.l_max, 0) << "a dielectric mirror keeps its base";
}

TEST(MaterialLobesTest, DiffuseMaterialsAreOneCoefficient) {
  TableCache cache;
  const MaterialLobes diffuse(Diffuse(), LobeOptions{}, cache);
  EXPECT_TRUE(diffuse.diffuse());
  EXPECT_EQ(diffuse.base.count(), 1);
  EXPECT_NEAR(diffuse.DiffuseAlbedo()[0], 0.7f, 1e-6);
}

TEST(MaterialLobesTest, HemisphericalAlbedoIsTheMeanOverAllAngles) {
  TableCache cache;
  const MaterialLobes lambert(Lambert{Rgb(0.1f, 0.7f, 1.0f / 3)}, {}, cache);
  EXPECT_TRUE((lambert.HemisphericalAlbedo() == Rgb(0.1f, 0.7f, 1.0f / 3)).all()) << "exact";
  const MaterialLobes coated(Gltf(0.7f, 0, 0.4f), {}, cache);
  // Midpoints, many: an error of their step squared, but for the corner at grazing.
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double mu = (i + 0.5) / kSteps;
    sum += 2 * mu / kSteps * coated.Albedo(float(mu)).cast<double>();
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(coated.HemisphericalAlbedo()[c], sum[c], 1e-4);
}

TEST(MaterialLobesTest, TakesTheSmallestDegreeWithinTheTolerance) {
  TableCache cache;
  for (const double tolerance : {0.5, 0.2, 0.05}) {
    LobeOptions options{.l_max = 24, .error = tolerance};
    const MaterialLobes m(White(0.5f), options, cache);  // F = 1, on which the degree is chosen
    EXPECT_LE(m.gloss.error.total, tolerance);
    options.force_l_max = m.gloss.l_max - 1;
    EXPECT_GT(MaterialLobes(White(0.5f), options, cache).gloss.error.total, tolerance);
  }
}

// The error stated is the gloss's own, Fresnel included: measured here lobe by lobe against the closed form.
TEST(MaterialLobesTest, StatesTheErrorOfTheMaterialNotOfItsTable) {
  TableCache cache;
  LobeOptions options;
  options.force_l_max = 8;
  const HemisphereBasis<double> basis(8);
  const HemisphereQuadrature rule(60);
  Eigen::VectorXd h(basis.size());
  for (const float metallic : {0.0f, 1.0f}) {
    MetallicRoughness r = White(0.7f);
    r.metallic = metallic;
    const MaterialLobes material(r, options, cache);
    double sum = 0, weights = 0;
    const GaussLegendre angles(24, 0, 0.5 * std::numbers::pi);
    for (int i = 0; i < 24; ++i) {
      const Vec3d wi(std::sin(angles.nodes[i]), 0, std::cos(angles.nodes[i]));
      const Eigen::VectorXd lobe = Lobes(material, wi.cast<float>()).second.col(0).cast<double>();
      double off2 = 0, norm2 = 0;
      for (size_t k = 0; k < rule.weights.size(); ++k) {
        const Vec3d& wo = rule.directions[k];
        const double f = EvaluateGloss(r, wi, wo)[0];
        basis.Evaluate(wo.x(), wo.y(), wo.z(), h.data());
        off2 += rule.weights[k] * wo.z() * (f - h.dot(lobe)) * (f - h.dot(lobe));
        norm2 += rule.weights[k] * wo.z() * f * f;
      }
      const double w = angles.weights[i] * material.gloss.Albedo(float(wi.z()))[0] * wi.z() * wi.x();
      sum += w * std::sqrt(off2 / norm2);
      weights += w;
    }
    EXPECT_NEAR(material.gloss.error.total, sum / weights, 0.03 * sum / weights) << "metallic " << metallic;
  }
}

// Between knots as at them, up to 89 degrees: 1e-3 absolute, every kind of model. SlowAlbedo shares no code.
TEST(MaterialLobesTest, FluxOfAReflectedLobeIsTheAlbedoAtEveryAngle) {
  TableCache cache;
  const std::vector<std::pair<Reflectance, double>> models = {
      {Gltf(0.9f, 1, 0.05f), 0.0025},        {Gltf(0.9f, 1, 0.2f), 0.04},
      {Gltf(0.6f, 0, 0.3f), 0.09},           {Gltf(0.6f, 0, 1.0f), 1.0},
      {Phong{Rgb::Constant(0.8f), 20}, 0.2}, {Ward{Rgb::Constant(0.8f), 0.2f}, 0.2}};
  for (const auto& [reflectance, width] : models) {
    for (const int l_max : {0, 5, 12, 24}) {
      LobeOptions options;
      options.force_l_max = l_max;
      const MaterialLobes material(reflectance, options, cache);
      for (const double degrees : {0.0, 7.3, 31.0, 52.7, 71.1, 83.9, 87.4, 89.0}) {
        const Vec3 wi = At(degrees, 0.8);
        const auto [base, gloss] = Lobes(material, wi);
        double flux = 0;
        if (base.rows() > 0) flux += LobeFlux(base.cast<double>())(1);
        if (gloss.rows() > 0) flux += LobeFlux(gloss.cast<double>())(1);
        // The gloss in half-vector coordinates of its own width, the smooth base in wide ones.
        const double exact =
            test::SlowAlbedo(
                [&](const Vec3d& a, const Vec3d& b) { return double(EvaluateGloss(reflectance, a, b)[1]); },
                wi.z(), width, 400, 200) +
            test::SlowAlbedo(
                [&](const Vec3d& a, const Vec3d& b) { return double(EvaluateBase(reflectance, a, b)[1]); },
                wi.z(), 1.0, 400, 200);
        EXPECT_NEAR(flux, exact, 1e-3) << Describe(reflectance) << " l_max " << l_max << " at " << degrees;
        EXPECT_NEAR(material.Albedo(wi.z())[1], exact, 1e-3);
      }
    }
  }
}

TEST(MaterialLobesTest, LobesFollowTheClosedFormAtHighDegree) {
  TableCache cache;
  LobeOptions options;
  options.force_l_max = 32;
  const Reflectance r = Gltf(0.8f, 0.3f, 0.7f);
  const MaterialLobes material(r, options, cache);
  const HemisphereBasis<float> basis(32);
  std::vector<float> h(basis.size());
  for (const double degrees : {3.0, 20.0, 45.0, 65.0}) {
    const Vec3 wi = At(degrees, -2.1);
    const auto [base, gloss] = Lobes(material, wi);
    for (const auto& [theta_o, phi_o] : {std::pair{10.0, 1.0}, {40.0, 0.6}, {60.0, 4.0}, {75.0, 2.0}}) {
      const Vec3 wo = At(theta_o, phi_o);
      basis.Evaluate(wo.x(), wo.y(), wo.z(), h.data());
      const Vec3d a = wi.cast<double>(), b = wo.cast<double>();
      for (int c = 0; c < 3; ++c) {
        // Pointwise errors are larger than the mean ones: 1 % of the peak, 0.3 % of which is the table's.
        EXPECT_NEAR(Dot(gloss.col(c).data(), h.data(), int(gloss.rows())), EvaluateGloss(r, a, b)[c], 0.01)
            << degrees << " -> " << theta_o;
        EXPECT_NEAR(Dot(base.col(c).data(), h.data(), int(base.rows())), EvaluateBase(r, a, b)[c], 0.01)
            << degrees << " -> " << theta_o;
      }
    }
  }
}

TEST(MaterialLobesTest, TurnsWithTheIncidentAzimuth) {
  TableCache cache;
  const MaterialLobes material(Gltf(0.9f, 1, 0.5f), LobeOptions{}, cache);
  const HemisphereBasis<float> basis(material.gloss.l_max);
  std::vector<float> h(basis.size());
  const auto value = [&](double phi_i, double phi_o) {
    const auto gloss = Lobes(material, At(50, phi_i)).second;
    const Vec3 wo = At(35, phi_o);
    basis.Evaluate(wo.x(), wo.y(), wo.z(), h.data());
    return Dot(gloss.col(0).data(), h.data(), int(gloss.rows()));
  };
  for (const double turn : {0.4, 1.9, -2.7})
    EXPECT_NEAR(value(0.3 + turn, 2.5 + turn), value(0.3, 2.5), 1e-4);
}

TEST(MaterialLobesTest, MomentsAddUpLikeLight) {
  TableCache cache;
  const MaterialLobes material(Gltf(0.9f, 0, 0.5f), LobeOptions{}, cache);
  const Vec3 w1 = At(2, 1), w2 = At(77, 4);
  IncidentMoments moments;
  moments.Start(material);
  moments.Add(w1, Rgb(1, 2, 3));
  moments.Add(w2, Rgb(4, 0, 1));
  Eigen::MatrixXf base = Eigen::MatrixXf::Zero(material.base.count(), 3);
  Eigen::MatrixXf gloss = Eigen::MatrixXf::Zero(material.gloss.count(), 3);
  moments.Finish(base.data(), gloss.data());
  const auto g1 = Lobes(material, w1).second, g2 = Lobes(material, w2).second;
  const Rgb e1(1, 2, 3), e2(4, 0, 1);
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT((gloss.col(c) - e1[c] * g1.col(c) - e2[c] * g2.col(c)).cwiseAbs().maxCoeff(), 1e-4);
  }
}

MetallicRoughness Sheet(float t, MetallicRoughness coat) {
  coat.diffuse_transmission = t;
  coat.diffuse_transmission_color = Rgb(0.9f, 0.65f, 0.35f);
  return coat;
}

// A tenth of what reflected lobes may be off: no spline lies between, only the fine grid.
TEST(MaterialLobesTest, TransmissionAlbedoIsTheFluxOfTheClosedFormAtEveryAngle) {
  TableCache cache;
  MetallicRoughness tinted = Gltf(0.8f, 0.2f, 0.5f);
  tinted.has_specular = true;
  tinted.specular_color = Rgb(0.3f, 4.0f, 1.0f);
  for (const MetallicRoughness& coat : {Gltf(0.6f, 0, 0.3f), Gltf(0.6f, 0.5f, 1.0f), tinted}) {
    for (const float t : {0.4f, 1.0f}) {
      const Reflectance sheet = Sheet(t, coat);
      const MaterialLobes material(sheet, LobeOptions{}, cache);
      EXPECT_TRUE(material.transmits());
      for (const double degrees : {0.0, 7.3, 31.0, 52.7, 71.1, 83.9, 87.4, 89.0}) {
        const Vec3 wi = At(degrees, 0.8);
        const Rgb albedo = material.TransmissionAlbedo(wi.z());
        for (const int c : {0, 1}) {
          const double exact = test::SlowAlbedo(
              [&](const Vec3d& a, const Vec3d& b) {
                return double(EvaluateTransmission(sheet, a, Vec3d(b.x(), b.y(), -b.z()))[c]);
              },
              wi.z(), 1.0, 400, 200);
          EXPECT_NEAR(albedo[c], exact, 1e-4) << Describe(sheet) << " t " << t << " at " << degrees;
        }
        // What leaves both sides, but for the surplus of glTF's gloss.
        EXPECT_LE((albedo + material.base.Albedo(wi.z())).maxCoeff(), 1.0f);
      }
    }
  }
}

TEST(MaterialLobesTest, UncoatedSheetsPassAConstantShare) {
  TableCache cache;
  MetallicRoughness coat = Diffuse();
  const MaterialLobes paper(Sheet(0.4f, coat), LobeOptions{}, cache);
  EXPECT_TRUE(paper.diffuse());
  EXPECT_NEAR(paper.DiffuseAlbedo()[0], 0.6f * 0.7f, 1e-6) << "reflected alone";
  EXPECT_NEAR(paper.Albedo(0.3f)[0], 0.6f * 0.7f, 1e-6);
  for (const float cosine : {0.0f, 0.05f, 0.5f, 1.0f}) {
    EXPECT_NEAR(paper.TransmissionAlbedo(cosine)[1], 0.4f * 0.65f, 1e-6);
  }
}

TEST(MaterialLobesTest, MetalsAndOpaqueMaterialsTransmitNothing) {
  TableCache cache;
  for (const Reflectance& r : {Reflectance(Lambert{}), Reflectance(Gltf(0.8f, 0, 0.5f)),
                               Reflectance(Sheet(1, Gltf(0.8f, 1, 0.5f)))}) {
    const MaterialLobes material(r, LobeOptions{}, cache);
    EXPECT_FALSE(material.transmits());
    EXPECT_EQ(material.TransmissionAlbedo(0.7f).maxCoeff(), 0.0f);
  }
}

// Transmitted light leaves by the base, even where nothing is reflected under the coat.
TEST(MaterialLobesTest, SheetsThatReflectNothingUnderTheCoatStillHaveABase) {
  TableCache cache;
  const MaterialLobes sheet(Sheet(1, Gltf(0.6f, 0, 0.5f)), LobeOptions{}, cache);
  ASSERT_EQ(sheet.base.l_max, 0);
  EXPECT_GE(sheet.gloss.l_max, 0);
  const auto [base, gloss] = Lobes(sheet, At(40, 1));
  EXPECT_EQ(base.cwiseAbs().maxCoeff(), 0.0f);
  EXPECT_GT(gloss(0, 0), 0.0f);
}

// glTF's own formula gains energy near grazing; the ledger is to show it, so the table must not hide it.
TEST(MaterialLobesTest, KeepsTheAlbedoAboveOneOfGltfsFormula) {
  TableCache cache;
  const MaterialLobes material(Gltf(0.8f, 0, 0.3f), LobeOptions{}, cache);
  EXPECT_NEAR(material.Albedo(0.15f)[0], 1.053f, 1e-3);
}

}  // namespace
}  // namespace lobe
