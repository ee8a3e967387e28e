#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brdf/half_angles.h"
#include "brdf/rgb.h"

namespace lobe {

/// Oren and Nayar, "Generalization of Lambert's Reflectance Model", SIGGRAPH 1994, the *qualitative* model,
/// eq. 30: f_r = albedo / pi (A + B max(0, cos(phi_i - phi_o)) sin max(theta) tan min(theta)). All base.
/// At grazing incidence it reflects albedo (A + B/2), its most: more than `albedo` for sigma under 0.33, by
/// at most 1.52 % (sigma 0.2). The full model, with its interreflections, is not here.
struct OrenNayar {
  Rgb albedo = Rgb::Constant(0.5f);
  float sigma = 0.35f;  ///< standard deviation of the facets' angles, radians; 0 is Lambert

  template <typename Real>
  static Real A(Real sigma) {
    const Real s2 = sigma * sigma;
    return 1 - s2 / (2 * (s2 + Real(0.33)));
  }
  template <typename Real>
  static Real B(Real sigma) {
    const Real s2 = sigma * sigma;
    return Real(0.45) * s2 / (s2 + Real(0.09));
  }
  /// f_r of albedo 1, from A and B. sin_i sin_o cos(phi) is the dot product of the horizontal parts, and
  /// tan min over sin min is 1 / max(cos).
  template <typename Real>
  static Real White(const Direction<Real>& wi, const Direction<Real>& wo, Real a, Real b) {
    const Real along = std::max(Real(0), wi.x() * wo.x() + wi.y() * wo.y());
    return (a + b * along / std::max(wi.z(), wo.z())) * std::numbers::inv_pi_v<Real>;
  }
  /// The integral of that over cos: for theta_o below theta_i and above it, int sin^2 and int sin^2 cos.
  static double WhiteAlbedo(double cos_i, double a, double b) {
    const double t = std::acos(cos_i), s = std::sin(t), c = std::max(cos_i, 1e-9);
    return a + 2 * b / std::numbers::pi * (s * (t - s * c) / 2 + s / c * (1 - s * s * s) / 3);
  }
  /// Most of the light, relative to `albedo`, that is reflected at any angle.
  static constexpr double kMostAlbedo = 1.0152;
};

}  // namespace lobe
