#include "brdf/plastic.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brdf/lobe_table.h"
#include "brdf/microfacet.h"

namespace lobe {
namespace {

// 2 int T cos d cos of values linear between the fine angles: polynomials of degree 7 in t in each interval,
// so four points are exact and "white reflects everything" holds to rounding.
double CosineMean(const std::vector<float>& through) {
  const GaussLegendre rule(4, 0, 1);
  double sum = 0;
  for (int i = 0; i < ScalarTable::kFine; ++i) {
    for (size_t k = 0; k < rule.nodes.size(); ++k) {
      const double u = rule.nodes[k], t = (i + u) / ScalarTable::kFine, c = 1 - t * t;
      // cos = c^2, |d cos| = 4 t c dt.
      sum += rule.weights[k] * ((1 - u) * through[i] + u * through[i + 1]) * c * c * 4 * t * c;
    }
  }
  return 2 * sum / ScalarTable::kFine;
}

}  // namespace

Plastic::Plastic(const Rgb& albedo, float ior, float roughness)
    : albedo_(albedo), ior_(ior), roughness_(roughness) {
  const double alpha = double(roughness) * roughness;
  const auto coat = SchlickTables::Build(
      [alpha](const Vec3d& wi, const Vec3d& wo) {
        return GgxD((wi + wo).normalized().z(), alpha) * GgxV(wi.z(), wo.z(), alpha);
      },
      0, HalfVectorRule{.width = alpha}, IncidenceSpline::kFewestKnots);
  const Eigen::VectorXd reflected = coat.Mix(F0(), 1 - F0()).albedo;
  std::vector<float> through;
  for (const double e : reflected) through.push_back(float(std::clamp(1 - e, 0.0, 1.0)));
  inner_reflectance_ = float(1 - CosineMean(through) / (double(ior) * ior));
  through_ = std::make_shared<const std::vector<float>>(std::move(through));
}

float Plastic::F0() const {
  const float r = (ior_ - 1) / (ior_ + 1);
  return r * r;
}

float Plastic::Through(float cos_theta) const { return FineAngle(cos_theta).Read(*through_); }

Rgb Plastic::BaseScale() const {
  return albedo_ / (std::numbers::pi_v<float> * ior_ * ior_ * (1 - albedo_ * inner_reflectance_));
}

}  // namespace lobe
