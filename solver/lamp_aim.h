#pragma once

#include <cstdint>

#include "scene/ray_tracer.h"
#include "scene/scene.h"

namespace lobe {

/// Says in the scene's warnings which lamps are inside out: what shines from a surface's fronts, through any
/// reflections, reaches nothing of what lies before its backs, as of a panel that faces its housing, or the
/// sky. Also, if the light of all lamps leaves the scene. By some hundred rays a surface; surfaces that emit
/// from both sides cannot be inside out.
void WarnOfLampsInsideOut(Scene* scene, const RayTracer& tracer, uint64_t seed);

}  // namespace lobe
