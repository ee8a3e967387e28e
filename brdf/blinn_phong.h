#pragma once

#include <cmath>
#include <numbers>

#include "brdf/half_angles.h"
#include "brdf/rgb.h"

namespace lobe {

/// Normalised Blinn-Phong: f_r = albedo (n+2)(n+4) / (8 pi (2^(-n/2) + n)) cos^n theta_h. All gloss.
/// Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977; the factor is the
/// exact integral at normal incidence (Giesen, "Phong and Blinn-Phong Normalization Factors", 2009), so that
/// `albedo` is reflected there, and less elsewhere. Reciprocal, since it knows the half vector alone.
/// n = 0 is Lambert.
struct BlinnPhong {
  Rgb albedo = Rgb::Constant(0.5f);
  float exponent = 20;

  template <typename Real>
  static Real Factor(Real n) {
    return (n + 2) * (n + 4) / (8 * std::numbers::pi_v<Real> * (std::exp2(-n / 2) + n));
  }
  /// f_r of albedo 1.
  template <typename Real>
  static Real White(const HalfAngles<Real>& h, Real n) {
    return Factor(n) * h.CosinePower(n);
  }
};

}  // namespace lobe
