#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "brdf/half_angles.h"
#include "brdf/rgb.h"

namespace lobe {

/// Ashikhmin and Shirley, "An Anisotropic Phong BRDF Model", JGT 5(2), 2000, isotropic (n_u = n_v = n).
/// Gloss, eq. 4: (n+1) / 8 pi cos^n theta_h / (cos_d max(cos_i, cos_o)) F, F = Schlick from `specular`.
/// Base, eq. 5: 28 diffuse / 23 pi (1 - specular) (1 - (1 - cos_i/2)^5) (1 - (1 - cos_o/2)^5), whose albedo
/// is exactly diffuse (1 - specular) (1 - (1 - cos_i/2)^5): it takes what the gloss leaves. Sum at most 1.
struct AshikhminShirley {
  Rgb diffuse = Rgb::Constant(0.5f);    ///< R_d
  Rgb specular = Rgb::Constant(0.05f);  ///< R_s, at normal incidence
  float exponent = 100;

  template <typename Real>
  static Real BaseFactor(Real cosine) {
    return 1 - SchlickRise(cosine / 2);
  }
  /// Base over diffuse (1 - specular).
  template <typename Real>
  static Real WhiteBase(Real cos_i, Real cos_o) {
    return Real(28.0 / 23) * std::numbers::inv_pi_v<Real> * BaseFactor(cos_i) * BaseFactor(cos_o);
  }
  /// Gloss over F.
  template <typename Real>
  static Real WhiteGloss(const HalfAngles<Real>& h, Real cos_i, Real cos_o, Real n) {
    return (n + 1) / (8 * std::numbers::pi_v<Real>)*h.CosinePower(n) / (h.cos_d * std::max(cos_i, cos_o));
  }
  /// Where it has kinks (brdf/hemisphere_integral.h): cos_i = cos_o.
  static std::array<double, 2> Kinks(double delta) { return {delta, std::numbers::pi / 2}; }
};

}  // namespace lobe
