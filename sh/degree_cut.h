#pragma once

#include <vector>

#include <Eigen/Core>

namespace lobe {

/// Lowers lobes from one degree to another, prepared once: ChangeDegree for many lobes. The result is the
/// cos-weighted least-squares fit, so the flux stays and the cos-weighted L2 norm never grows.
class DegreeCut {
 public:
  /// 0 <= to < from; throws std::invalid_argument otherwise.
  DegreeCut(int from, int to);

  /// One channel: CoefficientCount(from) coefficients in, CoefficientCount(to) out.
  void Apply(const float* coefficients, float* out) const;

 private:
  int from_, to_;
  // By order m = 0 .. to: what the coefficients above degree `to` add to those of degree m, m + 2, ... <= to.
  std::vector<Eigen::MatrixXf> folded_;
};

}  // namespace lobe
