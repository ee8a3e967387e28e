#pragma once

#include <array>
#include <vector>

#include "sh/quadrature.h"

namespace lobe {

/// Points of an integral over outgoing directions: unit vectors (x, y, z), z > 0, and weights in steradians.
struct OutgoingPoints {
  std::vector<double> x, y, z, weight;
  int size() const { return int(weight.size()); }
};

/// Polar angles of the half vector, ascending, at which an integrand has kinks within one azimuth of it;
/// those outside (0, theta_max) do not count. The projection of wi into that azimuth's plane is `delta` from
/// the normal; there cos_i : cos_o : cos_d = cos(delta) : cos(2 theta_h - delta) : cos(theta_h - delta).
using KinkAngles = std::array<double, 2> (*)(double delta);

/// Integration over outgoing directions in half-vector coordinates, where glossy lobes are smooth
/// whatever their sharpness. For incident direction wi = (sin, 0, cos) and each azimuth of the half
/// vector the polar angles that keep wo above the horizon form one interval, in closed form, so
/// Gauss-Legendre never crosses a discontinuity. (Uniform points miss sharp lobes altogether: DESIGN 3.)
struct HalfVectorRule {
  /// Width of the distribution of half vectors, as GGX's alpha; points crowd within a few of it.
  double width = 1;
  /// The integrand ends, perhaps with a jump, where wo is 90 degrees from the mirror direction, as Phong's
  /// does for exponents near 0.
  bool half_around_mirror = false;
  /// No interval of Gauss-Legendre spans one of these; each takes all the points of `polar`.
  KinkAngles kinks = nullptr;
  /// Defaults give the albedo of GGX to 1e-8 for every roughness and angle (docs/validation.md#flux).
  GaussLegendre polar{40, 0.0, 1.0};
  GaussLegendre azimuth{64, -1.0, 1.0};  ///< over half a turn: the integrand is even in azimuth

  /// Points covering phi_o in both halves by symmetry: integral of g(wo) d omega_o = sum weight g(wo) for g
  /// even in y. No cosine in the weight.
  OutgoingPoints Points(double cos_theta_i) const;
};

}  // namespace lobe
