#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "sh/vector.h"

namespace lobe {

/// Number of functions of degree at most `l_max` (inclusive): (l_max+1)(l_max+2)/2.
constexpr int CoefficientCount(int l_max) { return (l_max + 1) * (l_max + 2) / 2; }

/// Place of H_lm in every coefficient list; l + m is even. Bands are contiguous, so the list of a
/// lower degree is a prefix.
constexpr int CoefficientIndex(int l, int m) { return l * (l + 1) / 2 + (l + m) / 2; }

/// The even hemisphere basis of docs/conventions.md#basis:
///   H_lm = sqrt(2) Y_lm for even l + m,
/// Y_lm real, orthonormal, without Condon-Shortley sign. Orthonormal on the upper hemisphere and
/// even in z. Written as H_lm = Q_lm(z^2) * {Re, Im}(x + iy)^|m|, with Q_lm by a normalised
/// recurrence over l in steps of two (two steps of the usual three-term recurrence, e.g. Press et
/// al., Numerical Recipes, 3rd ed., eq. 6.7.9, folded into one), so nothing overflows before the
/// function itself does.
///
/// Evaluations never allocate. Const methods may run in many threads.
template <typename Real>
class HemisphereBasis {
 public:
  /// Highest degree this precision represents (docs/validation.md#basis-precision).
  static constexpr int kMaxDegree = sizeof(Real) == 4 ? 64 : 1000;

  /// Throws std::invalid_argument unless 0 <= l_max <= kMaxDegree.
  explicit HemisphereBasis(int l_max);

  int l_max() const { return l_max_; }
  int size() const { return CoefficientCount(l_max_); }

  /// Factors of Q_lm(z^2) = (a z^2 + b) Q_(l-2)m - c Q_(l-4)m, for l > m; for l = m the constant Q_mm, 0, 0.
  std::array<Real, 3> Recurrence(int l, int m) const;

  /// Writes H_k(x, y, z) for k < size(). (x, y, z) is a unit vector; only z^2 enters.
  void Evaluate(Real x, Real y, Real z, Real* out) const;

  /// Many directions as separate coordinate arrays: out[k * count + i] = H_k(w_i). Sixteen directions run
  /// side by side (docs/validation.md#speed), so batches of 16, 32, ... are best, as long as `out` stays in
  /// the first-level cache; from 16 on the last few are done as the last sixteen.
  void EvaluateBatch(const Real* x, const Real* y, const Real* z, int count, Real* out) const;

 private:
  int l_max_;
  // Q_l = (a z^2 + b) Q_{l-2} - c Q_{l-4}, l = m + 2 j, by step j, then order m; start: Q_mm.
  std::vector<Real> a_, b_, c_, start_;
};

/// Scratch that holds any basis evaluation in single precision.
inline constexpr int kMaxBasisSize = CoefficientCount(HemisphereBasis<float>::kMaxDegree);

extern template class HemisphereBasis<float>;
extern template class HemisphereBasis<double>;

}  // namespace lobe
