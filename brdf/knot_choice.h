#pragma once

#include <vector>

#include <Eigen/Core>

#include "brdf/lobe_table.h"

namespace lobe {

/// Error of lobes, cos-weighted relative L2 over wo, averaged over theta_i by flux
/// (docs/conventions.md#basis).
struct LobeError {
  double total = 0;      ///< of a lobe read at any angle
  double truncated = 0;  ///< of the exact projection: what its degree leaves out
  /// Of the spline against the exact projection at that angle. Both lie in the basis, and what is left out is
  /// orthogonal to it: at each angle the squares of this and of `truncated` add up to that of `total`.
  double between = 0;
};

/// Reading tables with fewer knots than they were projected at. The projections between the fewer knots are
/// known, so that what fewer cost is measured, not estimated.
class KnotChoice {
 public:
  /// For tables of this many knots.
  explicit KnotChoice(int table_knots) : table_(table_knots) {}

  /// The most knots for which enough projections lie between: three for every four of the table's.
  int MostMeasured() const;
  /// Of `table` cut at `degree` and read with `knots` knots, at least 5. More than MostMeasured() cost less
  /// than that many: what is said of them is that bound.
  LobeError Measure(const ScalarTable& table, int degree, int knots) const;
  /// The fewest knots whose error between them is at most `tolerance`; the table's own if even MostMeasured()
  /// miss it. By bisection: O(log) measurements of some 50 us.
  int Fewest(const ScalarTable& table, int degree, double tolerance) const;

  /// What a column of values at the table's knots is multiplied by to give `spline`'s knot values, for one
  /// parity of m.
  Eigen::MatrixXd ToKnots(const IncidenceSpline& spline, bool odd) const;

 private:
  /// Squared difference between spline and table at the table's knots.
  Eigen::VectorXd Difference2(const ScalarTable& table, int degree, int knots) const;

  IncidenceSpline table_;
};

}  // namespace lobe
