// What a degree costs and buys: a glossy lobe, the light that a rough metal sends on when lit from one
// direction, is projected into the hemisphere basis at growing l_max. The error falls; the flux is right from
// l_max 0 on, because the projection is the least-squares fit weighted by the cosine
// (docs/conventions.md#projection).
//
//     02_project_a_lobe [ROUGHNESS [INCIDENT-DEGREES]]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <vector>

#include "brdf/reflectance.h"
#include "sh/hemisphere_basis.h"
#include "sh/lobe.h"
#include "sh/quadrature.h"
#include "sh/zernike.h"

int main(int argc, char** argv) {
  lobe::MetallicRoughness metal;
  metal.roughness = argc > 1 ? std::strtof(argv[1], nullptr) : 0.5f;
  const double degrees = argc > 2 ? std::strtod(argv[2], nullptr) : 45;
  if (!(metal.roughness >= 0.2f && metal.roughness <= 1) || !(degrees >= 0 && degrees <= 80)) {
    std::cerr << "roughness is expected from 0.2 to 1, the incident angle from 0 to 80 degrees\n";
    return 2;
  }
  const double theta = degrees * std::numbers::pi / 180;
  const lobe::Vec3d wi(std::sin(theta), 0, std::cos(theta));
  const auto f = [&](const lobe::Vec3d& wo) { return double(lobe::EvaluateGloss(metal, wi, wo)[0]); };

  // Fine enough for the sharpest lobe allowed; its directions serve projection and error alike.
  constexpr int kQuadratureDegree = 200;
  const lobe::HemisphereQuadrature rule(kQuadratureDegree);
  double flux = 0, norm2 = 0;
  for (size_t i = 0; i < rule.directions.size(); ++i) {
    const double cosine = rule.directions[i].z(), value = f(rule.directions[i]);
    flux += rule.weights[i] * value * cosine;
    norm2 += rule.weights[i] * value * value * cosine;
  }
  std::printf("%s, lit from %g degrees: flux %.5f\n\n", lobe::Describe(metal).c_str(), degrees, flux);
  std::printf("l_max  coefficients  error, %%     flux\n");

  double worst_flux = 0, last_error = 1e9;
  for (const int l_max : {0, 1, 2, 4, 6, 8, 12, 16, 24}) {
    const Eigen::VectorXd lobe = lobe::ProjectCosineWeighted(f, l_max, kQuadratureDegree);
    const lobe::HemisphereBasis<double> basis(l_max);
    std::vector<double> h(basis.size());
    double error2 = 0;
    for (size_t i = 0; i < rule.directions.size(); ++i) {
      const lobe::Vec3d& wo = rule.directions[i];
      basis.Evaluate(wo.x(), wo.y(), wo.z(), h.data());
      const double off = f(wo) - lobe.dot(Eigen::Map<const Eigen::VectorXd>(h.data(), basis.size()));
      error2 += rule.weights[i] * off * off * wo.z();
    }
    const double error = std::sqrt(error2 / norm2), lobe_flux = lobe::LobeFlux(lobe)[0];
    std::printf("%5d  %12d  %8.2f  %8.5f\n", l_max, basis.size(), 100 * error, lobe_flux);
    worst_flux = std::max(worst_flux, std::abs(lobe_flux - flux));
    if (error > last_error) return 1;  // a higher degree never fits worse
    last_error = error;
  }
  return worst_flux < 1e-3 * flux ? 0 : 1;
}
