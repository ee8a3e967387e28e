#pragma once

#include <functional>

#include "sh/vector.h"

namespace lobe {

/// Integration over outgoing directions in half-vector coordinates, where glossy lobes are smooth
/// whatever their sharpness. For incident direction wi = (sin, 0, cos) and each azimuth of the half
/// vector the polar angles that keep wo above the horizon form one interval, in closed form, so
/// Gauss-Legendre never crosses a discontinuity. (Uniform points miss sharp lobes altogether: DESIGN 3.)
struct HalfVectorRule {
  /// Width of the distribution of half vectors, as GGX's alpha; points crowd within a few of it.
  double width = 1;
  /// Defaults give the albedo of GGX to 1e-8 for every roughness and angle (docs/validation.md#flux).
  int polar_points = 40;
  int azimuth_points = 64;  ///< over half a turn: the integrand is even in azimuth

  /// Calls visit(wo, weight) for points covering phi_o in both halves by symmetry: integral of g(wo)
  /// d omega_o = sum weight g(wo) for g even in y. No cosine in the weight.
  void ForEach(double cos_theta_i, const std::function<void(const Vec3d& wo, double weight)>& visit) const;
};

}  // namespace lobe
