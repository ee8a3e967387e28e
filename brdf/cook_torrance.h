#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "brdf/half_angles.h"
#include "brdf/rgb.h"

namespace lobe {

/// Cook and Torrance, "A Reflectance Model for Computer Graphics", ACM TOG 1(1), 1982: f_r = F D G / (4 cos_i
/// cos_o), all gloss, with
/// - D of Beckmann, exp(-tan^2 theta_h / alpha^2) / (pi alpha^2 cos^4 theta_h): the paper's, with the factor
///   that makes the integral of D cos 1, so that 4 stands where the paper has pi;
/// - G of V-shaped grooves, as in the paper: min(1, 2 cos_h cos_o / cos_d, 2 cos_h cos_i / cos_d);
/// - F of Schlick, f0 + (1 - f0)(1 - cos_d)^5, in place of the paper's tabulated metals: it shares lobe
///   tables between colours.
/// G is at most the masking that makes visible grooves fill the projected area, so the albedo is at most 1.
struct CookTorrance {
  Rgb f0 = Rgb::Constant(0.5f);  ///< reflectance of the facets at normal incidence
  float alpha = 0.2f;            ///< root mean square slope of the facets, the paper's m

  template <typename Real>
  static Real BeckmannD(const HalfAngles<Real>& h, Real alpha) {
    const Real a2 = alpha * alpha, sec2 = 1 + h.tan2;
    return std::exp(-h.tan2 / a2) * sec2 * sec2 / (std::numbers::pi_v<Real> * a2);
  }
  /// f_r over F.
  template <typename Real>
  static Real White(const HalfAngles<Real>& h, Real cos_i, Real cos_o, Real alpha) {
    const Real groove = 2 * h.cos_h() * std::min(cos_i, cos_o) / h.cos_d;
    return BeckmannD(h, alpha) * std::min(Real(1), groove) / (4 * cos_i * cos_o);
  }
  /// Where G has kinks (brdf/hemisphere_integral.h): 2 cos_h cos_o = cos_d is cos(3 theta_h - delta) = 0, 2
  /// cos_h cos_i = cos_d is cos(theta_h + delta) = 0, and between grooves that hide and that shade cos_i =
  /// cos_o.
  static std::array<double, 2> Kinks(double delta) {
    constexpr double kRightAngle = std::numbers::pi / 2;
    if (delta > kRightAngle / 2) return {kRightAngle - delta, delta};
    const double hiding = (kRightAngle + delta) / 3;
    return {hiding, kRightAngle};
  }
};

}  // namespace lobe
