#pragma once

#include <cstdint>
#include <vector>

#include "solver/solution.h"

namespace lobe {

/// What an element of a smooth-shaded surface cannot show by interpolation between its nodes.
enum class NotStored : uint8_t {
  kNothing,
  kStraightLight,  ///< the lamps' light: to be sampled at the very place
  kGloss,          ///< reflections: to be traced from the very place
};

/// Per element; empty if there is no such element, as where all surfaces are flat-shaded. About 20 ns an
/// element of curved patches.
///
/// Gloss. Between two nodes whose normals differ by an angle t, what a lobe reflects turns by 2 t, but
/// interpolation fades from one node's reflection to the other's. A lobe of degree l resolves pi / l. Where
/// 2 t l / pi is above kMostGlossTurn, highlights have the shape of elements.
///
/// Straight light. A facet sees what lies above its own plane. Light that it sees and its neighbour does not
/// ends at their edge, but nodes on the edge are shared. And the cosine between the ends of a turning element
/// is not linear. Both matter where a node's shading normal is more than kMostTilt off the facet's.
///
/// What glows outshines its gloss, so lamps are left out. Surfaces with a base under their gloss are
/// kStraightLight in both cases: their gloss is mostly the lamps'. Both bounds are measured:
/// docs/validation.md#curved.
std::vector<NotStored> FindCurvedElements(const Solution& solution);

inline constexpr float kMostGlossTurn = 1;
inline constexpr float kMostTilt = 0.15f;  ///< radians

}  // namespace lobe
