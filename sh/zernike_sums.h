#pragma once

#include <vector>

namespace lobe {

/// Sums over many points of the disc against all cosine Zernike functions of degree at most l_max at once:
///   Sum(n, m, k) = sum_i value_k(i) R_n^m(rho_i) cos(m phi_i), 0 <= m <= n, n - m even,
/// R as of ZernikeRadial. The recurrences run on several points side by side and are shared by all `planes`
/// of values, so that a point costs about four multiply-adds a function (docs/validation.md#tables).
class ZernikeSums {
 public:
  /// l_max >= 0, planes >= 1. O(l_max^2) memory.
  ZernikeSums(int l_max, int planes);

  /// Adds points (x, y) of the disc: values[k * count + i] for plane k.
  void Add(const double* x, const double* y, const double* values, int count);
  double Sum(int n, int m, int plane) const;

 private:
  int l_max_, planes_;
  std::vector<double> a_, b_, c_;  // of ZernikeStep, by order m, then step
  std::vector<double> sums_;       // [order and step][plane][lane]
};

}  // namespace lobe
