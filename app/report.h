#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "solver/solution.h"

namespace lobe {

/// Words and JSON for what `solve` and `info` both say.

/// Lobes, and the wall time they took to make.
struct BuiltLobes {
  MaterialLobes lobes;
  double seconds;
};
BuiltLobes BuildLobes(const Reflectance& reflectance, const LobeOptions& options, TableCache& cache);

/// What a material's lobes lose, and take; of the gloss, or of the base if there is no gloss.
struct LobeCost {
  LobeError error;
  double negative = 0;  ///< flux of the negative part over the flux
  int knots = 0;
  size_t lobe_bytes = 0;
  double build_seconds = 0;  ///< wall time; next to nothing where a material before it has the same tables
};

/// A material and what its reflection costs.
struct MaterialRow {
  std::string name, model;
  GlossKind kind = GlossKind::kNone;
  bool translucent = false;               ///< light goes through to the other side
  int l_max_base = -1, l_max_gloss = -1;  ///< -1: no such part
  double lobe_error = 0;                  ///< flux-weighted, fraction
  /// Of a solution only MeasureLobes says it.
  std::optional<LobeCost> cost;
  Rgb emission = Rgb::Zero();
};
/// By building the lobes' tables.
std::vector<MaterialRow> MaterialRows(const Scene& scene, const LobeOptions& options);
/// From what was solved; a material without nodes has no degrees.
std::vector<MaterialRow> MaterialRows(const Solution& solution);
/// Adds the cost of each material that has lobes, by making them once more.
void MeasureLobes(const Scene& scene, const LobeOptions& options, std::vector<MaterialRow>* rows);
std::string MaterialText(const std::vector<MaterialRow>& rows);
/// Costs alone; empty if no material has any.
std::string LobeCostText(const std::vector<MaterialRow>& rows);
nlohmann::json MaterialJson(const std::vector<MaterialRow>& rows);

std::string LedgerText(const Ledger& ledger);
nlohmann::json LedgerJson(const Ledger& ledger);

nlohmann::json HistoryJson(const std::vector<StepRecord>& history);
nlohmann::json SettingsJson(const SolveOptions& options);

/// "converged: 0.08 % of the emitted power is unshot after 9 steps, resumed 1 time".
std::string StopText(const Solution& solution);

/// Faces, emitters and such.
nlohmann::json SceneJson(const Scene& scene);
std::string SceneText(const Scene& scene);

/// Nodes, elements and memory.
nlohmann::json MeshJson(const Solution& solution);
std::string MeshText(const Solution& solution);

nlohmann::json ToJson(const Rgb& colour);
nlohmann::json ToJson(const Vec3& vector);

}  // namespace lobe
