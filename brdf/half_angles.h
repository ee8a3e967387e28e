#pragma once

#include <cmath>

#include <Eigen/Core>

namespace lobe {

template <typename Real>
using Direction = Eigen::Matrix<Real, 3, 1>;  ///< unit, local, away from the surface

/// Where the half vector of two directions above the horizon lies, from their plain sum: neither angle loses
/// digits to a cancelling 1 - cos^2, so that sharp lobes can be told in single precision.
template <typename Real>
struct HalfAngles {
  Real tan2;   ///< of the angle between half vector and normal, squared
  Real cos_d;  ///< cosine between the half vector and either direction

  HalfAngles(const Direction<Real>& wi, const Direction<Real>& wo) {
    const Direction<Real> sum = wi + wo;
    tan2 = (sum.x() * sum.x() + sum.y() * sum.y()) / (sum.z() * sum.z());
    cos_d = Real(0.5) * sum.norm();
  }
  Real cos_h() const { return 1 / std::sqrt(1 + tan2); }
  /// cos^n of the angle to the normal.
  Real CosinePower(Real n) const { return std::exp(Real(-0.5) * n * std::log1p(tan2)); }
};

/// (1 - cos)^5 of Schlick's Fresnel reflectance, "An Inexpensive BRDF Model for Physically-based Rendering",
/// CGF 13(3), 1994, eq. 15.
template <typename Real>
Real SchlickRise(Real cosine) {
  const Real x = std::fmax(Real(0), 1 - cosine), x2 = x * x;
  return x2 * x2 * x;
}

}  // namespace lobe
