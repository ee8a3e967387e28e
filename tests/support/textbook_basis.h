#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "sh/hemisphere_basis.h"

namespace lobe::test {

/// H_lm (docs/conventions.md#basis) by the recurrence as textbooks print it (Numerical Recipes, 3rd ed., eq.
/// 6.7.9): normalised P_l^m, one degree after the other, for every l, one direction at a time; those of odd l
/// - m are stepped over. The slow second opinion of HemisphereBasis, in any precision.
template <typename Real>
class TextbookBasis {
 public:
  explicit TextbookBasis(int l_max) : l_max_(l_max) {
    // H_mm = sqrt(2) Y_mm, with sqrt(2) once more for m > 0 in the real Y.
    Real sectoral = std::sqrt(Real(2) / (4 * std::numbers::pi_v<Real>));
    for (int m = 0; m <= l_max; ++m) {
      if (m > 0) sectoral *= std::sqrt((2 * Real(m) + 1) / (2 * Real(m)));
      start_.push_back(m > 0 ? sectoral * std::sqrt(Real(2)) : sectoral);
      for (int l = m + 1; l <= l_max; ++l) {
        const Real l2 = Real(l) * l, m2 = Real(m) * m, before = Real(l - 1) * (l - 1);
        scale_.push_back(std::sqrt((4 * l2 - 1) / (l2 - m2)));
        fall_.push_back(std::sqrt((before - m2) / (4 * before - 1)));
      }
    }
  }

  /// As HemisphereBasis::Evaluate.
  void Evaluate(Real x, Real y, Real z, Real* out) const {
    Real cosine = 1, sine = 0;  // sin^m(theta) {cos, sin}(m phi)
    const Real *scale = scale_.data(), *fall = fall_.data();
    for (int m = 0; m <= l_max_; ++m) {
      Real p = start_[m], before = 0;
      for (int l = m;;) {
        if ((l - m) % 2 == 0) {
          if (m > 0) out[CoefficientIndex(l, -m)] = p * sine;
          out[CoefficientIndex(l, m)] = p * cosine;
        }
        if (++l > l_max_) break;
        const Real next = *scale++ * (z * p - *fall++ * before);
        before = p;
        p = next;
      }
      const Real turned = cosine * x - sine * y;
      sine = cosine * y + sine * x;
      cosine = turned;
    }
  }

 private:
  int l_max_;
  std::vector<Real> start_, scale_, fall_;
};

}  // namespace lobe::test
