#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "brdf/reflectance.h"
#include "tests/support/brdf_laws.h"

namespace lobe::test {

inline const Rgb kModelColour(0.8f, 0.5f, 0.2f);

inline MetallicRoughness Gltf(float metallic, float roughness, float transmission = 0) {
  MetallicRoughness m;
  m.base_color = kModelColour;
  m.metallic = metallic;
  m.roughness = roughness;
  m.diffuse_transmission = transmission;
  m.diffuse_transmission_color = Rgb(0.3f, 0.6f, 0.9f);
  return m;
}

inline MetallicRoughness Matte(float transmission) {
  MetallicRoughness m = Gltf(0, 1, transmission);
  m.has_specular = true;
  m.specular = 0;
  return m;
}

inline MetallicRoughness Tinted(float roughness) {  // KHR_materials_specular: base by 1 - max F
  MetallicRoughness m = Gltf(0.2f, roughness, 0.4f);
  m.has_specular = true;
  m.specular = 0.7f;
  m.specular_color = Rgb(1, 0.5f, 0.1f);
  return m;
}

/// Directions with the half vector at theta_h and the difference at (theta_d, phi_d) from it.
inline std::pair<Vec3d, Vec3d> FromHalfDifference(double theta_h, double theta_d, double phi_d) {
  const Eigen::AngleAxisd tilt(theta_h, Vec3d::UnitY());
  return {tilt * SphericalDirection(theta_d, phi_d),
          tilt * SphericalDirection(theta_d, phi_d + std::numbers::pi)};
}

/// Half-difference data taken from a model: `polar` rings whose centres crowd at the peak as MERL's do.
/// Points at which a direction is below the horizon have the value of the ring before.
inline Measured MeasuredFrom(const Reflectance& r, int polar, int other) {
  constexpr float kQuarter = 0.5f * std::numbers::pi_v<float>;
  MeasuredBrdf::Axes axes;
  for (int i = 0; i < polar; ++i) {
    axes[0].push_back(kQuarter * (float(i) + 0.5f) * (float(i) + 0.5f) / float(polar * polar));
  }
  for (int i = 0; i < other; ++i) {
    for (const int a : {1, 2}) axes[a].push_back(kQuarter * (float(i) + 0.5f) / float(other));
  }
  std::vector<float> values(size_t(polar) * other * other * 3, 0.0f);
  const size_t row = size_t(other) * other * 3;
  for (size_t i = 0; i < values.size(); i += 3) {
    const auto [wi, wo] =
        FromHalfDifference(axes[0][i / row], axes[1][i / 3 / other % other], axes[2][i / 3 % other]);
    if (wi.z() > 0 && wo.z() > 0) {
      const Rgb f = EvaluateBrdf(r, wi, wo);
      for (int c = 0; c < 3; ++c) values[i + c] = f[c];
    } else if (i >= row) {
      for (int c = 0; c < 3; ++c) values[i + c] = values[i - row + c];
    }
  }
  return {std::make_shared<const MeasuredBrdf>("of " + Describe(r),
                                               MeasuredBrdf::Coordinates::kHalfDifference, axes, values)};
}

/// The same by angles, `step` degrees apart up to 85: what a goniometer brings home.
inline Measured GoniometerFrom(const Reflectance& r, int step) {
  const auto angles = [&](int most) {
    std::vector<float> out;
    for (int d = 0; d <= most; d += step) out.push_back(float(d) * std::numbers::pi_v<float> / 180);
    return out;
  };
  const auto theta = angles(85), azimuth = angles(180);
  std::vector<float> values;
  for (const float i : theta) {
    for (const float o : theta) {
      for (const float phi : azimuth) {
        const Rgb f = EvaluateBrdf(r, SphericalDirection(i, 0), SphericalDirection(o, phi));
        values.insert(values.end(), f.data(), f.data() + 3);
      }
    }
  }
  return {std::make_shared<const MeasuredBrdf>(
      MeasuredBrdf::FromAngles("angles of " + Describe(r), theta, theta, azimuth, values))};
}

/// The same data under another name.
inline Measured Renamed(const Measured& m, const std::string& name) {
  const MeasuredBrdf& data = *m.data;
  return {std::make_shared<const MeasuredBrdf>(name, data.coordinates(), data.axes(), data.values())};
}

/// A model with what its laws need to know of it.
struct ModelCase {
  Reflectance r;
  double width = 1;                          ///< of its gloss, as HalfVectorRule's
  double albedo_bound = 1;                   ///< what it promises to reflect at most
  bool smooth = true;                        ///< no kinks: the default rule integrates it
  double flux_error = smooth ? 2e-6 : 1e-4;  ///< of its lobe tables
  HalfVectorRule Rule() const {
    if (smooth) return {.width = width};
    return {.width = width, .polar = GaussLegendre(192, 0, 1), .azimuth = GaussLegendre(192, -1, 1)};
  }
};

/// Of every alternative of Reflectance that glTF does not have: rough to sharp, and the ends of its
/// parameters.
inline std::vector<ModelCase> ModelsBeyondGltf() {
  const Rgb white = Rgb::Constant(1), dark = Rgb::Constant(0.04f);
  const auto power_width = [](double n) { return std::min(1.0, std::sqrt(2 / (n + 2))); };
  std::vector<ModelCase> out = {{Lambert{kModelColour}, 1, 0.8}};
  for (const float n : {0.0f, 3.0f, 200.0f}) {
    // Of exponent 0 it is a step, which no smooth rule meets well.
    out.push_back({Phong{kModelColour, n}, std::sqrt(1 / (0.5 + n)), 0.8, n > 0, n > 0 ? 2e-6 : 3e-3});
  }
  for (const float alpha : {0.5f, 0.05f}) out.push_back({Ward{kModelColour, alpha}, alpha, 0.8});
  for (const float n : {0.0f, 1.0f, 30.0f, 1000.0f}) {
    out.push_back({BlinnPhong{n == 30 ? white : kModelColour, n}, power_width(n), n == 30 ? 1 : 0.8});
  }
  for (const float alpha : {0.05f, 0.3f, 1.0f}) {
    out.push_back({CookTorrance{kModelColour, alpha}, alpha, 1, false, 1e-5});
  }
  out.push_back({CookTorrance{white, 0.2f}, 0.2, 1, false, 1e-5});
  out.push_back({CookTorrance{dark, 0.1f}, 0.1, 1, false, 1e-5});
  for (const float sigma : {0.0f, 0.2f, 0.6f, 1.5f}) {
    out.push_back({OrenNayar{kModelColour, sigma}, 1, 0.8 * OrenNayar::kMostAlbedo, false});
  }
  for (const float n : {0.0f, 10.0f, 1000.0f}) {
    out.push_back({AshikhminShirley{kModelColour, dark, n}, power_width(n), 1, false});
    out.push_back({AshikhminShirley{white, Rgb(0.05f, 0.5f, 1), n}, power_width(n), 1, false});
  }
  out.push_back({AshikhminShirley{Rgb::Zero(), kModelColour, 50}, power_width(50), 1, false});
  for (const float roughness : {0.2f, 0.5f, 1.0f}) {
    out.push_back({Plastic{kModelColour, 1.5f, roughness}, roughness * roughness});
    out.push_back({Plastic{white, 1.5f, roughness}, roughness * roughness});
  }
  out.push_back({Plastic{kModelColour, 1.0f, 0.5f}, 0.25});
  out.push_back({Plastic{white, 4.0f, 0.3f}, 0.09});
  // Data promises nothing of its albedo.
  constexpr double kAny = std::numeric_limits<double>::infinity();
  out.push_back({MeasuredFrom(Ward{kModelColour, 0.15f}, 60, 20), 0.15, kAny, false, 1e-3});
  out.push_back({MeasuredFrom(Gltf(0, 0.25f), 60, 20), 0.06, kAny, false, 1e-3});
  out.push_back({GoniometerFrom(Phong{kModelColour, 5}, 5), 0.4, 0.81, false, 1e-3});
  return out;
}

/// Those, and glTF's.
inline std::vector<ModelCase> AllModelCases() {
  std::vector<ModelCase> out = ModelsBeyondGltf();
  for (const float roughness : {1.0f, 0.5f, 0.15f})
    out.push_back({Gltf(1, roughness), roughness * roughness});
  // The coat keeps glTF's surplus at grazing angles.
  for (const MetallicRoughness& m : {Gltf(0, 0.7f), Gltf(0, 0.2f), Gltf(0.5f, 0.4f), Gltf(0, 0.3f, 0.6f),
                                     Matte(0), Matte(0.5f), Tinted(0.4f)}) {
    out.push_back({m, m.roughness * m.roughness, 1.9});
  }
  // Ideal mirrors over their base.
  out.push_back({Gltf(0, 0), 1, 1.9});
  out.push_back({Gltf(0, 0, 0.5f), 1, 1.9});
  return out;
}

}  // namespace lobe::test
