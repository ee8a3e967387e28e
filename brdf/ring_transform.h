#pragma once

#include <vector>

namespace lobe {

/// Fourier sums over equally spaced azimuths, three channels at once:
///   out[c][m] = sum_j f[c][j] cos(2 pi m j / count), out[c][l_max + 1 + m] the same with sin, 0 <= m <=
///   l_max.
/// Folding j onto count - j halves the work; orders are few and counts small, so what remains is a product
/// with a stored matrix, quicker here than a fast transform.
class RingTransform {
 public:
  /// count >= 1, l_max >= 0; throws std::invalid_argument otherwise.
  RingTransform(int count, int l_max);

  /// `f`: three planes of `count`; `out`: three planes of 2 (l_max + 1). `scratch` is resized as needed.
  void Apply(const float* f, float* out, std::vector<float>& scratch) const;

 private:
  int count_, l_max_, blocks_;
  std::vector<float> table_;  // [block of orders][j <= count / 2][cos, then sin of each order]
};

}  // namespace lobe
