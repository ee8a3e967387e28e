#pragma once

#include <memory>
#include <vector>

#include "brdf/rgb.h"

namespace lobe {

/// Plastic: a Lambertian body of `albedo` under a dielectric coat, energy-consistent both ways.
///
/// Gloss: the GGX coat, F of Schlick from the index (f0 = ((n-1)/(n+1))^2, f90 = 1), Smith's V: what glTF's
/// dielectrics have. Its albedo is E(theta); all it does not reflect, T = 1 - E, goes into the body: light
/// that microfacets would scatter twice is counted there, so that none is lost.
/// Base: T(theta_i) T(theta_o) rho / (pi n^2 (1 - rho R_in)). Light is scattered under the coat, meets it
/// from inside, is thrown back by R_in, and so on, a geometric series; the way out has the shape of the way
/// in, times 1/n^2. As etendue is kept, n^2 (1 - R_in) = mean T = 2 int T cos d cos, from which R_in follows.
/// So the base has albedo T rho (1 - R_in) / (1 - rho R_in): with rho = 1 everything is reflected at every
/// angle, exactly, and never more; it is reciprocal. (A smooth interface of the same kind: Mitsuba's
/// plastic.)
class Plastic {
 public:
  /// albedo 0..1; ior at least 1; roughness kMirrorRoughness..1, alpha = roughness^2. Tabulates T, which
  /// takes milliseconds; copies share it.
  Plastic(const Rgb& albedo, float ior, float roughness);
  Plastic() : Plastic(Rgb::Constant(0.5f), 1.5f, 0.3f) {}

  const Rgb& albedo() const { return albedo_; }  ///< of the body, were it bare
  float ior() const { return ior_; }
  float roughness() const { return roughness_; }
  float F0() const;
  /// T, linear between ScalarTable's fine angles.
  float Through(float cos_theta) const;
  float InnerReflectance() const { return inner_reflectance_; }  ///< R_in
  /// rho / (pi n^2 (1 - rho R_in)): the base over T(theta_i) T(theta_o).
  Rgb BaseScale() const;

 private:
  Rgb albedo_;
  float ior_, roughness_, inner_reflectance_;
  std::shared_ptr<const std::vector<float>> through_;
};

}  // namespace lobe
