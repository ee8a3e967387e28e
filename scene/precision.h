#pragma once

#include "scene/scene.h"

namespace lobe {

/// Says, in `scene`'s warnings, where single precision cannot carry it: one sentence for each surface that
/// has edges, or triangles thinner, than a few steps of its own coordinates (far from the origin, or of very
/// different sizes), naming the surface, the sizes and the step; and one if the scene's coordinates are so
/// large that faces count as touching farther apart than `contact_distance`. What is warned of is solved all
/// the same, with rounding for light where it is that fine.
void WarnOfLostPrecision(Scene* scene, double contact_distance);

}  // namespace lobe
