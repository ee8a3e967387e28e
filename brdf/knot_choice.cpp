#include "brdf/knot_choice.h"

#include <algorithm>
#include <cmath>

namespace lobe {

int KnotChoice::MostMeasured() const {
  return std::max(IncidenceSpline::kFewestKnots, 1 + 3 * (table_.knots() - 1) / 4);
}

Eigen::MatrixXd KnotChoice::ToKnots(const IncidenceSpline& spline, bool odd) const {
  if (spline.knots() == table_.knots()) return Eigen::MatrixXd::Identity(table_.knots(), table_.knots());
  return table_.Interpolation(spline.KnotParameters(), odd);
}

Eigen::VectorXd KnotChoice::Difference2(const ScalarTable& table, int degree, int knots) const {
  const IncidenceSpline spline(knots);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(table.knots);
  for (const bool odd : {false, true}) {
    std::vector<int> rows;
    for (int n = odd; n <= degree; n += 2) {
      for (int m = odd; m <= n; m += 2) rows.push_back(ScalarTable::RowIndex(n, m));
    }
    if (rows.empty()) continue;
    Eigen::MatrixXd exact(table.knots, rows.size());
    for (size_t i = 0; i < rows.size(); ++i)
      exact.col(Eigen::Index(i)) = table.zernike.row(rows[i]).transpose();
    const Eigen::MatrixXd back = spline.Interpolation(table_.KnotParameters(), odd) * ToKnots(spline, odd);
    sum += (back * exact - exact).rowwise().squaredNorm();
  }
  return sum;
}

LobeError KnotChoice::Measure(const ScalarTable& table, int degree, int knots) const {
  degree = std::min(degree, table.l_max);
  const Eigen::VectorXd between2 = Difference2(table, degree, std::min(knots, MostMeasured()));
  LobeError out;
  double weights = 0;
  for (int j = 0; j < table.knots; ++j) {
    if (!(table.norm2[j] > 0)) continue;
    const double w = table.FluxWeight(j), norm2 = table.norm2[j];
    const double kept2 = table.zernike.col(j).head(ScalarTable::RowCount(degree)).squaredNorm();
    const double lost2 = std::max(0.0, norm2 - kept2);
    out.truncated += w * std::sqrt(lost2 / norm2);
    out.between += w * std::sqrt(between2[j] / norm2);
    out.total += w * std::sqrt((lost2 + between2[j]) / norm2);
    weights += w;
  }
  if (!(weights > 0)) return {};
  out.truncated /= weights;
  out.between /= weights;
  out.total /= weights;
  return out;
}

int KnotChoice::Fewest(const ScalarTable& table, int degree, double tolerance) const {
  const auto suffice = [&](int knots) { return Measure(table, degree, knots).between <= tolerance; };
  int low = IncidenceSpline::kFewestKnots, high = MostMeasured();
  if (!suffice(high)) return table.knots;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (suffice(middle)) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return high;
}

}  // namespace lobe
