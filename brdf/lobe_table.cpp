#include "brdf/lobe_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "sh/zernike.h"

namespace lobe {

int ScalarTable::RowIndex(int n, int m) { return (n == 0 ? 0 : RowCount(n - 1)) + m / 2; }

ScalarTable ScalarTable::Build(const ScalarBrdf& f, int l_max, const HalfVectorRule& rule, int knots) {
  if (l_max < 0) throw std::invalid_argument("ScalarTable: l_max is negative");
  ScalarTable table;
  table.l_max = l_max;
  table.knots = knots > 0 ? knots : DefaultKnots(l_max);
  table.zernike = Eigen::MatrixXd::Zero(RowCount(l_max), table.knots);
  table.norm2 = Eigen::VectorXd::Zero(table.knots);
  table.albedo = Eigen::VectorXd::Zero(kFine + 1);
  const IncidenceSpline spline(table.knots);
  const auto incident = [](double c) { return Vec3d(std::sqrt(1.0 - c * c), 0.0, c); };

  tbb::parallel_for(0, table.knots, [&](int knot) {
    const double cosine = std::clamp(spline.KnotCosine(knot), 1e-7, 1.0);
    const Vec3d wi = incident(cosine);
    std::vector<double> radial(l_max / 2 + 1), cos_m(l_max + 1);
    auto column = table.zernike.col(knot);
    rule.ForEach(cosine, [&](const Vec3d& wo, double weight) {
      const double value = f(wi, wo);
      const double flux = weight * wo.z() * value;
      if (flux == 0.0) return;
      table.norm2[knot] += flux * value;
      const double rho = std::hypot(wo.x(), wo.y());
      const double cos_phi = rho > 0 ? wo.x() / rho : 1.0;
      cos_m[0] = 1;
      if (l_max >= 1) cos_m[1] = cos_phi;
      for (int m = 2; m <= l_max; ++m) cos_m[m] = 2.0 * cos_phi * cos_m[m - 1] - cos_m[m - 2];
      for (int m = 0; m <= l_max; ++m) {
        ZernikeRadial(m, l_max, rho, radial.data());
        for (int n = m; n <= l_max; n += 2) {
          column[RowIndex(n, m)] += flux * cos_m[m] * radial[(n - m) / 2];
        }
      }
    });
  });
  tbb::parallel_for(0, kFine + 1, [&](int i) {
    const double cosine = std::clamp(IncidenceSpline::CosineOfParameter(double(i) / kFine), 1e-7, 1.0);
    const Vec3d wi = incident(cosine);
    double sum = 0;
    rule.ForEach(cosine, [&](const Vec3d& wo, double weight) { sum += weight * wo.z() * f(wi, wo); });
    table.albedo[i] = sum;
  });
  return table;
}

double ScalarTable::Error(int l) const { return ErrorWithin(*this, l); }

double ScalarTable::ErrorWithin(const ScalarTable& whole, int l) const {
  if (norm2.size() != knots) throw std::logic_error("ScalarTable::Error: a combined table has no norms");
  const int rows = RowCount(std::min(l, l_max));
  const IncidenceSpline spline(knots);
  double sum = 0, weights = 0;
  for (int j = 0; j < knots; ++j) {
    // albedo cos sin d theta = albedo c |dc|, c = (1 - t^2)^2; equal steps in t.
    const double t = double(j) / (knots - 1), c = spline.KnotCosine(j);
    const double flux = std::sqrt(std::numbers::pi) * whole.zernike(0, j);
    const double w = flux * c * (1.0 - t * t) * t;
    const double lost2 = std::max(0.0, norm2[j] - zernike.col(j).head(rows).squaredNorm());
    const double whole2 = &whole == this ? norm2[j] : whole.zernike.col(j).squaredNorm();
    if (!(whole2 > 0)) continue;
    sum += w * std::sqrt(lost2 / whole2);
    weights += w;
  }
  return weights > 0 ? sum / weights : 0.0;
}

ScalarTable ScalarTable::Combine(double a, const ScalarTable& f, double b, const ScalarTable& g,
                                 const Eigen::VectorXd& sum_norm2) {
  if (f.knots != g.knots) throw std::invalid_argument("ScalarTable::Combine: knots differ");
  ScalarTable out;
  out.l_max = std::min(f.l_max, g.l_max);
  out.knots = f.knots;
  const int rows = RowCount(out.l_max);
  out.zernike = a * f.zernike.topRows(rows) + b * g.zernike.topRows(rows);
  out.albedo = a * f.albedo + b * g.albedo;
  if (sum_norm2.size() > 0) {
    const Eigen::VectorXd inner_twice = sum_norm2 - f.norm2 - g.norm2;
    out.norm2 = a * a * f.norm2 + b * b * g.norm2 + a * b * inner_twice;
  }
  return out;
}

}  // namespace lobe
