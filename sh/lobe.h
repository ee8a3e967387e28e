#pragma once

#include <Eigen/Core>

#include "sh/hemisphere_basis.h"

namespace lobe {

/// Operations on a lobe: coefficients over the hemisphere basis, one row each, one column per channel.

/// Flux of a lobe of radiance, integral of L cos(theta) d omega over the upper hemisphere, per column
/// (W m^-2 for radiance). Only the m = 0 coefficients matter.
Eigen::RowVectorXd LobeFlux(const Eigen::Ref<const Eigen::MatrixXd>& coefficients);

/// w[k]: flux of the basis function H_k for k < CoefficientCount(l_max); LobeFlux is their dot product.
Eigen::VectorXd FluxWeights(int l_max);

/// The same lobe in degree `l_max`: coefficients added as zeros when that is higher; when lower, the
/// cos-weighted least-squares fit, which keeps the flux (dropping coefficients would not: DESIGN 3,
/// docs/validation.md#degree-change).
Eigen::MatrixXd ChangeDegree(const Eigen::Ref<const Eigen::MatrixXd>& coefficients, int l_max);

/// Degree of a list of `count` coefficients; throws std::invalid_argument if no degree has that many.
int DegreeOf(int count);

/// sum_k a[k] b[k], in single precision, the inner loop of every lobe read.
float Dot(const float* a, const float* b, int count);

}  // namespace lobe
