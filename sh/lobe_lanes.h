#pragma once

#include <cstddef>
#include <vector>

#include "sh/lanes.h"

namespace lobe {

/// Reads a three-channel lobe in sixteen directions side by side, from coefficients as they are stored:
/// nothing to pack, so no memory beyond a table by degree. Where directions come one at a time and lobes are
/// read many times, LobeReader is the one to take.
///
///   L(w) = sum_m {cos, sin}(m phi) sin^m(theta) sum_j Q_mj(z^2) c_(m + 2j, +-m),  Q as in HemisphereBasis.
///
/// Const methods may run in many threads.
class LobeLanes {
 public:
  /// For lobes of degree 0..l_max <= 64; throws std::invalid_argument otherwise.
  explicit LobeLanes(int l_max);

  int l_max() const { return l_max_; }

  /// Adds to `out` (channel c of lane i at c * kLanes + i) the lobe of degree `l` towards unit vectors (x, y,
  /// z), z >= 0. `coefficients`: channel after channel, CoefficientCount(l) each. `x`, `y`, `z` and `out` are
  /// aligned to 64 bytes.
  void Add(const float* coefficients, int l, const float* x, const float* y, const float* z,
           float* out) const;

 private:
  int l_max_;
  std::vector<float> recurrence_;  // by order m, then step j of l = m + 2 j: a, b, c; step 0: Q_mm, 0, 0
};

}  // namespace lobe
