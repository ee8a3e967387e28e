#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "brdf/material_lobes.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "solver/options.h"

namespace lobe {

/// How large a mesh is, as far as memory goes.
struct MeshCounts {
  std::vector<double> nodes;  ///< per material
  double elements = 0;

  double all_nodes() const;
  MeshCounts Times(double factor) const;
};
MeshCounts CountsOf(const Mesh& mesh, size_t materials);
/// Of the mesh that Tessellate would make, from areas alone, before any refinement; at least half of it is
/// needed (longest-edge bisection stops somewhere between max_edge and max_edge / sqrt 2). `sides` as there.
MeshCounts ExpectCounts(const Scene& scene, const std::vector<bool>& sides, float max_edge);

/// Bytes that a solve takes at its peak, from counts; measured in docs/validation.md#memory.
struct MemoryNeed {
  double scene = 0;    ///< the program, input faces, what rays need
  double mesh = 0;     ///< nodes, elements, bisection trees, and the record of a step per node
  double lobes = 0;    ///< five fields of them
  double links = 0;    ///< with chains by mirrors
  double cutting = 0;  ///< what tessellation and refinement take for a while
  double file = 0;     ///< the solution as it is written, for a while
  /// The three phases do not coincide: the largest.
  double peak() const;
};
MemoryNeed EstimateMemory(const Scene& scene, const MeshCounts& counts,
                          const std::vector<MaterialLobes>& materials, const SolveOptions& options);

/// How many nodes a mesh of `counts` may have after refinement to fit into `bytes`, if all that are added are
/// of its dearest material; at least those it has.
double NodesThatFit(double bytes, const Scene& scene, const MeshCounts& counts,
                    const std::vector<MaterialLobes>& materials, const SolveOptions& options);

/// Throws InputError if the need is above `bytes`, saying how much it is and which longest edge would do.
void RequireMemory(double bytes, const Scene& scene, const std::vector<bool>& sides, const MeshCounts& counts,
                   const std::vector<MaterialLobes>& materials, const SolveOptions& options);

/// "1.2 GB".
std::string MemoryText(double bytes);

}  // namespace lobe
