#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/mesh.h"
#include "scene/scene.h"
#include "scene/tessellate.h"

namespace lobe {

struct Refinement {
  Mesh mesh;
  std::vector<uint32_t> node_of_old;  ///< new number of each old node
  /// Per node of the new mesh: the two nodes (new numbers) whose edge it halves, itself twice for an old one.
  /// (Where elements read from a file by another hand form no manifold, a node may be another's copy and
  /// have that one twice.)
  std::vector<std::array<uint32_t, 2>> parents;
  /// The nodes that are not old, parents before children: the order in which to carry values over. (Numbers
  /// follow the elements, so a child's may be lower than its parent's.)
  std::vector<uint32_t> made;
  size_t asked = 0;           ///< elements with a priority above 0
  size_t left_too_small = 0;  ///< requests not met: coordinates cannot express a finer mesh there
  bool out_of_nodes = false;  ///< some requests were not met because max_nodes was reached
};

/// Cuts every element of positive `priority` (one value each) at its longest edge, and of the others what
/// keeps the mesh conforming (no T-junctions inside a patch): Rivara's longest-edge propagation, in
/// scene/bisection.h. Depends on nothing but its arguments, so a mesh read from a solution is as good as any,
/// and the result has every property of a tessellated one (but no longest edge).
///
/// The outcome is the same in whatever order elements are cut, so refining once for two requests is refining
/// twice. Only if more than `max_nodes` would be needed the order matters: highest priority first, ties by
/// number, until one does not fit.
///
/// An element on a sheet whose other side is to stay alike (Material) is cut on both sides or on neither,
/// where the two are flipped copies of each other, as Tessellate makes them.
///
/// New nodes lie in the middle of the edge they halve, with the mean of its ends' shading normals.
/// Of `options` only border_inset is used. About 1 us per element (docs/validation.md#refinement).
Refinement RefineMesh(const Scene& scene, const Mesh& mesh, const std::vector<float>& priority,
                      const TessellateOptions& options, size_t max_nodes);

}  // namespace lobe
