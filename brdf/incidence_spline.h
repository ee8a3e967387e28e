#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace lobe {

/// Cubic spline over the incident angle.
///
/// Parameter t = sqrt(1 - sqrt(cos theta_i)), t in [0, 1]: analytic and odd in theta at 0 and
/// quadratically denser towards grazing, for two square roots and no trigonometry. Knots are equally
/// spaced in t. Parity at theta = 0 is built in: coefficients of even azimuthal order m have zero
/// slope there, those of odd m vanish. At grazing the third derivative is continuous at the last
/// inner knot ("not a knot").
///
/// Written over uniform cubic B-splines, whose control values ("bins") number knots + 1: bin j is
/// centred on knot j, the last one lies past the end, and the one before 0 is the mirror of bin 1.
class IncidenceSpline {
 public:
  static constexpr int kFewestKnots = 5;
  /// At least kFewestKnots; throws std::invalid_argument otherwise.
  explicit IncidenceSpline(int knots);

  int knots() const { return knots_; }
  int bins() const { return knots_ + 1; }

  /// cos_theta in [0, 1].
  template <typename Real>
  static Real ParameterOfCosine(Real cos_theta) {
    return std::sqrt(Real(1) - std::sqrt(cos_theta));
  }
  static double CosineOfParameter(double t) {
    const double c = 1.0 - t * t;
    return c * c;
  }
  double KnotCosine(int j) const { return CosineOfParameter(double(j) / (knots_ - 1)); }

  /// The four bins that matter at one angle and their weights. On the first interval bin[0] is the
  /// mirror image: index 1, with `mirrored` set, and its weight changes sign for odd m.
  struct Stencil {
    int bin[4];
    float weight[4];
    bool mirrored;
  };
  /// cos_theta is clamped to [0, 1].
  Stencil At(float cos_theta) const;

  /// What values at the knots are multiplied by to give the spline's at other parameters t in [0, 1]: a row
  /// for each, a column per knot. In double, for preparing tables.
  Eigen::MatrixXd Interpolation(const Eigen::VectorXd& t, bool odd) const;
  /// t of the knots.
  Eigen::VectorXd KnotParameters() const { return Eigen::VectorXd::LinSpaced(knots_, 0.0, 1.0); }

  /// Control values (bins rows) that interpolate `values` (knots rows), for one parity of m.
  Eigen::MatrixXd ControlValues(const Eigen::MatrixXd& values, bool odd) const;

 private:
  int knots_;
  Eigen::MatrixXd solve_even_, solve_odd_;
};

}  // namespace lobe
