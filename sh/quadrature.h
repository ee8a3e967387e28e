#pragma once

#include <vector>

#include "sh/vector.h"

namespace lobe {

/// Nodes and weights of an n-point Gauss-Legendre rule on [a, b]: exact for polynomials of degree
/// 2n - 1. Newton's method on P_n from Tricomi's estimate; full double precision for n up to 10^4.
struct GaussLegendre {
  std::vector<double> nodes, weights;
  GaussLegendre(int n, double a, double b);
};

/// A rule over the upper hemisphere, measure d omega, exact for every product of two basis
/// functions H of degree at most l_max: Gauss-Legendre in z, equal steps in phi.
/// (l_max + 1) x (2 l_max + 1) points.
struct HemisphereQuadrature {
  std::vector<Vec3d> directions;
  std::vector<double> weights;
  explicit HemisphereQuadrature(int l_max);
};

}  // namespace lobe
