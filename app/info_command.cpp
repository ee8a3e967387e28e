#include <memory>

#include "app/commands.h"
#include "app/lobe_flags.h"
#include "app/report.h"
#include "scene/gltf_scene.h"
#include "solver/trust.h"

namespace lobe {
namespace {

struct InfoFlags {
  std::string file;
  LobeFlags lobes;  ///< for scenes; a solution has its own
};

std::string CostText(const std::vector<MaterialRow>& rows) {
  const std::string text = LobeCostText(rows);
  return text.empty() ? text : "\n" + text;
}

ExitCode ShowScene(const InfoFlags& flags, Console& console) {
  const Scene scene = ReadGltfScene(flags.file);
  for (const std::string& warning : scene.warnings) console.Warn(warning);
  const auto rows = MaterialRows(scene, flags.lobes.Options());

  nlohmann::json json = {{"type", "scene"},
                         {"path", flags.file},
                         {"scene", SceneJson(scene)},
                         {"materials", MaterialJson(rows)}};
  console.Result(flags.file + ": scene\n" + SceneText(scene) + "\n" + MaterialText(rows) + CostText(rows),
                 json);
  return kDone;
}

std::string SettingsText(const SolveOptions& o) {
  std::string text = "  edge " + Short(o.mesh.max_edge) + " m, lmax " + std::to_string(o.lobes.l_max);
  text += o.lobes.force_l_max >= 0 ? ", degree forced to " + std::to_string(o.lobes.force_l_max)
                                   : ", lobe error " + Short(100 * o.lobes.error) + " %";
  text += ", refine error " + Short(100 * o.refine.error) + " %,\n  contact distance " +
          Short(o.contact_distance) + " m, light samples " + std::to_string(o.light_samples) +
          ", transport " + Name(o.transport);
  // Each transport has knobs of its own.
  text += o.transport == Transport::kShooting
              ? ", delta areas " + std::to_string(o.delta_areas) + ", step fraction " + Short(o.step_fraction)
              : ", links " + std::to_string(o.links) + (o.accelerate ? "" : ", plain sweeps");
  return text + ",\n  residual " + Short(o.residual) + ", seed " + std::to_string(o.seed) + "\n";
}

std::string HistoryText(const std::vector<StepRecord>& history) {
  Table table("rrrrr");
  table.AddRow({"step", "unshot/emitted", "seconds", "rays", "shooters"});
  // The first steps, then ever fewer: powers of two, and the last.
  for (size_t i = 0; i < history.size(); ++i) {
    const bool power_of_two = (i & (i - 1)) == 0;
    if (i > 8 && !power_of_two && i + 1 != history.size()) continue;
    const StepRecord& r = history[i];
    table.AddRow({std::to_string(r.step), Format("%.3e", r.residual), Format("%.2f", r.seconds),
                  Format("%.3g", double(r.rays)), std::to_string(r.shooters)});
  }
  return table.Text();
}

ExitCode ShowSolution(const InfoFlags& flags, Console& console) {
  const Solution s = ReadSolution(flags.file);
  auto rows = MaterialRows(s);
  MeasureLobes(s.scene, s.options.lobes, &rows);
  nlohmann::json json = {{"type", "solution"},
                         {"path", flags.file},
                         {"scene", SceneJson(s.scene)},
                         {"mesh", MeshJson(s)},
                         {"materials", MaterialJson(rows)},
                         {"settings", SettingsJson(s.options)},
                         {"ledger", LedgerJson(s.ledger)},
                         {"history", HistoryJson(s.history)},
                         {"stop_reason", Name(s.stop_reason)},
                         {"residual", s.residual()},
                         {"trust", Name(JudgeSolution(s))},
                         {"resumed", s.resumed},
                         {"checkpoint", s.stop_reason == StopReason::kUnfinished},
                         {"solve_seconds", s.solve_seconds}};
  if (const std::string sentence = TrustSentence(s); !sentence.empty()) {
    console.Warn(flags.file + ": " + sentence);
  }
  console.Result(flags.file + ": solution\n" + SceneText(s.scene) + MeshText(s) + "\n" + MaterialText(rows) +
                     CostText(rows) + "\nsettings\n" + SettingsText(s.options) + "\nledger\n" +
                     LedgerText(s.ledger) + "\nconvergence\n" + HistoryText(s.history) + "  " + StopText(s) +
                     Format("; %.2f s\n", s.solve_seconds),
                 json);
  return kDone;
}

ExitCode RunInfo(const InfoFlags& flags, Console& console) {
  SolveOptions options;
  options.lobes = flags.lobes.Options();
  if (const std::string wrong = options.Validate(); !wrong.empty()) throw UsageError(wrong);
  return IsSolution(flags.file) ? ShowSolution(flags, console) : ShowScene(flags, console);
}

}  // namespace

void AddInfoCommand(CLI::App& app, Command* command) {
  auto flags = std::make_shared<InfoFlags>();
  CLI::App* info = app.add_subcommand("info", "What is in a scene or a solution");
  info->footer(
      "Of a scene: counts, lamps, cameras, and for each material the model read and what it costs to solve:\n"
      "none (diffuse, one coefficient), lobe (within --lobe-error), sharp (beyond it at the cap --lmax) or "
      "mirror;\n"
      "of those that are not diffuse also what truncation and knots over the incident angle lose, the "
      "negative\n"
      "part, and what a lobe takes. `lobe brdf` says more of one material.\n"
      "Of a solution also the mesh, settings, energy ledger and convergence.\n"
      "\n"
      "Examples:\n"
      "  lobe info scene.glb --lobe-error 5\n"
      "  lobe info solution.glb --json");
  info->add_option("FILE", flags->file, "Scene or solution, .glb or .gltf")->type_name("")->required();
  flags->lobes.AddTo(info);
  info->callback(
      [flags, command] { *command = [flags](Console& console) { return RunInfo(*flags, console); }; });
}

}  // namespace lobe
