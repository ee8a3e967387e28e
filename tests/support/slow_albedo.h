#pragma once

#include <cmath>
#include <functional>
#include <numbers>

#include "sh/vector.h"

namespace lobe::test {

/// Directional albedo the plain way, sharing no code with brdf/: midpoints in (u, phi) of half vectors
/// distributed as GGX's, tan^2 theta_h = width^2 u / (1 - u), over the full circle; directions below the
/// horizon are skipped. The integrand falls to zero at the horizon, so the error falls as 1 / n^2.
inline double SlowAlbedo(const std::function<double(const Vec3d&, const Vec3d&)>& f, double cos_theta_i,
                         double width, int n_u = 1500, int n_phi = 400) {
  const double ci = cos_theta_i, si = std::sqrt(1.0 - ci * ci);
  const Vec3d wi(si, 0, ci);
  double sum = 0;
  for (int i = 0; i < n_u; ++i) {
    // Even steps in v, u = 3 v^2 - 2 v^3: finer at the peak and in the tail.
    const double v = (i + 0.5) / n_u, u = v * v * (3 - 2 * v), du = 6 * v * (1 - v) / n_u;
    const double t2 = width * width * u / (1 - u);
    const double cos_h = 1 / std::sqrt(1 + t2), sin_h = std::sqrt(std::max(0.0, 1 - cos_h * cos_h));
    // d omega_h = |d cos_h| d phi, cos_h = ((1 - u) / (1 - u (1 - width^2)))^(1/2).
    const double q = 1 - u * (1 - width * width);
    const double dcos = 0.5 / cos_h * width * width / (q * q) * du;
    for (int j = 0; j < n_phi; ++j) {
      const double phi = 2 * std::numbers::pi * (j + 0.5) / n_phi;
      const Vec3d h(sin_h * std::cos(phi), sin_h * std::sin(phi), cos_h);
      const double d = wi.dot(h);
      const Vec3d wo = 2 * d * h - wi;
      if (d <= 0 || wo.z() <= 0) continue;
      sum += f(wi, wo.normalized()) * wo.z() * 4 * d * dcos * 2 * std::numbers::pi / n_phi;
    }
  }
  return sum;
}

}  // namespace lobe::test
