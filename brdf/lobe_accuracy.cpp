#include "brdf/lobe_accuracy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include "brdf/incident_moments.h"
#include "brdf/lobe_recipe.h"
#include "sh/hemisphere_basis.h"
#include "sh/lobe.h"
#include "sh/zernike.h"
#include "sh/zernike_sums.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;
const double kWorstCosine = std::cos(85 * kPi / 180);

// Twice the points of either way that tables take, so that their error is seen and not shared.
HalfVectorRule Finer(const HalfVectorRule& rule) {
  HalfVectorRule out = rule;
  out.polar = GaussLegendre(2 * int(rule.polar.nodes.size()), 0, 1);
  out.azimuth = GaussLegendre(2 * int(rule.azimuth.nodes.size()), -1, 1);
  return out;
}

// Values of base and gloss at the points of a rule, with the measure cos d omega.
struct Points {
  OutgoingPoints at;
  Eigen::ArrayXd base, gloss, measure;

  Points(const Reflectance& r, const HalfVectorRule& rule, double cosine)
      : at(rule.Points(cosine)), base(at.size()), gloss(at.size()), measure(at.size()) {
    const Vec3d wi(std::sqrt(1 - cosine * cosine), 0, cosine);
    for (int i = 0; i < at.size(); ++i) {
      const Vec3d wo(at.x[i], at.y[i], at.z[i]);
      base[i] = Luminance(EvaluateBase(r, wi, wo));
      gloss[i] = Luminance(EvaluateGloss(r, wi, wo));
      measure[i] = at.z[i] * at.weight[i];
    }
  }
};

void AddSums(const Points& points, const Eigen::ArrayXd& value, int l_max, Eigen::VectorXd* zernike) {
  ZernikeSums sums(l_max, 1);
  const Eigen::ArrayXd flux = value * points.measure;
  sums.Add(points.at.x.data(), points.at.y.data(), flux.data(), points.at.size());
  for (int n = 0; n <= l_max; ++n) {
    for (int m = n % 2; m <= n; m += 2) (*zernike)[CoefficientIndex(n, m)] += sums.Sum(n, m, 0);
  }
}

}  // namespace

ExactLobe ProjectExactly(const Reflectance& r, BrdfPart part, double cos_theta_i, int l_max) {
  const double cosine = std::clamp(cos_theta_i, 1e-7, 1.0);
  ExactLobe out;
  out.zernike = Eigen::VectorXd::Zero(CoefficientCount(l_max));
  const auto gloss_recipe = GlossRecipe(r), base_recipe = BaseRecipe(r);
  // Each part over points that suit it; <gloss, base> over the gloss's.
  if (part != BrdfPart::kBase && gloss_recipe) {
    const Points points(r, Finer(gloss_recipe->rule), cosine);
    AddSums(points, points.gloss, l_max, &out.zernike);
    out.albedo += (points.gloss * points.measure).sum();
    out.norm2 += (points.gloss.square() * points.measure).sum();
    if (part == BrdfPart::kWhole) out.norm2 += 2 * (points.gloss * points.base * points.measure).sum();
  }
  if (part != BrdfPart::kGloss) {
    const Points points(r, base_recipe ? base_recipe->rule : Finer({}), cosine);
    AddSums(points, points.base, l_max, &out.zernike);
    out.albedo += (points.base * points.measure).sum();
    out.norm2 += (points.base.square() * points.measure).sum();
  }
  return out;
}

Eigen::VectorXd LobeAt(const MaterialLobes& lobes, BrdfPart part, double cos_theta_i) {
  const double cosine = std::clamp(cos_theta_i, 0.0, 1.0);
  const auto luminance = [](const Eigen::MatrixXf& c) -> Eigen::VectorXd {
    return 0.2126 * c.col(0).cast<double>() + 0.7152 * c.col(1).cast<double>() +
           0.0722 * c.col(2).cast<double>();
  };
  const int degree = part == BrdfPart::kBase    ? lobes.base.l_max
                     : part == BrdfPart::kGloss ? lobes.gloss.l_max
                                                : lobes.max_degree();
  Eigen::VectorXd out = Eigen::VectorXd::Zero(CoefficientCount(std::max(0, degree)));
  if (lobes.diffuse()) {
    if (part != BrdfPart::kGloss) out[0] = Luminance(lobes.DiffuseAlbedo()) * std::sqrt(2 / kPi);
    return out;
  }
  IncidentMoments moments;
  moments.Start(lobes);
  moments.Add(Vec3(float(std::sqrt(1 - cosine * cosine)), 0, float(cosine)), Rgb::Constant(1));
  Eigen::MatrixXf base = Eigen::MatrixXf::Zero(lobes.base.count(), 3);
  Eigen::MatrixXf gloss = Eigen::MatrixXf::Zero(lobes.gloss.count(), 3);
  moments.Finish(base.data(), gloss.data());
  if (part != BrdfPart::kGloss && base.rows() > 0) out.head(base.rows()) += luminance(base);
  if (part != BrdfPart::kBase && gloss.rows() > 0) out.head(gloss.rows()) += luminance(gloss);
  return out;
}

double NegativeFlux(const Eigen::VectorXd& lobe) {
  // cos d omega is the area of the disc: midpoints of rings of equal area, half the disc by symmetry. A lobe
  // of degree l has l / 2 rings of either sign.
  const HemisphereBasis<double> basis(DegreeOf(int(lobe.size())));
  const int rings = 24 + 2 * basis.l_max(), spokes = 24 + 2 * basis.l_max();
  Eigen::VectorXd h(basis.size());
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double rho = std::sqrt((i + 0.5) / rings), z = std::sqrt(1 - rho * rho);
    for (int j = 0; j < spokes; ++j) {
      const double phi = kPi * (j + 0.5) / spokes;
      basis.Evaluate(rho * std::cos(phi), rho * std::sin(phi), z, h.data());
      sum += std::max(0.0, -h.dot(lobe));
    }
  }
  return sum * kPi / (double(rings) * spokes);
}

AngleAccuracy Compare(const ExactLobe& exact, const Eigen::VectorXd& lobe, double cos_theta_i) {
  AngleAccuracy out;
  out.cos_theta_i = cos_theta_i;
  out.albedo = exact.albedo;
  const Eigen::VectorXd z = ZernikeTransform(DegreeOf(int(lobe.size()))).ToZernike(lobe);
  out.lobe_albedo = std::sqrt(kPi) * z[0];
  if (exact.norm2 > 0) {
    const double lost2 = std::max(0.0, exact.norm2 - exact.zernike.head(z.size()).squaredNorm());
    const double between2 = (z - exact.zernike.head(z.size())).squaredNorm();
    out.error = {std::sqrt((lost2 + between2) / exact.norm2), std::sqrt(lost2 / exact.norm2),
                 std::sqrt(between2 / exact.norm2)};
  }
  if (exact.albedo > 0) out.negative = NegativeFlux(lobe) / exact.albedo;
  return out;
}

AccuracyMeter::AccuracyMeter(const Reflectance& r, BrdfPart part) : part_(part), exact_(kAngles) {
  const GaussLegendre t(kAngles, 0, 1);
  for (const double node : t.nodes) cosine_.push_back(IncidenceSpline::CosineOfParameter(node));
  tbb::parallel_for(0, kAngles, [&](int i) { exact_[i] = ProjectExactly(r, part, cosine_[i], kMostDegree); });
  for (int i = 0; i < kAngles; ++i) {
    // cos |d cos|, cos = (1 - t^2)^2; the factor 4 does not matter.
    weight_.push_back(t.weights[i] * exact_[i].albedo * cosine_[i] * (1 - t.nodes[i] * t.nodes[i]) *
                      t.nodes[i]);
  }
}

LobeAccuracy AccuracyMeter::Measure(const MaterialLobes& lobes) const {
  std::vector<AngleAccuracy> at(kAngles);
  tbb::parallel_for(0, kAngles,
                    [&](int i) { at[i] = Compare(exact_[i], LobeAt(lobes, part_, cosine_[i]), cosine_[i]); });
  LobeAccuracy out;
  double sum = 0;
  for (int i = 0; i < kAngles; ++i) {
    out.error.total += weight_[i] * at[i].error.total;
    out.error.truncated += weight_[i] * at[i].error.truncated;
    out.error.between += weight_[i] * at[i].error.between;
    out.negative += weight_[i] * at[i].negative;
    sum += weight_[i];
    if (cosine_[i] < kWorstCosine) continue;
    out.albedo_error = std::max(out.albedo_error, std::abs(at[i].lobe_albedo - at[i].albedo));
    if (at[i].error.total > out.worst) {
      out.worst = at[i].error.total;
      out.worst_theta = std::acos(cosine_[i]);
    }
  }
  if (!(sum > 0)) return {};
  for (double* mean : {&out.error.total, &out.error.truncated, &out.error.between, &out.negative})
    *mean /= sum;
  return out;
}

double NegativePart(const MaterialLobes& lobes, BrdfPart part) {
  constexpr int kAngles = 8;
  const GaussLegendre t(kAngles, 0, 1);
  std::vector<double> negative(kAngles);
  tbb::parallel_for(0, kAngles, [&](int i) {
    negative[i] = NegativeFlux(LobeAt(lobes, part, IncidenceSpline::CosineOfParameter(t.nodes[i])));
  });
  double sum = 0, flux = 0;
  for (int i = 0; i < kAngles; ++i) {
    const double c = IncidenceSpline::CosineOfParameter(t.nodes[i]);
    const double w = t.weights[i] * c * (1 - t.nodes[i] * t.nodes[i]) * t.nodes[i];
    Rgb albedo = part == BrdfPart::kGloss ? lobes.gloss.Albedo(float(c)) : lobes.base.Albedo(float(c));
    if (part == BrdfPart::kWhole) albedo = lobes.Albedo(float(c));
    sum += w * negative[i];
    flux += w * Luminance(albedo);
  }
  return flux > 0 ? sum / flux : 0;
}

}  // namespace lobe
