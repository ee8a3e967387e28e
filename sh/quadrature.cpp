#include "sh/quadrature.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lobe {

GaussLegendre::GaussLegendre(int n, double a, double b) : nodes(n), weights(n) {
  if (n < 1) throw std::invalid_argument("GaussLegendre: at least one point is needed");
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  for (int i = 0; i < (n + 1) / 2; ++i) {
    // Tricomi's estimate of the i-th root (Abramowitz and Stegun 22.16.6 with its first correction).
    const double phi = std::numbers::pi * (4.0 * i + 3.0) / (4.0 * n + 2.0);
    double x = (1.0 - (n - 1.0) / (8.0 * double(n) * n * n)) * std::cos(phi);
    double derivative = 1;
    for (int step = 0; step < 20; ++step) {
      double p = 1, before = 0;
      for (int k = 1; k <= n; ++k) {
        const double next = ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k;
        before = p;
        p = next;
      }
      derivative = n * (x * p - before) / (x * x - 1.0);
      const double change = p / derivative;
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    // The loop leaves P_n' of the last but one x; that is within rounding of the root.
    const double weight = 2.0 / ((1.0 - x * x) * derivative * derivative);
    nodes[i] = middle - half * x;
    nodes[n - 1 - i] = middle + half * x;
    weights[i] = weights[n - 1 - i] = half * weight;
  }
  if (n % 2 == 1) nodes[n / 2] = middle;
}

HemisphereQuadrature::HemisphereQuadrature(int l_max) {
  const GaussLegendre polar(l_max + 1, 0.0, 1.0);
  const int azimuths = 2 * l_max + 1;
  const double step = 2.0 * std::numbers::pi / azimuths;
  for (int i = 0; i <= l_max; ++i) {
    const double z = polar.nodes[i], s = std::sqrt(1.0 - z * z);
    for (int j = 0; j < azimuths; ++j) {
      directions.emplace_back(s * std::cos(j * step), s * std::sin(j * step), z);
      weights.push_back(polar.weights[i] * step);
    }
  }
}

}  // namespace lobe
