#pragma once

#include <functional>
#include <vector>

#include "scene/mesh.h"
#include "scene/scene.h"

namespace lobe {

struct TessellateOptions {
  /// Longest edge of an element (1e-5 of it more is let pass), metres, > 0. Time grows with nodes, nodes
  /// with 1 / edge^2.
  float max_edge = 0.4f;
  /// Corners at one position become one node if their normals differ by less; radians. (chosen)
  float crease_angle = 0.0175f;
  /// Border nodes gather light this far towards the centroid of their elements, as a fraction of the way.
  /// Measured in docs/validation.md#border.
  float border_inset = 0.02f;
};

/// Welds, splits edges by longest-edge bisection until none is longer than max_edge, and lays out
/// patches. No T-junction inside a patch: an edge is always split for both its elements.
/// `sides`: 2 * face + side -> wanted or not (see solver/exposure.h); empty means every front, and every
/// back of double-sided materials. A face whose material transmits has nodes on both sides if either is
/// wanted, and is cut alike on both (scene/opposite_nodes.h).
/// Throws InputError if more than 2^31 elements would be needed. `poll` is called from time to time and may
/// throw to end it.
Mesh Tessellate(const Scene& scene, const TessellateOptions& options, const std::vector<bool>& sides = {},
                const std::function<void()>& poll = {});

}  // namespace lobe
