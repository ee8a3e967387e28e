#include "brdf/microfacet.h"

#include <cmath>
#include <numbers>

namespace lobe {

double GgxD(double cos_h, double alpha) {
  if (cos_h <= 0) return 0;
  const double a2 = alpha * alpha;
  // sin^2 + a^2 cos^2, rather than cos^2 (a^2 - 1) + 1, which cancels for small alpha.
  const double s = (1.0 - cos_h) * (1.0 + cos_h) + a2 * cos_h * cos_h;
  return a2 / (std::numbers::pi * s * s);
}

double GgxV(double cos_i, double cos_o, double alpha) {
  if (cos_i <= 0 || cos_o <= 0) return 0;
  const double a2 = alpha * alpha;
  const double shadowed = cos_i * std::sqrt(a2 + (1.0 - a2) * cos_o * cos_o);
  const double masked = cos_o * std::sqrt(a2 + (1.0 - a2) * cos_i * cos_i);
  return 0.5 / (shadowed + masked);
}

}  // namespace lobe
