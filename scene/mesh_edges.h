#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace lobe {

/// An edge of the mesh's elements, once, with those on either side of it.
struct MeshEdge {
  std::array<uint32_t, 2> node;     ///< node[0] < node[1]
  std::array<uint32_t, 2> element;  ///< element[0] < element[1]; the latter kNone on a patch's border
};

/// All edges, ordered by their nodes. O(n), but O(k log k) at a node with k edges. Edges never join patches,
/// since those share no nodes. (An edge of three elements, which only a file by another hand can have, is
/// told as one of two and one of one.)
std::vector<MeshEdge> MeshEdges(const Mesh& mesh);

}  // namespace lobe
