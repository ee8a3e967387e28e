#include "brdf/hemisphere_integral.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {

OutgoingPoints HalfVectorRule::Points(double cos_theta_i) const {
  OutgoingPoints out;
  for (auto* list : {&out.x, &out.y, &out.z, &out.weight})
    list->reserve(azimuth.nodes.size() * polar.nodes.size());
  // At grazing incidence proper the interval below degenerates; this near, nothing is lost in double.
  const double ci = std::clamp(cos_theta_i, 1e-7, 1.0);
  const double si = std::sqrt(1.0 - ci * ci);

  // phi_h = pi/2 - psi. Near grazing the horizon's cut swings over within psi ~ cot(theta_i), hence sinh.
  const double half_turn = 0.5 * std::numbers::pi;
  const double swing = std::clamp(ci / std::max(si, 1e-9), 1e-6, 2.0);
  const double y_max = std::asinh(half_turn / swing);
  for (size_t i = 0; i < azimuth.nodes.size(); ++i) {
    const double y = y_max * azimuth.nodes[i];
    const double psi = swing * std::sinh(y);
    const double azimuth_weight = 2.0 * azimuth.weights[i] * y_max * swing * std::cosh(y);
    const double cos_phi = std::sin(psi), sin_phi = std::cos(psi);

    // wo.z = 2 (wi.h) h.z - wi.z = R cos(2 theta_h - delta), tan delta = tan theta_i cos phi_h: above the
    // horizon for theta_h < pi/4 + delta/2.
    const double delta = std::atan2(si * cos_phi, ci);
    double theta_max = 0.25 * std::numbers::pi + 0.5 * delta;
    if (half_around_mirror) {
      // With a^2 = (wi's length in this azimuth's plane)^2, wo.mirror = a^2 (cos 2 theta_h + cos 2 delta) -
      // cos 2 theta_i, which falls with theta_h.
      const double a2 = ci * ci + si * si * cos_phi * cos_phi;
      const double cosine = (ci * ci - si * si) / a2 - std::cos(2.0 * delta);
      theta_max = std::min(theta_max, 0.5 * std::acos(std::clamp(cosine, -1.0, 1.0)));
    }
    const double x_max = std::asinh(theta_max / width);
    // theta_h = width sinh(x): even steps across the peak, even ratios along the tail. Towards wo's horizon,
    // where at grazing incidence masking varies within cos_o ~ cos_i, steps shrink as a cube.
    std::array<double, 4> v_end{1.0};  // v is 1 at the normal, 0 at the horizon
    int intervals = 1;
    for (const double kink : kinks ? kinks(delta) : std::array<double, 2>{}) {
      if (kink > 0 && kink < theta_max)
        v_end[intervals++] = std::cbrt(1.0 - std::asinh(kink / width) / x_max);
    }
    v_end[intervals] = 0.0;
    for (int interval = 0; interval < intervals; ++interval) {
      const double length = v_end[interval] - v_end[interval + 1];
      for (size_t j = 0; j < polar.nodes.size(); ++j) {
        const double v = v_end[interval] - length * polar.nodes[j];
        const double e = std::exp(x_max * (1.0 - v * v * v));
        const double theta = 0.5 * width * (e - 1.0 / e), theta_by_x = 0.5 * width * (e + 1.0 / e);
        const double sin_h = std::sin(theta), cos_h = std::cos(theta);
        const double wi_h = si * sin_h * cos_phi + ci * cos_h;
        const double wo_z = 2.0 * wi_h * cos_h - ci;
        if (wo_z <= 0.0 || wi_h <= 0.0) continue;  // rounding at the end of the interval
        out.x.push_back(2.0 * wi_h * sin_h * cos_phi - si);
        out.y.push_back(2.0 * wi_h * sin_h * sin_phi);
        out.z.push_back(wo_z);
        out.weight.push_back(azimuth_weight * polar.weights[j] * length * 3.0 * v * v * x_max * theta_by_x *
                             sin_h * 4.0 * wi_h);  // d omega_o = 4 (wi.h) d omega_h
      }
    }
  }
  return out;
}

}  // namespace lobe
