#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lobe {

/// Reads three-channel lobes in many directions, several times as fast as evaluating the basis and taking dot
/// products: coefficients are packed by order m, sums over l - m run first, for 16 orders side by side and
/// without ever writing the basis down; cos and sin of m phi come last, once.
///
///   L(w) = sum_m cos(m phi) sin^m(theta) sum_j Q_mj(z^2) c_(m + 2j, m) + the same with sin and -m,
///
/// Q as in HemisphereBasis. Const methods may run in many threads.
class LobeReader {
 public:
  /// 0 <= l_max <= 64; throws std::invalid_argument otherwise.
  explicit LobeReader(int l_max);

  int l_max() const { return l_max_; }
  /// Floats of a packed lobe; about twice the coefficients of three channels.
  size_t packed_size() const { return packed_size_; }

  /// Adds a lobe of degree l <= l_max to a packed one (zeroed by the caller). `coefficients`: channel after
  /// channel, (l+1)(l+2)/2 each.
  void Pack(const float* coefficients, int l, float* packed) const;

  /// Value towards the unit vector (x, y, z), z >= 0.
  std::array<float, 3> Read(const float* packed, float x, float y, float z) const;

 private:
  int l_max_;
  size_t packed_size_ = 0;
  std::vector<float> recurrence_;  // per block of orders and step j: a, b, c; step 0: start, 0, 0
};

}  // namespace lobe
