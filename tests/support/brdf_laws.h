#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include "brdf/reflectance.h"
#include "sh/quadrature.h"

namespace lobe {

inline Rgb EvaluateBrdf(const Reflectance& r, const Vec3d& wi, const Vec3d& wo) {
  return EvaluateBase(r, wi, wo) + EvaluateGloss(r, wi, wo);
}

inline Vec3d SphericalDirection(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Integral of f cos(theta_o) d omega_o by plain brute force in spherical coordinates: shares nothing with
/// brdf/hemisphere_integral.h. `n` polar points see lobes wider than a few times pi / (2 n).
template <typename F>
Eigen::Array3d SlowAlbedo(const F& f, double theta_i, int n = 200) {
  const Vec3d wi = SphericalDirection(theta_i, 0);
  const GaussLegendre polar(n, 0, 0.5 * std::numbers::pi);
  const GaussLegendre azimuth(2 * n, 0, std::numbers::pi);  // f is even in phi
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int i = 0; i < n; ++i) {
    const double theta = polar.nodes[i];
    for (int j = 0; j < 2 * n; ++j) {
      const Rgb value = f(wi, SphericalDirection(theta, azimuth.nodes[j]));
      sum += value.cast<double>() *
             (2.0 * polar.weights[i] * azimuth.weights[j] * std::sin(theta) * std::cos(theta));
    }
  }
  return sum;
}

/// The other end of a way through a sheet, told in the frame of the other side.
inline Vec3d ThroughTheSheet(const Vec3d& w) { return {w.x(), w.y(), -w.z()}; }

/// What every translucent model promises beside ExpectBrdfLaws. `albedo_bound`: most that leaves it, on both
/// sides together, at any angle and in any channel.
inline void ExpectTransmissionLaws(const Reflectance& r, double albedo_bound = 1.0) {
  SCOPED_TRACE(Describe(r));
  const Vec3d directions[] = {SphericalDirection(0.31, 0.7), SphericalDirection(0.83, 2.9),
                              SphericalDirection(1.12, -1.3), SphericalDirection(1.41, 4.4),
                              SphericalDirection(1.55, 5.9)};
  constexpr float kRounding = 4e-6f;
  EXPECT_TRUE(Transmits(r));
  for (const Vec3d& wi : directions) {
    for (const Vec3d& other : directions) {
      const Vec3d wo = ThroughTheSheet(other);
      const Rgb f = EvaluateTransmission(r, wi, wo);
      ASSERT_TRUE(f.isFinite().all());
      EXPECT_TRUE((f >= 0).all()) << "negative: " << f.transpose();

      const Rgb back = EvaluateTransmission(r, ThroughTheSheet(wo), ThroughTheSheet(wi));
      EXPECT_TRUE(((f - back).abs() <= kRounding * f).all())
          << "not reciprocal: " << f.transpose() << " against " << back.transpose();

      const Eigen::AngleAxisd turn(1.234, Vec3d::UnitZ());
      const Rgb turned = EvaluateTransmission(r, turn * wi, turn * wo);
      EXPECT_TRUE(((f - turned).abs() <= kRounding * f).all())
          << "not isotropic: " << f.transpose() << " against " << turned.transpose();

      EXPECT_TRUE((EvaluateTransmission(r, wi, other) == 0).all()) << "that is reflection";
      EXPECT_TRUE((EvaluateTransmission(r, wo, wo) == 0).all());
      EXPECT_TRUE((EvaluateTransmission(r, wo, wi) == 0).all()) << "wi has to be above";
    }
    const Vec3d level(0.6, 0.8, 0);
    EXPECT_TRUE((EvaluateTransmission(r, wi, level) == 0).all());
    EXPECT_TRUE((EvaluateTransmission(r, level, ThroughTheSheet(wi)) == 0).all());
  }
  for (const double theta : {0.02, 0.4, 0.9, 1.2, 1.4, 1.52}) {
    const auto albedo = SlowAlbedo(
        [&](const Vec3d& wi, const Vec3d& wo) -> Rgb {
          return EvaluateBrdf(r, wi, wo) + EvaluateTransmission(r, wi, ThroughTheSheet(wo));
        },
        theta);
    EXPECT_LE(albedo.maxCoeff(), albedo_bound + 1e-3) << "at theta " << theta;
  }
}

/// What every reflectance model promises, ours and the next contributor's. `albedo_bound`: most it
/// reflects at any angle, in any channel; 1 unless the model's documentation says otherwise.
inline void ExpectBrdfLaws(const Reflectance& r, double albedo_bound = 1.0) {
  SCOPED_TRACE(Describe(r));
  // Generic directions: no axes, no planes of symmetry, towards grazing too.
  const Vec3d directions[] = {SphericalDirection(0.31, 0.7), SphericalDirection(0.83, 2.9),
                              SphericalDirection(1.12, -1.3), SphericalDirection(1.41, 4.4),
                              SphericalDirection(1.55, 5.9)};
  // f is stored in float: relative differences of a few roundings.
  constexpr float kRounding = 4e-6f;
  for (const Vec3d& wi : directions) {
    for (const Vec3d& wo : directions) {
      const Rgb f = EvaluateBrdf(r, wi, wo);
      ASSERT_TRUE(f.isFinite().all());
      EXPECT_TRUE((f >= 0).all()) << "negative: " << f.transpose();

      const Rgb swapped = EvaluateBrdf(r, wo, wi);
      EXPECT_TRUE(((f - swapped).abs() <= kRounding * f).all())
          << "not reciprocal: " << f.transpose() << " against " << swapped.transpose();

      const Eigen::AngleAxisd turn(1.234, Vec3d::UnitZ());
      const Rgb turned = EvaluateBrdf(r, turn * wi, turn * wo);
      EXPECT_TRUE(((f - turned).abs() <= kRounding * f).all())
          << "not isotropic: " << f.transpose() << " against " << turned.transpose();

      const Vec3d below(wo.x(), wo.y(), -wo.z());
      EXPECT_TRUE((EvaluateBrdf(r, wi, below) == 0).all());
      EXPECT_TRUE((EvaluateBrdf(r, below, wi) == 0).all());
    }
    const Vec3d level(0.6, 0.8, 0);
    EXPECT_TRUE((EvaluateBrdf(r, wi, level) == 0).all());
    EXPECT_TRUE((EvaluateBrdf(r, level, wi) == 0).all());
  }
  for (double theta : {0.02, 0.4, 0.9, 1.2, 1.4, 1.52}) {
    const auto albedo =
        SlowAlbedo([&](const Vec3d& wi, const Vec3d& wo) { return EvaluateBrdf(r, wi, wo); }, theta);
    // 1e-3: brute force at the sharpest lobes the tests use (alpha 0.04).
    EXPECT_LE(albedo.maxCoeff(), albedo_bound + 1e-3) << "at theta " << theta;
  }
}

}  // namespace lobe
