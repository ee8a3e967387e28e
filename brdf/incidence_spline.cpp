#include "brdf/incidence_spline.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <Eigen/LU>

namespace lobe {
namespace {

// Uniform cubic B-spline: weights of the bins before, at, after and two after, `u` of an interval on.
template <typename Real>
void BSplineWeights(Real u, Real* weight) {
  const Real v = 1 - u, sixth = Real(1) / 6;
  weight[0] = v * v * v * sixth;
  weight[1] = (3 * u * u * u - 6 * u * u + 4) * sixth;
  weight[2] = (3 * v * v * v - 6 * v * v + 4) * sixth;
  weight[3] = u * u * u * sixth;
}

}  // namespace

IncidenceSpline::IncidenceSpline(int knots) : knots_(knots) {
  if (knots < kFewestKnots) {
    throw std::invalid_argument("IncidenceSpline: " + std::to_string(knots) + " knots given, at least " +
                                std::to_string(kFewestKnots) + " expected");
  }
  const int n = knots_;
  for (const bool odd : {false, true}) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + 1, n + 1);
    for (int j = 0; j < n; ++j) {
      // (c_{j-1} + 4 c_j + c_{j+1}) / 6 = value_j, with c_{-1} = +-c_1.
      if (j > 0) a(j, j - 1) += 1.0 / 6.0;
      a(j, j) += 4.0 / 6.0;
      a(j, j + 1) += 1.0 / 6.0;
      if (j == 0) a(0, 1) += (odd ? -1.0 : 1.0) / 6.0;
    }
    // Equal third differences on the last two intervals.
    const double not_a_knot[5] = {1, -4, 6, -4, 1};
    for (int k = 0; k < 5; ++k) a(n, n - 4 + k) = not_a_knot[k];
    (odd ? solve_odd_ : solve_even_) = a.inverse().leftCols(n);
  }
}

IncidenceSpline::Stencil IncidenceSpline::At(float cos_theta) const {
  const float s = ParameterOfCosine(std::clamp(cos_theta, 0.0f, 1.0f)) * float(knots_ - 1);
  const int i = std::clamp(int(s), 0, knots_ - 2);
  Stencil out;
  out.mirrored = i == 0;
  out.bin[0] = i == 0 ? 1 : i - 1;
  for (int k = 1; k < 4; ++k) out.bin[k] = i - 1 + k;
  BSplineWeights(s - float(i), out.weight);
  return out;
}

Eigen::MatrixXd IncidenceSpline::Interpolation(const Eigen::VectorXd& t, bool odd) const {
  Eigen::MatrixXd read = Eigen::MatrixXd::Zero(t.size(), bins());
  for (int row = 0; row < t.size(); ++row) {
    const double s = std::clamp(t[row], 0.0, 1.0) * (knots_ - 1);
    const int i = std::clamp(int(s), 0, knots_ - 2);
    double weight[4];
    BSplineWeights(s - i, weight);
    read(row, i == 0 ? 1 : i - 1) += i == 0 && odd ? -weight[0] : weight[0];
    for (int k = 1; k < 4; ++k) read(row, i - 1 + k) += weight[k];
  }
  Eigen::MatrixXd solve = odd ? solve_odd_ : solve_even_;
  if (odd) solve.col(0).setZero();  // as in ControlValues
  return read * solve;
}

Eigen::MatrixXd IncidenceSpline::ControlValues(const Eigen::MatrixXd& values, bool odd) const {
  if (values.rows() != knots_) throw std::invalid_argument("IncidenceSpline: one row per knot expected");
  Eigen::MatrixXd with_parity = values;
  if (odd) with_parity.row(0).setZero();  // exact where quadrature left rounding
  return (odd ? solve_odd_ : solve_even_) * with_parity;
}

}  // namespace lobe
