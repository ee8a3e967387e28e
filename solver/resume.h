#pragma once

#include <string>
#include <vector>

#include "solver/solution.h"

namespace lobe {

/// Can the solver go on from `state`? `degrees` per patch are those its materials have here and now. Throws
/// InputError naming the file and what is missing or other than expected.
void CheckResumable(const Solution& state, const std::vector<PartDegrees>& degrees);

/// Throws InputError if going on needs more than `bytes` (0: any).
void RequireMemoryToContinue(double bytes, const Solution& state,
                             const std::vector<MaterialLobes>& materials);

/// What tells two scenes apart, as far as light and Lobe's files go: "the scene has 12 faces, the solution
/// 14"; empty if nothing does. Cameras and names do not count. `scene` is cut along contacts as `solved` was.
std::string DifferenceOfScenes(const Scene& scene, const Scene& solved);

}  // namespace lobe
