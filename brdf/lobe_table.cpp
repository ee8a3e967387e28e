#include "brdf/lobe_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "sh/zernike_sums.h"

namespace lobe {
namespace {

double SchlickRise(const Vec3d& wi, const Vec3d& wo) {
  const double x = 1.0 - std::sqrt(std::max(0.0, 0.5 * (1.0 + wi.dot(wo))));
  return x * x * x * x * x;
}

// Angles at which the albedo is integrated; the fine grid comes from these (docs/validation.md#flux).
//
// The albedo is smooth in cos theta but for two things at grazing: a layer as thin as the lobe is wide, and a
// term c log c, c = cos theta. In y = sqrt(asinh(c / width)) the layer is as wide as the rest and the term is
// y^2 log y: the polynomial through Chebyshev points in y, which crowd at the ends, converges fast.
class AlbedoAngles {
 public:
  static constexpr int kCount = 48;
  explicit AlbedoAngles(double width) : width_(width), y_max_(Parameter(1.0)) {}

  double Cosine(int k) const {
    const double y = Node(k);
    return std::min(1.0, width_ * std::sinh(y * y));
  }
  // From values at the angles to the fine grid: barycentric formula (Berrut and Trefethen, SIAM Review 46(3),
  // 2004, eq. 4.2 and 5.3).
  Eigen::MatrixXd ToFineGrid() const {
    Eigen::MatrixXd out(ScalarTable::kFine + 1, kCount);
    for (int i = 0; i <= ScalarTable::kFine; ++i) {
      const double y = Parameter(IncidenceSpline::CosineOfParameter(double(i) / ScalarTable::kFine));
      for (int k = 0; k < kCount; ++k) {
        const double weight = (k % 2 == 0 ? 1 : -1) * std::sin(Angle(k)), distance = y - Node(k);
        out(i, k) = weight / (distance != 0 ? distance : 1e-200);  // at a node that node alone
      }
      out.row(i) /= out.row(i).sum();
    }
    return out;
  }

 private:
  double Parameter(double cosine) const { return std::sqrt(std::asinh(cosine / width_)); }
  static double Angle(int k) { return std::numbers::pi * (k + 0.5) / kCount; }
  double Node(int k) const { return y_max_ * 0.5 * (1.0 + std::cos(Angle(k))); }

  double width_, y_max_;
};

// Values of all functions at one pair of directions.
using Parts = std::function<void(const Vec3d& wi, const Vec3d& wo, double* values)>;

// Incident angles beyond this, 87 degrees, are grazing for Resolving().
constexpr double kGrazingCosine = 0.05;

// The rule for products with the basis, which ask for more points than the lobe alone does: beyond degree 24,
// and at grazing incidence from degree 11 on, where many azimuths crowd at the horizon's cut. With 40 x 64
// everywhere coefficients of GGX to degree 32 are up to 0.36 % off by flux, and at 90 degrees those to degree
// 20 by 40 % (docs/validation.md#knots).
HalfVectorRule Resolving(const HalfVectorRule& rule, int l_max, bool grazing) {
  size_t polar = rule.polar.nodes.size(), azimuth = rule.azimuth.nodes.size();
  if (l_max > 24) {
    polar = std::max<size_t>(polar, 56);
    azimuth = std::max<size_t>(azimuth, 80);
  }
  if (grazing) azimuth = std::max<size_t>(azimuth, 6 * l_max);
  HalfVectorRule out = rule;
  out.polar = GaussLegendre(int(polar), 0.0, 1.0);
  out.azimuth = GaussLegendre(int(azimuth), -1.0, 1.0);
  return out;
}

// Tables of as many functions. One pass over the points serves them all.
void BuildParts(const Parts& f, int l_max, const HalfVectorRule& rule, int knots,
                const std::vector<ScalarTable*>& tables, Eigen::VectorXd* inner) {
  if (l_max < 0) throw std::invalid_argument("ScalarTable: l_max is negative");
  if (knots <= 0) knots = ScalarTable::DefaultKnots(l_max);
  const int parts = int(tables.size());
  const IncidenceSpline spline(knots);
  for (ScalarTable* table : tables) {
    table->l_max = l_max;
    table->knots = knots;
    table->zernike.resize(ScalarTable::RowCount(l_max), knots);
    table->norm2.resize(knots);
  }
  if (inner) inner->resize(knots);
  const HalfVectorRule rule_at_knots[2] = {Resolving(rule, l_max, false), Resolving(rule, l_max, true)};
  const AlbedoAngles albedo_angles(rule.width);
  Eigen::MatrixXd albedo(AlbedoAngles::kCount, parts);

  tbb::parallel_for(0, knots + AlbedoAngles::kCount, [&](int angle) {
    const bool at_knot = angle < knots;
    const double cosine =
        std::clamp(at_knot ? spline.KnotCosine(angle) : albedo_angles.Cosine(angle - knots), 1e-7, 1.0);
    const Vec3d wi(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
    const OutgoingPoints points = (at_knot ? rule_at_knots[cosine < kGrazingCosine] : rule).Points(cosine);
    Eigen::MatrixXd value(points.size(), parts);
    std::vector<double> at_point(parts);
    for (int i = 0; i < points.size(); ++i) {
      f(wi, Vec3d(points.x[i], points.y[i], points.z[i]), at_point.data());
      for (int part = 0; part < parts; ++part) value(i, part) = at_point[part];
    }
    const auto measure = Eigen::Map<const Eigen::ArrayXd>(points.z.data(), points.size()) *
                         Eigen::Map<const Eigen::ArrayXd>(points.weight.data(), points.size());
    const Eigen::MatrixXd flux = value.array().colwise() * measure;
    if (!at_knot) {
      albedo.row(angle - knots) = flux.colwise().sum();
      return;
    }
    ZernikeSums sums(l_max, parts);
    sums.Add(points.x.data(), points.y.data(), flux.data(), points.size());
    for (int part = 0; part < parts; ++part) {
      ScalarTable& table = *tables[part];
      table.norm2[angle] = flux.col(part).dot(value.col(part));
      for (int n = 0; n <= l_max; ++n) {
        for (int m = n % 2; m <= n; m += 2) {
          table.zernike(ScalarTable::RowIndex(n, m), angle) = sums.Sum(n, m, part);
        }
      }
    }
    if (inner) (*inner)[angle] = flux.col(0).dot(value.col(1));
  });
  const Eigen::MatrixXd fine = albedo_angles.ToFineGrid() * albedo;
  for (int part = 0; part < parts; ++part) tables[part]->albedo = fine.col(part);
}

}  // namespace

int ScalarTable::RowIndex(int n, int m) { return (n == 0 ? 0 : RowCount(n - 1)) + m / 2; }

ScalarTable ScalarTable::Build(const ScalarBrdf& f, int l_max, const HalfVectorRule& rule, int knots) {
  ScalarTable table;
  BuildParts([&](const Vec3d& wi, const Vec3d& wo, double* value) { *value = f(wi, wo); }, l_max, rule, knots,
             {&table}, nullptr);
  return table;
}

std::vector<ScalarTable> ScalarTable::BuildChannels(const RgbBrdf& f, int l_max, const HalfVectorRule& rule,
                                                    int knots) {
  std::vector<ScalarTable> tables(3);
  BuildParts(
      [&](const Vec3d& wi, const Vec3d& wo, double* values) {
        const Rgb colour = f(wi, wo);
        std::copy_n(colour.data(), 3, values);
      },
      l_max, rule, knots, {&tables[0], &tables[1], &tables[2]}, nullptr);
  return tables;
}

SchlickTables SchlickTables::Build(const ScalarBrdf& f, int l_max, const HalfVectorRule& rule, int knots) {
  SchlickTables out;
  BuildParts(
      [&](const Vec3d& wi, const Vec3d& wo, double* values) {
        values[0] = f(wi, wo);
        values[1] = values[0] * SchlickRise(wi, wo);
      },
      l_max, rule, knots, {&out.plain, &out.rising}, &out.inner);
  return out;
}

ScalarTable SchlickTables::Mix(double a, double b) const {
  ScalarTable out;
  out.l_max = plain.l_max;
  out.knots = plain.knots;
  out.zernike = a * plain.zernike + b * rising.zernike;
  out.albedo = a * plain.albedo + b * rising.albedo;
  out.norm2 = a * a * plain.norm2 + b * b * rising.norm2 + 2.0 * a * b * inner;
  return out;
}

ScalarTable ScalarTable::Scaled(double factor) const {
  ScalarTable out = *this;
  out.zernike *= factor;
  out.albedo *= factor;
  out.norm2 *= factor * factor;
  return out;
}

double ScalarTable::FluxWeight(int j) const {
  // cos sin d theta = c |dc|, c = (1 - t^2)^2; equal steps in t.
  const double t = double(j) / (knots - 1), c = IncidenceSpline::CosineOfParameter(t);
  return std::sqrt(std::numbers::pi) * zernike(0, j) * c * (1.0 - t * t) * t;
}

double ScalarTable::Error(int l) const {
  const int rows = RowCount(std::min(l, l_max));
  double sum = 0, weights = 0;
  for (int j = 0; j < knots; ++j) {
    if (!(norm2[j] > 0)) continue;
    const double w = FluxWeight(j);
    const double lost2 = std::max(0.0, norm2[j] - zernike.col(j).head(rows).squaredNorm());
    sum += w * std::sqrt(lost2 / norm2[j]);
    weights += w;
  }
  return weights > 0 ? sum / weights : 0.0;
}

}  // namespace lobe
