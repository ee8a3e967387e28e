#include "scene/mesh.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace lobe {

Mesh::Location Mesh::Locate(uint32_t face, Side side, float u, float v) const {
  Location where;
  const uint32_t root = roots[2 * size_t{face} + static_cast<size_t>(side)];
  if (root == kNone) return where;

  // A hit on an edge may carry barycentrics a rounding error outside.
  const float w0 = std::max(0.0f, 1.0f - u - v);
  const float w1 = std::max(0.0f, side == Side::kFront ? u : v);
  const float w2 = std::max(0.0f, side == Side::kFront ? v : u);
  const float sum = w0 + w1 + w2;
  std::array<float, 3> w = {w0 / sum, w1 / sum, w2 / sum};

  // With (a, b, c) the weights of (p0, p1, p2) and m = (p1 + p2) / 2:
  // a p0 + b p1 + c p2 = a p0 + (b - c) p1 + 2c m = a p0 + 2b m + (c - b) p2.
  // Each step keeps the weights non-negative, and their sum to a rounding error.
  const Cell* cell = &cells[root];
  while (cell->child != kNone) {
    const float a = w[cell->apex];
    const float b = w[(cell->apex + 1) % 3];
    const float c = w[(cell->apex + 2) % 3];
    if (b >= c) {
      w = {a, b - c, 2 * c};
      cell = &cells[cell->child];
    } else {
      w = {a, 2 * b, c - b};
      cell = &cells[cell->child + 1];
    }
  }
  where.element = cell->element;
  const float total = w[0] + w[1] + w[2];
  for (int i = 0; i < 3; ++i) where.weight[i] = w[i] / total;
  return where;
}

float Mesh::ElementArea(uint32_t element) const {
  return static_cast<float>(0.5 * ElementCross(element).norm());
}

Vec3d Mesh::ElementCross(uint32_t element) const {
  const std::array<uint32_t, 3>& e = elements[element];
  const Vec3d p = node_position[e[0]].cast<double>();
  const Vec3d a = node_position[e[1]].cast<double>() - p;
  const Vec3d b = node_position[e[2]].cast<double>() - p;
  return a.cross(b);
}

}  // namespace lobe
