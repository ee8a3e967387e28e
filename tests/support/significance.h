#pragma once

#include <cmath>

#include <boost/math/distributions/normal.hpp>

namespace lobe::test {

/// Significance of each of `tests` independent tests such that together they cry wolf with chance `family`
/// (Sidak, "Rectangular Confidence Regions", JASA 62, 1967).
inline double SidakLevel(double family, double tests) { return -std::expm1(std::log1p(-family) / tests); }

/// Standard deviations that a normal variable may be off, either way, at that level.
inline double SidakQuantile(double family, double tests) {
  return boost::math::quantile(
      boost::math::complement(boost::math::normal(), 0.5 * SidakLevel(family, tests)));
}

}  // namespace lobe::test
