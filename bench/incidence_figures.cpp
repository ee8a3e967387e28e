#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include "bench/brdf_figures.h"
#include "brdf/lobe_accuracy.h"
#include "sh/hemisphere_basis.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kLMax = 20;

/// A way to measure the incident angle, 0 at the normal and 1 at grazing; odd in theta, as the spline's
/// parity asks.
struct Parameter {
  const char* name;
  std::function<double(double)> of_cosine, cosine;
};

Parameter Power(const char* name, double p) {
  return {name, [p](double c) { return std::sqrt(1 - std::pow(c, p)); },
          [p](double t) { return std::pow(1 - t * t, 1 / p); }};
}

/// The last one has steps that are even within `width` of grazing, where lobes of that width change.
std::vector<Parameter> Parameters(double width) {
  const double most = std::asinh(1 / width);
  return {{"theta", [](double c) { return std::acos(c) * 2 / kPi; },
           [](double t) { return std::cos(t * kPi / 2); }},
          Power("cos", 1),
          Power("cos^(3/4)", 0.75),
          Power("cos^(1/2)", 0.5),
          Power("cos^(1/4)", 0.25),
          {"asinh(cos / width)", [=](double c) { return std::sqrt(1 - std::asinh(c / width) / most); },
           [=](double t) { return width * std::sinh(most * (1 - t * t)); }}};
}

/// What a spline with knots evenly in a parameter loses of one BRDF's lobes.
class KnotLoss {
 public:
  explicit KnotLoss(const Reflectance& r) : r_(r) {
    const GaussLegendre theta(kAngles, 0, kPi / 2);
    for (int i = 0; i < kAngles; ++i) {
      const double t = theta.nodes[i], c = std::cos(t);
      cosine_.push_back(c);
      weight_.push_back(theta.weights[i] * c * std::sin(t) * Exact(c).albedo);
    }
    for (const double degrees : {80.0, 85.0, 89.0}) cosine_.push_back(std::cos(degrees * kPi / 180));
  }

  /// Relative to the norm of f, cos-weighted: by flux, and at 80, 85 and 89 degrees.
  std::array<double, 4> Measure(const Parameter& parameter, int knots) {
    const IncidenceSpline spline(knots);
    Eigen::MatrixXd values(knots, CoefficientCount(kLMax));
    for (int j = 0; j < knots; ++j) {
      values.row(j) = Exact(parameter.cosine(double(j) / (knots - 1))).zernike.transpose();
    }
    Eigen::VectorXd t(cosine_.size());
    for (size_t i = 0; i < cosine_.size(); ++i) t[Eigen::Index(i)] = parameter.of_cosine(cosine_[i]);
    const Eigen::MatrixXd even = spline.Interpolation(t, false) * values;
    const Eigen::MatrixXd odd = spline.Interpolation(t, true) * values;
    std::array<double, 4> out{};
    double flux = 0;
    for (size_t i = 0; i < cosine_.size(); ++i) {
      const ExactLobe& exact = Exact(cosine_[i]);
      double off2 = 0;
      for (int n = 0; n <= kLMax; ++n) {
        for (int m = n % 2; m <= n; m += 2) {
          const int k = CoefficientIndex(n, m);
          off2 += std::pow((m % 2 == 0 ? even : odd)(Eigen::Index(i), k) - exact.zernike[k], 2);
        }
      }
      const double loss = std::sqrt(off2 / exact.norm2);
      if (i < kAngles) {
        out[0] += weight_[i] * loss;
        flux += weight_[i];
      } else {
        out[1 + i - kAngles] = loss;
      }
    }
    out[0] /= flux;
    return out;
  }

 private:
  static constexpr int kAngles = 32;

  const ExactLobe& Exact(double cosine) {
    const auto [at, fresh] = known_.try_emplace(cosine);
    if (fresh) at->second = ProjectExactly(r_, BrdfPart::kGloss, cosine, kLMax);
    return at->second;
  }

  Reflectance r_;
  std::vector<double> cosine_, weight_;
  std::map<double, ExactLobe> known_;
};

}  // namespace

void IncidenceFigures() {
  constexpr double kTolerance = 0.01;
  constexpr int kMostKnots = 48;
  const Rgb white = Rgb::Constant(1);
  std::vector<Reflectance> models;
  for (const float roughness : {1.0f, 0.7f, 0.5f, 0.3f, 0.2f}) {
    models.push_back(MetallicRoughness{.roughness = roughness});
  }
  models.push_back(MetallicRoughness{.metallic = 0, .roughness = 0.3f});
  for (const float exponent : {20.0f, 200.0f}) models.push_back(Phong{white, exponent});
  models.push_back(Ward{white, 0.2f});
  models.push_back(CookTorrance{white, 0.2f});
  models.push_back(AshikhminShirley{white / 2, white / 2, 200});

  std::printf("| model |");
  for (const Parameter& parameter : Parameters(1)) std::printf(" %s |", parameter.name);
  std::printf("\n|---|---|---|---|---|---|---|\n");
  for (const Reflectance& r : models) {
    KnotLoss loss(r);
    std::printf("| %s |", Describe(r).c_str());
    for (const Parameter& parameter : Parameters(GlossRecipe(r)->rule.width)) {
      int knots = IncidenceSpline::kFewestKnots;
      while (knots < kMostKnots && loss.Measure(parameter, knots)[0] > kTolerance) ++knots;
      const auto lost = loss.Measure(parameter, knots);
      std::printf(" %d: %.1f, %.1f, %.1f |", knots, 100 * lost[1], 100 * lost[2], 100 * lost[3]);
    }
    std::printf("\n");
  }
}

}  // namespace lobe
