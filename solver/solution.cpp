#include "solver/solution.h"

namespace lobe {

const char* Name(StopReason reason) {
  switch (reason) {
    case StopReason::kConverged:
      return "converged";
    case StopReason::kStepLimit:
      return "step limit";
    case StopReason::kTimeLimit:
      return "time limit";
    case StopReason::kInterrupted:
      return "interrupted";
    case StopReason::kNotConverging:
      return "not converging";
    case StopReason::kUnfinished:
      return "unfinished";
  }
  return "";
}

NodeWeights Interpolate(const Mesh& mesh, const std::vector<uint8_t>& hidden, const Mesh::Location& where) {
  NodeWeights out;
  float sum = 0;
  for (int i = 0; i < 3; ++i) {
    const uint32_t node = mesh.elements[where.element][i];
    if (hidden[node]) continue;
    out.node[out.count] = node;
    out.weight[out.count++] = where.weight[i];
    sum += where.weight[i];
  }
  // At a hidden node itself the others have no weight yet; they share it, as the limit of a hat would.
  for (int i = 0; i < out.count; ++i) {
    out.weight[i] = sum > 1e-6f ? out.weight[i] / sum : 1.0f / float(out.count);
  }
  return out;
}

std::vector<double> NodeAreas(const Mesh& mesh, const std::vector<uint8_t>& hidden) {
  std::vector<double> area(mesh.node_count(), 0.0);
  for (uint32_t e = 0; e < mesh.element_count(); ++e) {
    int visible = 0;
    for (const uint32_t node : mesh.elements[e]) visible += !hidden[node];
    // By symmetry the renormalised functions of one element have equal integrals.
    for (const uint32_t node : mesh.elements[e]) {
      if (!hidden[node]) area[node] += double(mesh.ElementArea(e)) / visible;
    }
  }
  return area;
}

}  // namespace lobe
