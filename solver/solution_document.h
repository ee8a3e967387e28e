#pragma once

#include <functional>
#include <vector>

#include "scene/glb_writer.h"
#include "solver/patch_trees.h"
#include "solver/solution.h"

namespace lobe {

/// What a solution's file adds to what it shares with its viewing file (docs/format.md#viewing).
struct OwnMembers {
  /// To the extension on a primitive, which holds patch, material, surface, side, planar, hidden and degrees.
  std::function<void(uint32_t patch, const PatchTrees& trees, nlohmann::json* extension)> add_to_patch;
  /// To the extension on the document: SolutionRecord, version, basis, frame, names, exposure, faces. Empty:
  /// nothing.
  std::function<void(nlohmann::json* record)> add_to_record;
};

/// Fills `glb` with a valid glTF of the solution: what any viewer sees (materials, baked meshes, cameras),
/// and LOBE_directional_radiance with what both kinds of file hold and `own` adds.
void FillSolutionDocument(const Solution& solution, const OwnMembers& own, GlbWriter* glb);

/// One part (base or gloss) of a patch's lobes: node after node, each channel after channel.
std::vector<float> PartValues(const NodeLobes& lobes, uint32_t patch, bool gloss);

/// Bytes that hold `v` as they lie in memory: three floats each.
std::span<const float> Floats(std::span<const Vec3> v);

}  // namespace lobe
