#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sh/vector.h"

namespace lobe {

/// Triangles cut by longest-edge bisection until no edge is too long, conforming: a cut edge is cut for both
/// its triangles. Knows geometry only; scene/tessellate.h makes patches of it. The one place that knows
/// OpenMesh.
///
/// Globally longest first, so that a cut edge is always the longest of both its triangles: this is Rivara's
/// bisection without its propagation (Int. J. Numer. Meth. Eng. 20, 1984), and angles stay above half of
/// the smallest given (Rosenberg and Stenger, SIAM J. Numer. Anal. 12, 1975). Ties go to the older edge.
struct Bisection {
  struct Cell {
    std::array<uint32_t, 3> corner;
    uint32_t child = 0xffffffffu;  ///< first of two consecutive cells; see Mesh::Cell
    uint8_t apex = 0;
  };

  std::vector<Vec3> position;   ///< per vertex; those given come first
  std::vector<Vec3> normal;     ///< linearly interpolated, not of unit length
  std::vector<uint8_t> border;  ///< on an edge of one triangle only
  std::vector<Cell> cells;      ///< cell i < triangles.size() is triangle i
};

/// `triangles` index `positions` and have three different corners each. Where they do not form a
/// two-manifold (three on an edge, two that touch in a point on the same side), the one that comes later
/// gets vertices of its own. Throws std::length_error beyond 2^29 triangles.
Bisection BisectLongEdges(const std::vector<std::array<uint32_t, 3>>& triangles, std::vector<Vec3> positions,
                          std::vector<Vec3> normals, float max_edge);

}  // namespace lobe
