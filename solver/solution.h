#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/mesh.h"
#include "scene/ray_tracer.h"
#include "scene/scene.h"
#include "solver/ledger.h"
#include "solver/node_lobes.h"
#include "solver/options.h"

namespace lobe {

enum class StopReason {
  kConverged,
  kStepLimit,
  kTimeLimit,
  kInterrupted,
  kNotConverging,
  kUnfinished,  ///< not stopped: a checkpoint of a solve that went on, or was killed
};
const char* Name(StopReason reason);

/// A solved scene: what `lobe solve` writes and everything else reads.
struct Solution {
  Scene scene;
  Mesh mesh;
  SolveOptions options;
  std::vector<GlossKind> material_kinds;  ///< per scene.materials
  std::vector<double> material_errors;    ///< flux-weighted error of the gloss lobes
  std::vector<uint8_t> hidden;            ///< per node: inside something, weight 0 in interpolation
  NodeLobes total;                        ///< reflected radiance, all bounces shot so far included
  NodeLobes direct;  ///< of it, straight from emitters, by no mirror; indirect = total - direct
  NodeLobes unshot;  ///< of it, not yet passed on
  /// Per node: irradiance so far, summed over channels, which shooting needs to go on. Empty with links.
  std::vector<float> received;
  Ledger ledger;
  std::vector<StepRecord> history;
  int resumed = 0;  ///< how many times it was continued after a stop
  StopReason stop_reason = StopReason::kConverged;
  double solve_seconds = 0;  ///< of all runs together

  double residual() const { return history.empty() ? 1.0 : history.back().residual; }
};

/// Nodes and weights that carry the light at a point of an element: hat functions, hidden nodes left out
/// and the rest renormalised. Shooting, rendering and inspection all interpolate through here.
struct NodeWeights {
  int count = 0;  ///< 0: all three are hidden
  uint32_t node[3];
  float weight[3];
};
NodeWeights Interpolate(const Mesh& mesh, const std::vector<uint8_t>& hidden, const Mesh::Location& where);

/// Area each node speaks for, square metres: integral of its interpolation function.
std::vector<double> NodeAreas(const Mesh& mesh, const std::vector<uint8_t>& hidden);

/// solution.glb (docs/format.md): complete, readable back, a valid glTF with a baked fallback.
/// Throws InputError.
void WriteSolution(const Solution& solution, const std::string& path);
/// Throws InputError; a scene without lobes is one of the reasons.
Solution ReadSolution(const std::string& path);
/// Does this glTF carry LOBE_directional_radiance? Throws InputError if it cannot be read at all.
bool IsSolution(const std::string& path);

}  // namespace lobe
