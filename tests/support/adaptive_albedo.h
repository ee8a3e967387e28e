#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "sh/vector.h"

namespace lobe::test {

/// Directional albedo by Boost's adaptive Gauss-Kronrod in the outgoing direction's own polar coordinates:
/// shares neither code nor coordinates with brdf/. Intervals are cut around the mirror direction at
/// multiples of `width`, so that a sharp lobe cannot be missed. Good to about 1e-7.
inline double AdaptiveAlbedo(const std::function<double(const Vec3d&, const Vec3d&)>& f, double cos_theta_i,
                             double width) {
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  constexpr double kTolerance = 1e-6;  // models evaluated in float are noisy at 1e-7
  constexpr int kDepth = 5;
  const double theta_i = std::acos(cos_theta_i);
  const Vec3d wi(std::sin(theta_i), 0, cos_theta_i);
  const auto cuts = [width](double low, double high, double peak) {
    std::vector<double> out = {low, high, std::clamp(peak, low, high)};
    for (const double d : {width, 6 * width, 40 * width}) {
      out.push_back(std::clamp(peak - d, low, high));
      out.push_back(std::clamp(peak + d, low, high));
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  };
  const auto azimuth_cuts = cuts(0, std::numbers::pi, std::numbers::pi);
  const auto polar_cuts = cuts(0, 0.5 * std::numbers::pi, theta_i);
  const auto over_azimuth = [&](double theta) {
    const double s = std::sin(theta), c = std::cos(theta);
    double sum = 0;
    for (size_t i = 0; i + 1 < azimuth_cuts.size(); ++i) {
      sum +=
          Rule::integrate([&](double phi) { return f(wi, Vec3d(s * std::cos(phi), s * std::sin(phi), c)); },
                          azimuth_cuts[i], azimuth_cuts[i + 1], kDepth, kTolerance);
    }
    return 2 * sum * s * c;
  };
  double sum = 0;
  for (size_t i = 0; i + 1 < polar_cuts.size(); ++i) {
    sum += Rule::integrate(over_azimuth, polar_cuts[i], polar_cuts[i + 1], kDepth, kTolerance);
  }
  return sum;
}

}  // namespace lobe::test
