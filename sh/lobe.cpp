#include "sh/lobe.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "sh/simd.h"
#include "sh/zernike.h"

namespace lobe {

Eigen::VectorXd FluxWeights(int l_max) {
  // The flux is the first Zernike coefficient times sqrt(pi).
  const ZernikeTransform transform(l_max);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(CoefficientCount(l_max));
  for (int l = 0; l <= l_max; l += 2) {
    weights[CoefficientIndex(l, 0)] = std::sqrt(std::numbers::pi) * transform.ToZernikeBlock(0)(0, l / 2);
  }
  return weights;
}

Eigen::RowVectorXd LobeFlux(const Eigen::Ref<const Eigen::MatrixXd>& coefficients) {
  return FluxWeights(DegreeOf(int(coefficients.rows()))).transpose() * coefficients;
}

Eigen::MatrixXd ChangeDegree(const Eigen::Ref<const Eigen::MatrixXd>& coefficients, int l_max) {
  const int from = DegreeOf(int(coefficients.rows()));
  if (l_max >= from) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(CoefficientCount(l_max), coefficients.cols());
    out.topRows(coefficients.rows()) = coefficients;
    return out;
  }
  return ZernikeTransform(l_max).ToHemisphere(
      ZernikeTransform(from).ToZernike(coefficients).topRows(CoefficientCount(l_max)));
}

int DegreeOf(int count) {
  int l = 0;
  while (CoefficientCount(l) < count) ++l;
  if (count < 1 || CoefficientCount(l) != count) {
    throw std::invalid_argument("a lobe of " + std::to_string(count) +
                                " coefficients has no degree; (l+1)(l+2)/2 expected");
  }
  return l;
}

LOBE_SIMD_CLONES float Dot(const float* a, const float* b, int count) {
  float sum = 0;
  for (int k = 0; k < count; ++k) sum += a[k] * b[k];
  return sum;
}

}  // namespace lobe
