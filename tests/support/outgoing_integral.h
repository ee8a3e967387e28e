#pragma once

#include <Eigen/Core>

#include "brdf/hemisphere_integral.h"

namespace lobe::test {

/// Integral of value(w) cos over the hemisphere, for lobes of about the rule's width around the mirror
/// direction of an incident direction (sin, 0, cos).
template <typename Value>
Eigen::Array3d IntegrateOutgoing(const HalfVectorRule& rule, double cos_theta_i, const Value& value) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  const OutgoingPoints points = rule.Points(cos_theta_i);
  for (int i = 0; i < points.size(); ++i) {
    const Vec3d w(points.x[i], points.y[i], points.z[i]);
    sum += value(w).template cast<double>() * (w.z() * points.weight[i]);
  }
  return sum;
}
template <typename Value>
Eigen::Array3d IntegrateOutgoing(double width, double cos_theta_i, const Value& value) {
  return IntegrateOutgoing(HalfVectorRule{.width = width}, cos_theta_i, value);
}

}  // namespace lobe::test
