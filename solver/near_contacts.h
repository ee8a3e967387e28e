#pragma once

#include <vector>

#include "scene/mesh.h"
#include "scene/refine.h"
#include "scene/scene.h"

namespace lobe {

/// How near nodes are to lines where faces touch: 1 within `distance` (metres) of an edge that Face::contact
/// marks, on whatever face, and falling to 0 over the elements beside it, as measured on a mesh before it is
/// refined.
std::vector<float> NearContacts(const Scene& scene, const Mesh& mesh, float distance);

/// The same values on a refined mesh, interpolated.
std::vector<float> CarryOver(const std::vector<float>& values, const Refinement& refined);

}  // namespace lobe
