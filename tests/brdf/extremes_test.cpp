// Reflectance and its lobes at the ends of their ranges: docs/validation.md#extremes.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "brdf/frame.h"
#include "brdf/incident_moments.h"
#include "brdf/material_lobes.h"
#include "sh/lobe.h"
#include "tests/support/adaptive_albedo.h"

namespace lobe {
namespace {

constexpr float kAlmostGrazing = 1e-7f;  // cosine of 90 degrees less 1e-7 radians

MetallicRoughness Metal(float roughness, float albedo = 1) {
  MetallicRoughness m;
  m.base_color = Rgb::Constant(albedo);
  m.roughness = roughness;
  return m;
}

struct Model {
  Reflectance reflectance;
  double width;
};

std::vector<Model> Models() {
  std::vector<Model> out;
  for (const float r : {0.01f, 0.02f, 0.05f, 0.2f, 1.0f}) out.push_back({Metal(r), double(r) * r});
  for (const float n : {0.0f, 0.2f, 1.0f, 3.0f, 100.0f, 1e4f, 1e6f}) {
    out.push_back({Phong{Rgb::Constant(1), n}, 1 / std::sqrt(n + 1.0)});
  }
  return out;
}

// Flux of base and gloss for irradiance 1 from wi.
double FluxFrom(const MaterialLobes& material, const Vec3& wi) {
  IncidentMoments moments;
  moments.Start(material);
  moments.Add(wi, Rgb::Constant(1));
  double flux = 0;
  std::vector<float> base(size_t(3) * material.base.count()), gloss(size_t(3) * material.gloss.count());
  moments.Finish(base.data(), gloss.data());
  for (const auto& [part, lobe] : {std::pair{&material.base, &base}, {&material.gloss, &gloss}}) {
    if (part->l_max < 0) continue;
    for (const float v : *lobe) EXPECT_TRUE(std::isfinite(v));
    const Eigen::VectorXd green =
        Eigen::Map<const Eigen::VectorXf>(lobe->data() + part->count(), part->count()).cast<double>();
    flux += LobeFlux(green)[0];
  }
  return flux;
}

LobeOptions Degree12() {
  LobeOptions options;
  options.l_max = 12;
  return options;
}

// A lobe a ten-thousandth of a radian wide, read between the fine angles of the table: measured 9e-5 for
// Phong 1e6, 2.4e-4 for Phong 0, whose f ends with a jump (8.7e-3 before the quadrature knew where), 4e-5 for
// GGX.
void ExpectFluxAt(const std::vector<double>& angles_in_degrees) {
  TableCache cache;
  for (const Model& model : Models()) {
    const MaterialLobes material(model.reflectance, Degree12(), cache);
    ASSERT_GE(material.gloss.l_max, 0) << Describe(model.reflectance);
    const auto f = [&](const Vec3d& wi, const Vec3d& wo) {
      return double(EvaluateGloss(model.reflectance, wi, wo)[1]);
    };
    for (const double degrees : angles_in_degrees) {
      const double c = std::cos(degrees * std::numbers::pi / 180), s = std::sqrt(1 - c * c);
      const double expected = test::AdaptiveAlbedo(f, c, model.width);
      const double flux = FluxFrom(material, {float(0.6 * s), float(-0.8 * s), float(c)});
      EXPECT_NEAR(flux, expected, 3e-4) << Describe(model.reflectance) << " at " << degrees << " degrees";
      EXPECT_NEAR(material.Albedo(float(c))[1], expected, 3e-4) << Describe(model.reflectance);
    }
  }
}

TEST(ExtremesTest, FluxIsRightFromRoughnessOneToAHundredthAndPhong0ToAMillion) { ExpectFluxAt({60}); }
TEST(SlowExtremesTest, FluxOfSharpAndBluntLobesIsRightAtEveryAngle) { ExpectFluxAt({0, 20, 80, 88}); }

// What cannot be shown is said: sharper lobes have an error nearer 1, and are called sharp.
TEST(ExtremesTest, TheErrorToldGrowsToOneAsLobesSharpen) {
  TableCache cache;
  double before = 0;
  for (const float roughness : {1.0f, 0.5f, 0.2f, 0.05f, 0.02f, 0.01f}) {
    const MaterialLobes material(Metal(roughness), Degree12(), cache);
    if (roughness <= 0.2f) {
      EXPECT_EQ(material.kind(), GlossKind::kSharp) << roughness;
      EXPECT_GE(material.gloss.error.total, before) << roughness;
    }
    EXPECT_LE(material.gloss.error.total, 1.0) << roughness;
    before = material.gloss.error.total;
  }
  EXPECT_GT(before, 0.999) << "of roughness 0.01 a lobe of degree 12 shows next to nothing";
  const MaterialLobes phong(Phong{Rgb::Constant(1), 1e6f}, Degree12(), cache);
  EXPECT_EQ(phong.kind(), GlossKind::kSharp);
  EXPECT_GT(phong.gloss.error.total, 0.99);
}

// 2e-4: at grazing the albedo of roughness 0.05 changes within the last of the table's fine angles.
TEST(ExtremesTest, NormalAndGrazingIncidenceAndBelowItByRoundingKeepTheFlux) {
  TableCache cache;
  for (const Model& model : Models()) {
    const MaterialLobes material(model.reflectance, Degree12(), cache);
    for (const Vec3& wi :
         {Vec3(0, 0, 1), Vec3(1e-30f, -1e-30f, 1), Vec3(1e-8f, 1e-8f, 1), Vec3(0.6f, 0.8f, kAlmostGrazing),
          Vec3(0.6f, 0.8f, 0), Vec3(0.6f, 0.8f, -1e-8f), Vec3(0, 0, 1.0000001f)}) {
      const double flux = FluxFrom(material, wi), albedo = material.Albedo(wi.z())[1];
      EXPECT_NEAR(flux, albedo, 2e-4) << Describe(model.reflectance) << " at cos " << wi.z();
      EXPECT_GE(albedo, 0) << Describe(model.reflectance);
      EXPECT_LT(albedo, 1.001) << Describe(model.reflectance);
    }
  }
}

TEST(ExtremesTest, AlbedoZeroOneAndNextToOneAreKept) {
  TableCache cache;
  for (const float albedo : {0.0f, 1.0f, 1.0f - 1e-7f}) {
    const MaterialLobes diffuse(Lambert{Rgb::Constant(albedo)}, Degree12(), cache);
    EXPECT_EQ(diffuse.Albedo(0.3f)[0], albedo);
    const MaterialLobes phong(Phong{Rgb::Constant(albedo), 20}, Degree12(), cache);
    EXPECT_NEAR(phong.Albedo(1)[0], albedo, 1e-6);
    EXPECT_LE(phong.Albedo(1)[0], 1.000001f);
    const MaterialLobes metal(Metal(0.5f, albedo), Degree12(), cache), white(Metal(0.5f), Degree12(), cache);
    EXPECT_LE(metal.Albedo(0.7f)[0], white.Albedo(0.7f)[0]);
    // Of black metal Schlick's rise alone is left.
    EXPECT_LE(metal.Albedo(1)[0], albedo + 1e-4f);
  }
}

// 0.1 a million times: one float adds up to 100958.
TEST(ExtremesTest, AMillionContributionsAddUpToAMillionTimesOne) {
  constexpr int kCount = 1000000;
  TableCache cache;
  LobeOptions options;
  options.force_l_max = 8;
  MetallicRoughness plastic = Metal(0.5f, 0.6f);
  plastic.metallic = 0.5f;
  const MaterialLobes material(plastic, options, cache);
  const auto leaving = [&](int count, bool ring) {
    IncidentMoments moments;
    moments.Start(material);
    const float planes[3] = {0.1f, 0.3f, 0.7f};
    for (int i = 0; i < count; ++i) {
      if (ring) {
        moments.AddRing(0.8f, planes, 1, 0.4f);
      } else {
        moments.Add({0.6f * 0.8f, -0.6f * 0.6f, 0.8f}, {0.1f, 0.3f, 0.7f});
      }
    }
    const int base = 3 * material.base.count(), gloss = 3 * material.gloss.count();
    Eigen::VectorXf out = Eigen::VectorXf::Zero(base + gloss);
    moments.Finish(out.data(), out.data() + base);
    return Eigen::VectorXd(out.cast<double>());
  };
  for (const bool ring : {false, true}) {
    const Eigen::VectorXd expected = double(kCount) * leaving(1, ring), sum = leaving(kCount, ring);
    EXPECT_LT((sum - expected).norm(), 1e-5 * expected.norm()) << (ring ? "rings" : "one by one");
  }
}

}  // namespace
}  // namespace lobe
