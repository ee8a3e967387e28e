#pragma once

#include "scene/scene.h"

namespace lobe {

/// Leaves one face on each side wherever faces lie in one plane, so that every part of the program sees the
/// same: the emitter, else the later in the file. What is covered is left out: a face that lies wholly under
/// others, a part of one that is cut off along their outline, and the covered side of a double-sided face,
/// which becomes single-sided there. A sheet of glass or translucent material is seen from both sides or not
/// at all.
///
/// Two faces back to back that show their fronts both stay; where they only overlap in part, their pieces get
/// the same corners, which rays need to tell them apart (scene/repeated_faces.h). Feet of bodies are not in
/// question where they stand on a single side, and are covered by a double-sided one: nobody sees them.
/// Surfaces of solid glass are left out only where the same glass is there twice.
///
/// What is seen differently, or given twice, is told in one warning that names the surfaces. Scenes without
/// such faces come back bit for bit.
void ResolveCoincidentFaces(Scene* scene);

}  // namespace lobe
