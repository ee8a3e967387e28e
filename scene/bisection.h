#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "sh/vector.h"

namespace lobe {

/// Triangles cut by longest-edge bisection, conforming: a cut edge is cut for both its triangles, and is the
/// longest of both, so that angles stay above half of the smallest given (Rosenberg and Stenger, SIAM J.
/// Numer. Anal. 12, 1975). Knows geometry only; scene/tessellate.h and scene/refine.h make patches of it.
/// The one place that knows OpenMesh.
struct Bisection {
  struct Cell {
    std::array<uint32_t, 3> corner;
    uint32_t child = 0xffffffffu;  ///< first of two consecutive cells; see Mesh::Cell
    uint8_t apex = 0;
  };

  std::vector<Vec3> position;  ///< per vertex; those given come first
  std::vector<Vec3> normal;    ///< linearly interpolated, not of unit length
  /// Per vertex, the two whose edge it halves, both of lower number; itself twice if it was given. One of
  /// those that stand in for a given one (below) has that one twice.
  std::vector<std::array<uint32_t, 2>> ends;
  std::vector<Cell> cells;  ///< cell i < triangles.size() is triangle i
};

/// Cuts until no edge is longer than max_edge. Globally longest first, so that a cut edge is the longest of
/// both its triangles without further ado. Ties go to the older edge.
///
/// `triangles` index `positions` and have three different corners each. Where they do not form a
/// two-manifold (three on an edge, two that touch in a point on the same side), the one that comes later
/// gets vertices of its own. Throws std::length_error beyond 2^29 triangles. `poll` is called from time to
/// time and may throw to end it.
Bisection BisectLongEdges(const std::vector<std::array<uint32_t, 3>>& triangles, std::vector<Vec3> positions,
                          std::vector<Vec3> normals, float max_edge, const std::function<void()>& poll = {});

/// Triangles to be cut together or not at all; the second may be kNoTriangle.
using BisectionRequest = std::array<uint32_t, 2>;
inline constexpr uint32_t kNoTriangle = 0xffffffffu;

struct RequestedBisection {
  Bisection bisection;
  size_t granted = 0;    ///< requests granted: a prefix, all of them unless vertices ran out
  size_t too_small = 0;  ///< of the granted ones, those left uncut because coordinates are too coarse
};

/// Cuts each requested triangle at its longest edge, and before it whatever lies on its longest-edge
/// propagation path (Rivara, Int. J. Numer. Meth. Eng. 40, 1997), no more. One that an earlier request has
/// cut already is granted. Stops before the first request that would need more than max_vertices.
///
/// Ties between edges are broken by the positions of their ends, so the cuts are those of the geometry, in
/// whatever order triangles and requests come. An edge shorter than 64 steps of its coordinates is not cut,
/// nor the triangles whose path ends there.
RequestedBisection BisectRequested(const std::vector<std::array<uint32_t, 3>>& triangles,
                                   std::vector<Vec3> positions, std::vector<Vec3> normals,
                                   const std::vector<BisectionRequest>& requests, size_t max_vertices);

}  // namespace lobe
