#include "sh/degree_cut.h"

#include <algorithm>
#include <stdexcept>

#include "sh/hemisphere_basis.h"
#include "sh/zernike.h"

namespace lobe {

DegreeCut::DegreeCut(int from, int to) : from_(from), to_(to) {
  if (to < 0 || to >= from) throw std::invalid_argument("DegreeCut: 0 <= to < from is expected");
  const ZernikeTransform high(from), low(to);
  for (int m = 0; m <= to; ++m) {
    const Eigen::MatrixXd& to_h = low.ToHemisphereBlock(m);
    // What lies within the lower degree already maps to itself.
    const Eigen::MatrixXd& to_z = high.ToZernikeBlock(m);
    const Eigen::Index kept = to_h.cols(), cut = to_z.cols() - kept;
    folded_.push_back((to_h * to_z.topRightCorner(kept, cut)).cast<float>());
  }
}

void DegreeCut::Apply(const float* coefficients, float* out) const {
  std::copy_n(coefficients, CoefficientCount(to_), out);
  for (int order = -to_; order <= to_; ++order) {
    const int m = std::abs(order);
    const Eigen::MatrixXf& folded = folded_[m];
    for (Eigen::Index j = 0; j < folded.cols(); ++j) {
      const int high = m + 2 * int(folded.rows() + j);
      const float c = coefficients[CoefficientIndex(high, order)];
      for (Eigen::Index i = 0; i < folded.rows(); ++i) {
        out[CoefficientIndex(m + 2 * int(i), order)] += folded(i, j) * c;
      }
    }
  }
}

}  // namespace lobe
