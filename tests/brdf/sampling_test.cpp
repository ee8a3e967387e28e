#include "brdf/sampling.h"

#include <cmath>
#include <numbers>
#include <random>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "brdf/hemisphere_integral.h"
#include "tests/support/brdf_models.h"
#include "tests/support/direction_chi_square.h"
#include "tests/support/outgoing_integral.h"
#include "tests/support/significance.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;
const Rgb kColour = test::kModelColour;

using test::AllModelCases;
using test::Gltf;
using test::Matte;
using test::ModelCase;

/// Every alternative of Reflectance, rough to sharp.
std::vector<Reflectance> Models() {
  std::vector<Reflectance> out;
  for (const ModelCase& m : AllModelCases()) out.push_back(m.r);
  return out;
}

const std::vector<double> kAngles = {0.0, 0.4, 1.0, 1.35, 1.53};

std::string Words(const Reflectance& r, double theta) {
  std::ostringstream words;
  words << Describe(r) << (Transmits(r) ? ", transmits" : "") << ", theta_o " << theta;
  return words.str();
}

Vec3 Eye(double theta) { return SphericalDirection(theta, 0.7).cast<float>(); }

// The float form against the double one of brdf/reflectance.h, and the pdf it states beside it.
TEST(ReflectanceSamplerTest, EvaluatesTheClosedFormOnBothSides) {
  std::mt19937_64 bits(1);
  std::uniform_real_distribution<float> u(0, 1);
  for (const Reflectance& r : Models()) {
    const ReflectanceSampler sampler(r);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 wo = SphericalDirection(std::acos(0.02 + 0.98 * u(bits)), 2 * kPi * u(bits)).cast<float>();
      // Half near the lobe, half anywhere on the sphere.
      Vec3 wi = i % 2 ? sampler.Sample(wo, u(bits), u(bits), u(bits)).wi
                      : SphericalDirection(std::acos(2 * u(bits) - 1), 2 * kPi * u(bits)).cast<float>();
      if (std::abs(wi.z()) < 0.01f) continue;
      const Vec3d wo_d = wo.cast<double>().normalized(), wi_d = wi.cast<double>().normalized();
      const Rgb expected =
          wi.z() > 0 ? EvaluateBrdf(r, wi_d, wo_d) : EvaluateTransmission(r, wo_d, wi_d);  // reciprocal
      const Rgb got = sampler.Evaluate(wo, wi).f;
      // Coordinates of the half vector err by 1e-7; a lobe 0.02 wide (alpha 0.0225) sees 1e-5 of its width.
      EXPECT_TRUE(((got - expected).abs() <= 3e-4f * expected + 1e-7f).all())
          << Describe(r) << " " << wo.transpose() << " | " << wi.transpose() << ": " << got.transpose()
          << " against " << expected.transpose();
    }
  }
}

TEST(ReflectanceSamplerTest, TransmissionIsReciprocalAndLambertianWithoutACoat) {
  const Reflectance coated = Gltf(0, 0.3f, 0.6f), matte = Matte(0.5f);
  const Vec3d wi = SphericalDirection(0.8, 0.3), wo = SphericalDirection(2.2, 2.9);
  const Rgb there = EvaluateTransmission(coated, wi, wo),
            back =
                EvaluateTransmission(coated, Vec3d(wo.x(), wo.y(), -wo.z()), Vec3d(wi.x(), wi.y(), -wi.z()));
  EXPECT_LT((there - back).abs().maxCoeff(), 1e-6f);
  const Rgb lambert = Rgb(0.3f, 0.6f, 0.9f) * 0.5f / float(kPi);
  EXPECT_LT((EvaluateTransmission(matte, wi, wo) - lambert).abs().maxCoeff(), 1e-6f);
  EXPECT_LT((EvaluateBase(matte, wi, wi) - kColour * 0.5f / float(kPi)).abs().maxCoeff(), 1e-6f);
}

TEST(ReflectanceSamplerTest, SamplesFollowTheirDensity) {
  constexpr int kSamples = 40000;
  const double level = test::SidakLevel(0.01, double(Models().size() * kAngles.size()));
  for (const Reflectance& r : Models()) {
    const ReflectanceSampler sampler(r);
    for (const double theta : kAngles) {
      const Vec3 wo = Eye(theta);
      test::DirectionChiSquare cells(
          [&](const Vec3d& wi) { return double(sampler.Pdf(wo, wi.cast<float>())); });
      std::mt19937_64 bits(17);
      std::uniform_real_distribution<float> u(0, 1);
      for (int i = 0; i < kSamples; ++i) {
        const auto s = sampler.Sample(wo, u(bits), u(bits), u(bits));
        if (s.pdf > 0 && !s.delta) {
          cells.Add(s.wi.cast<double>());
        } else {
          cells.AddNone();
        }
      }
      const auto result = cells.Finish();
      EXPECT_GT(result.p_value, level) << Words(r, theta) << ": chi-square " << result.statistic << " over "
                                       << result.cells << " cells, " << kSamples << " samples";
      // 1 less what gloss loses below the horizon and what an ideal mirror takes.
      // Measured ones have a step at every cell's edge, on which the adaptive integral is off by some 1e-4.
      EXPECT_LE(cells.integral(), 1 + (std::holds_alternative<Measured>(r) ? 1e-3 : 1e-4)) << Words(r, theta);
    }
  }
}

// Where nothing can fall below the horizon the density is whole.
TEST(ReflectanceSamplerTest, DensityIntegratesToOneWithoutLoss) {
  for (const Reflectance& r : {Reflectance(Lambert{kColour}), Reflectance(Matte(0.5f))}) {
    const ReflectanceSampler sampler(r);
    for (const double theta : kAngles) {
      const Vec3 wo = Eye(theta);
      const test::DirectionChiSquare cells(
          [&](const Vec3d& wi) { return double(sampler.Pdf(wo, wi.cast<float>())); });
      EXPECT_NEAR(cells.integral(), 1, 1e-5) << Words(r, theta);
    }
  }
  for (const Reflectance& r :
       {Reflectance(Gltf(1, 0.15f)), Reflectance(Ward{kColour, 0.05f}), Reflectance(Phong{kColour, 200})}) {
    const ReflectanceSampler sampler(r);
    const Vec3 wo = Eye(0.4);
    const test::DirectionChiSquare cells(
        [&](const Vec3d& wi) { return double(sampler.Pdf(wo, wi.cast<float>())); });
    // GGX's tail beyond half vectors at 35 degrees: alpha^2 / tan^2 = 1e-3.
    EXPECT_NEAR(cells.integral(), 1, 1e-3) << Words(r, 0.4);
  }
}

// Directional albedo, both sides and the mirror together, by quadrature in half-vector coordinates.
TEST(ReflectanceSamplerTest, MeanWeightIsTheDirectionalAlbedo) {
  constexpr int kSamples = 40000;
  const std::vector<ModelCase> models = AllModelCases();
  const double tests = double(models.size() * kAngles.size() * 3);
  const double worst_z = test::SidakQuantile(0.01, tests);
  for (const ModelCase& model : models) {
    const Reflectance& r = model.r;
    const ReflectanceSampler sampler(r);
    const auto* gltf = std::get_if<MetallicRoughness>(&r);
    HalfVectorRule smooth = model.Rule();
    smooth.width = 1;
    for (const double theta : kAngles) {
      const Vec3 wo = Eye(theta);
      const Vec3d wo_plane(std::sin(theta), 0, std::cos(theta));
      Eigen::Array3d expected = Eigen::Array3d::Zero();
      // Two widths: base and transmission are smooth whatever the gloss.
      expected += test::IntegrateOutgoing(model.Rule(), wo_plane.z(),
                                          [&](const Vec3d& wi) { return EvaluateGloss(r, wi, wo_plane); });
      expected += test::IntegrateOutgoing(smooth, wo_plane.z(), [&](const Vec3d& wi) -> Rgb {
        const Vec3d below(wi.x(), wi.y(), -wi.z());
        return EvaluateBase(r, wi, wo_plane) + EvaluateTransmission(r, wo_plane, below);
      });
      if (gltf && gltf->roughness < kMirrorRoughness) expected += gltf->Fresnel(wo.z()).cast<double>();

      std::mt19937_64 bits(23);
      std::uniform_real_distribution<float> u(0, 1);
      Eigen::Array3d sum = Eigen::Array3d::Zero(), squares = Eigen::Array3d::Zero();
      for (int i = 0; i < kSamples; ++i) {
        const auto s = sampler.Sample(wo, u(bits), u(bits), u(bits));
        const Eigen::Array3d w = s.weight.cast<double>();
        ASSERT_TRUE(w.isFinite().all() && (w >= 0).all());
        sum += w;
        squares += w * w;
      }
      const Eigen::Array3d mean = sum / kSamples;
      const Eigen::Array3d error = ((squares / kSamples - mean * mean).max(0.0) / kSamples).sqrt();
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(mean[c], expected[c], worst_z * error[c] + 2e-5)
            << Words(r, theta) << ", channel " << c << ", standard error " << error[c];
      }
    }
  }
}

// Importance sampling is worth its name: no weight far above the albedo.
TEST(ReflectanceSamplerTest, WeightsAreBounded) {
  for (const Reflectance& r : Models()) {
    const ReflectanceSampler sampler(r);
    std::mt19937_64 bits(5);
    std::uniform_real_distribution<float> u(0, 1);
    // Phong's loses at grazing; Ward's is 2 cos_i / (cos_i + cos_o); the mixtures' parts are estimates.
    for (const double theta : kAngles) {
      const Vec3 wo = Eye(theta);
      for (int i = 0; i < 5000; ++i) {
        EXPECT_LT(sampler.Sample(wo, u(bits), u(bits), u(bits)).weight.maxCoeff(), 4) << Words(r, theta);
      }
    }
  }
}

TEST(ReflectanceSamplerTest, NothingComesFromBelowTheHorizon) {
  for (const Reflectance& r : Models()) {
    const ReflectanceSampler sampler(r);
    for (const Vec3& wo : {Vec3(0.6f, 0, -0.8f), Vec3(0.6f, 0.8f, 0)}) {
      EXPECT_EQ(sampler.Sample(wo, 0.3f, 0.4f, 0.5f).pdf, 0);
      EXPECT_EQ(sampler.Evaluate(wo, Vec3::UnitZ()).f.maxCoeff(), 0);
    }
  }
}

TEST(ReflectanceSamplerTest, KnowsBlackAndTransparent) {
  EXPECT_TRUE(ReflectanceSampler(Lambert{Rgb::Zero()}).black());
  MetallicRoughness black = Matte(0);
  black.base_color = Rgb::Zero();
  EXPECT_TRUE(ReflectanceSampler(black).black());
  EXPECT_FALSE(ReflectanceSampler(Matte(1)).black());
  EXPECT_TRUE(ReflectanceSampler(Matte(1)).transmits());
  EXPECT_FALSE(ReflectanceSampler(Gltf(1, 0.5f, 1)).transmits()) << "a metal does not";
}

}  // namespace
}  // namespace lobe
