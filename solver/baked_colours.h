#pragma once

#include <vector>

#include "solver/solution.h"

namespace lobe {

/// What any glTF viewer shows of a solution: one colour per node, without direction.
struct BakedColours {
  std::vector<float> rgb;    ///< 3 per node, linear, in [0, 1]
  float exposure_scale = 1;  ///< radiance times this, cut at 1, is the colour
};

/// Emission plus flux / pi of the reflected lobe (the radiance of a diffuse node, and the mean of a glossy
/// one). The scale brings the 95th percentile of the brightest channel, weighted by area, to 0.8. Hidden
/// nodes, which are dark and would stain what can be seen, take the mean of the visible nodes around them.
BakedColours BakeColours(const Solution& solution);

}  // namespace lobe
