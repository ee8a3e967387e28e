#include <cmath>
#include <cstdio>
#include <vector>

#include "bench/brdf_figures.h"
#include "brdf/lobe_accuracy.h"
#include "sh/hemisphere_basis.h"
#include "sh/zernike.h"

namespace lobe {
namespace {

/// Damps degrees n > 0 as heat flow on the disc's basis does. Degree 0 alone holds the flux, so it is kept,
/// whatever the strength.
Eigen::VectorXd Damped(const Eigen::VectorXd& zernike, int l_max, double strength) {
  Eigen::VectorXd out = zernike.head(CoefficientCount(l_max));
  for (int n = 1; n <= l_max; ++n) {
    const int begin = CoefficientCount(n - 1);
    out.segment(begin, n + 1) *= std::exp(-strength * n * (n + 1));
  }
  return out;
}

struct Deringed {
  double error = 0, negative = 0;
};

/// The weakest damping whose negative flux is at most `bound` of the flux; none where none is needed.
Deringed Dering(const ExactLobe& exact, const ZernikeTransform& transform, double bound) {
  const int l_max = transform.l_max();
  const auto judge = [&](double strength) {
    const Eigen::VectorXd z = Damped(exact.zernike, l_max, strength);
    const double off2 = exact.norm2 - exact.zernike.head(z.size()).squaredNorm() +
                        (z - exact.zernike.head(z.size())).squaredNorm();
    return Deringed{std::sqrt(std::max(0.0, off2) / exact.norm2),
                    NegativeFlux(transform.ToHemisphere(z)) / exact.albedo};
  };
  Deringed out = judge(0);
  if (out.negative <= bound) return out;
  double low = 0, high = 1;  // a constant is left at 1
  for (int step = 0; step < 16; ++step) {
    const double middle = 0.5 * (low + high);
    const Deringed there = judge(middle);
    if (there.negative <= bound) {
      high = middle;
      out = there;
    } else {
      low = middle;
    }
  }
  return out;
}

}  // namespace

void DeringFigures() {
  constexpr int kAngles = 16;
  const double bounds[] = {1e9, 0.1, 0.05, 0.02, 0.001};
  std::printf(
      "| GGX, F = 1, roughness | l_max | none | 10 %% | 5 %% | 2 %% | 0.1 %% "
      "|\n|---|---|---|---|---|---|---|\n");
  for (const float roughness : {0.5f, 0.4f, 0.3f, 0.2f}) {
    MetallicRoughness r;
    r.roughness = roughness;
    const GaussLegendre t(kAngles, 0, 1);
    std::vector<ExactLobe> exact;
    for (const double node : t.nodes) {
      exact.push_back(ProjectExactly(r, BrdfPart::kGloss, IncidenceSpline::CosineOfParameter(node), 20));
    }
    for (const int l_max : {8, 12, 20}) {
      const ZernikeTransform transform(l_max);
      std::printf("| %.1f | %d |", roughness, l_max);
      for (const double bound : bounds) {
        Deringed mean;
        double weights = 0;
        for (int i = 0; i < kAngles; ++i) {
          const double c = IncidenceSpline::CosineOfParameter(t.nodes[i]);
          const double w = t.weights[i] * exact[i].albedo * c * (1 - t.nodes[i] * t.nodes[i]) * t.nodes[i];
          const Deringed at = Dering(exact[i], transform, bound);
          mean.error += w * at.error;
          mean.negative += w * at.negative;
          weights += w;
        }
        std::printf(" %.1f / %.1f %% |", 100 * mean.error / weights, 100 * mean.negative / weights);
      }
      std::printf("\n");
    }
  }
}

}  // namespace lobe
