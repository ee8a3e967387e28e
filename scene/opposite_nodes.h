#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh.h"
#include "scene/scene.h"

namespace lobe {

/// For each node of a patch whose material transmits, the node at the same place on the other side of the
/// sheet: light that arrives at the one leaves by the other. kNone for all other nodes, and where a mesh
/// from elsewhere is not cut alike on both sides. opposite[opposite[n]] == n wherever it is not kNone; every
/// node that Tessellate made on a translucent sheet has one.
///
/// O(cells) time, by walking the two trees of each face in step.
std::vector<uint32_t> OppositeNodes(const Mesh& mesh, const Scene& scene);

}  // namespace lobe
