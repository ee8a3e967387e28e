#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sh/vector.h"

namespace lobe {

enum class Side : uint8_t { kFront = 0, kBack = 1 };

inline constexpr uint32_t kNone = 0xffffffffu;

/// The tessellated scene. Nodes carry lobes; elements are triangles of three nodes; each element is a
/// leaf of the bisection tree of one side of one input face, so a ray that hits the face finds its
/// element by descending (scene/ray_tracer.h traces faces, never elements).
///
/// A *cell* is a node of such a tree: the root is the face (with corners in reversed order for its
/// back, so that cells always wind counter-clockwise seen from their own side); a split cell is cut
/// from corner `apex` to the middle of the opposite edge. Of corners (p0, p1, p2) rotated so that p0
/// is the apex and m = (p1 + p2) / 2, the children are (p0, p1, m) and (p0, m, p2).
struct Mesh {
  struct Patch {  ///< a connected piece of one surface, one side, one material
    uint32_t material, surface;
    Side side;
    bool planar;  ///< all node normals equal: one frame serves all
    uint32_t node_begin, node_end, element_begin, element_end;
  };
  struct Cell {
    uint32_t child = kNone;    ///< first of two consecutive children; kNone for a leaf
    uint32_t element = kNone;  ///< of a leaf
    uint8_t apex = 0;          ///< corner the cut starts from, 0..2
  };

  std::vector<Patch> patches;  ///< patches cover nodes and elements in order
  std::vector<Vec3> node_position;
  std::vector<Vec3> node_normal;  ///< shading normal, unit, on the patch's side
  /// Where a node's light is gathered: the node itself, or for nodes on a patch's border a little inside
  /// (towards the centroid of the adjacent elements), clear of the wall that meets it there.
  std::vector<Vec3> node_sample_position;
  std::vector<Vec3> node_sample_normal;  ///< geometric normal there, on the patch's side
  std::vector<uint32_t> node_patch;
  std::vector<std::array<uint32_t, 3>> elements;  ///< corners in the leaf cell's order
  std::vector<uint32_t> element_patch;
  std::vector<Cell> cells;      ///< children after parents
  std::vector<uint32_t> roots;  ///< cell of (face, side) at 2 * face + side; kNone: that side has no nodes

  size_t node_count() const { return node_position.size(); }
  size_t element_count() const { return elements.size(); }

  /// Where in the mesh the point with barycentrics (1 - u - v, u, v) of `face` lies.
  struct Location {
    uint32_t element = kNone;  ///< kNone: this side has no nodes
    float weight[3];           ///< of the element's nodes, non-negative, sum 1
  };
  Location Locate(uint32_t face, Side side, float u, float v) const;

  float ElementArea(uint32_t element) const;
  /// Twice the area times the geometric normal, on the patch's side.
  Vec3d ElementCross(uint32_t element) const;
};

/// Corners of the two children of a cell.
template <typename T>
std::array<std::array<T, 3>, 2> Bisect(const std::array<T, 3>& corner, int apex) {
  const T& p0 = corner[apex];
  const T& p1 = corner[(apex + 1) % 3];
  const T& p2 = corner[(apex + 2) % 3];
  const T m = (p1 + p2) * 0.5f;
  return {std::array<T, 3>{p0, p1, m}, std::array<T, 3>{p0, m, p2}};
}

}  // namespace lobe
