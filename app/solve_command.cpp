#include <cmath>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <new>
#include <optional>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/lobe_flags.h"
#include "app/machine_memory.h"
#include "app/progress.h"
#include "app/report.h"
#include "app/resume_flags.h"
#include "app/values.h"
#include "scene/contacts.h"
#include "scene/glb_writer.h"
#include "scene/gltf_scene.h"
#include "scene/input_error.h"
#include "solver/resume.h"
#include "solver/solver.h"
#include "solver/trust.h"

namespace lobe {
namespace {

struct SolveFlags {
  std::string scene, output, resume;
  SolveOptions options;
  LobeFlags lobes;
  double checkpoint_seconds = SolveControl{}.checkpoint_seconds;
  std::optional<double> max_memory_gigabytes;
  double refine_error_percent = 100 * RefineOptions{}.error;
  double contact_error_percent = 100 * RefineOptions{}.contact_error;
};

void Validate(SolveFlags& flags) {
  flags.options.lobes = flags.lobes.Options();
  flags.options.refine.error = flags.refine_error_percent / 100;
  flags.options.refine.contact_error = flags.contact_error_percent / 100;
  if (const std::string wrong = flags.options.Validate(); !wrong.empty()) throw UsageError(wrong);
  if (!(flags.checkpoint_seconds >= 0)) {
    throw UsageError("--checkpoint-seconds: " + Short(flags.checkpoint_seconds) +
                     " is out of range: 0 (never) or more is expected");
  }
  if (flags.max_memory_gigabytes && !(*flags.max_memory_gigabytes > 0)) {
    throw UsageError("--max-memory: " + Short(*flags.max_memory_gigabytes) +
                     " is out of range: more than 0 GB is expected");
  }
  const bool resumes = !flags.resume.empty();
  if (flags.scene.empty() && !resumes) throw UsageError("SCENE is required, or --resume FILE");
  // What is resumed goes on where it is.
  if (flags.output.empty() && resumes) flags.output = flags.resume;
  if (flags.output.empty()) throw UsageError("-o, --output is required");
  RequireExtension("-o", flags.output, {".glb", ".gltf"});
  if (!flags.scene.empty()) RequireOtherFile("-o", flags.output, flags.scene, "the scene");
}

Scene ReadScene(const std::string& path) {
  if (IsSolution(path)) throw InputError(path + ": is a solution already; `lobe solve` expects a scene");
  return ReadGltfScene(path);
}

// The state to go on from, with this run's limits.
Solution ReadToResume(const SolveFlags& flags, const CLI::App& command) {
  Solution state = ReadSolution(flags.resume);
  RefuseOtherSettings(command, flags.options, state.options, flags.resume);
  state.options = WithGivenLimits(command, flags.options, state.options);
  if (!flags.scene.empty()) {
    const Scene scene =
        CutAlongContacts(ReadScene(flags.scene), {.distance = state.options.contact_distance});
    if (const std::string other = DifferenceOfScenes(scene, state.scene); !other.empty()) {
      throw InputError(flags.scene + ": is not the scene that " + flags.resume +
                       " was solved from: " + other);
    }
  }
  return state;
}

// Writes checkpoints under the solution's name. One that cannot be written is told once, and the solve goes
// on: the one before is still there.
class CheckpointWriter {
 public:
  CheckpointWriter(const std::string& output, const Console& console, ProgressDisplay* display)
      : output_(output), console_(console), display_(display) {}

  /// Into a pipe or a device goes the result only.
  static bool Possible(const std::string& output) {
    std::error_code none;
    return !std::filesystem::exists(output, none) || std::filesystem::is_regular_file(output, none);
  }

  void Write(const Solution& solution) {
    std::string why;
    try {
      WriteSolution(solution, output_);
      return;
    } catch (const InputError& e) {
      why = e.what();
    } catch (const std::bad_alloc&) {
      why = output_ + ": out of memory";
    }
    if (warned_) return;
    warned_ = true;
    display_->Clear();
    console_.Warn("a checkpoint was not saved: " + why + "; solving goes on");
  }

 private:
  const std::string& output_;
  const Console& console_;
  ProgressDisplay* display_;
  bool warned_ = false;
};

std::string PhaseText(const Progress& p) {
  switch (p.phase) {
    case Phase::kPreparation:
      return "preparing";
    case Phase::kEmission:
      return "light from the lamps";
    case Phase::kLinks:
      return "tracing links";
    case Phase::kMirrors:
      return "light from the lamps by mirrors";
    case Phase::kBounces:
      return "bounce " + std::to_string(p.step);
  }
  return "";
}

void ShowProgress(const Progress& p, double target, ProgressDisplay* display) {
  // Before light bounces the bar shows the phase, then how far the residual has come.
  const bool bounces = p.phase == Phase::kBounces;
  const double done = bounces ? std::log(p.residual) / std::log(target) : p.fraction_of_phase;
  std::string words = PhaseText(p);
  if (bounces) {
    words += Format(" (%.0f %%)", 100 * p.fraction_of_phase) +
             Format(", %.3g %% of the power still moving", 100 * p.residual);
  }
  if (p.nodes > 0) words += ", " + Count(p.nodes, "node");
  if (p.rays > 0) {
    words += Format(", %.3g million rays", double(p.rays) * 1e-6) +
             Format(" (%.2g million/s)", p.rays_per_second * 1e-6);
  }
  words += ", " + Duration(p.seconds);
  if (p.seconds_left) words += ", about " + Duration(*p.seconds_left) + " left";
  display->Show(done, words);
}

nlohmann::json SolveJson(const Solution& s, const TimeSplit& split, double cpu_seconds,
                         const std::string& output) {
  nlohmann::json out = MeshJson(s);
  out["materials"] = MaterialJson(MaterialRows(s));
  out["ledger"] = LedgerJson(s.ledger);
  out["history"] = HistoryJson(s.history);
  out["settings"] = SettingsJson(s.options);
  out["stop_reason"] = Name(s.stop_reason);
  out["residual"] = s.residual();
  out["trust"] = Name(JudgeSolution(s));
  out["solve_seconds"] = s.solve_seconds;
  out["resumed"] = s.resumed;
  out["cpu_seconds"] = cpu_seconds;
  out["time_split"] = {{"preparation", split.preparation},
                       {"emission", split.emission},
                       {"links", split.links},
                       {"reflection", split.reflection},
                       {"lobe_reads", split.lobe_reads},
                       {"lobe_writes", split.lobe_writes}};
  out["warnings"] = s.scene.warnings;
  out["output"] = output;
  return out;
}

double Total(const Ledger::Power& power) { return power[0] + power[1] + power[2]; }

ExitCode RunSolve(SolveFlags flags, const CLI::App& command, Console& console) {
  Validate(flags);
  // Asked before anything is computed, so that nothing is computed in vain.
  CheckWritable(flags.output);
  const std::atomic<bool>* interrupted = CatchInterrupts();

  Solution start;
  if (flags.resume.empty()) {
    start.scene = ReadScene(flags.scene);
    start.options = flags.options;
    for (const std::string& warning : start.scene.warnings) console.Warn(warning);
    console.Say(flags.scene + "\n" + SceneText(start.scene));
  } else {
    start = ReadToResume(flags, command);
    console.Say(flags.resume + "\n" + SceneText(start.scene));
    console.Say("going on from " + StopText(start));
  }
  const size_t faces_read = start.scene.faces.size();

  TimeSplit split;
  const size_t warnings_told = start.scene.warnings.size();
  const std::clock_t cpu_start = std::clock();
  const Solution solution = [&] {
    ProgressDisplay display(console);
    CheckpointWriter checkpoints(flags.output, console, &display);
    SolveControl control;
    control.stop = interrupted;
    control.time_split = &split;
    control.progress = [&](const Progress& p) { ShowProgress(p, start.options.residual, &display); };
    control.max_memory = flags.max_memory_gigabytes ? 1e9 * *flags.max_memory_gigabytes : AvailableMemory();
    control.memory = [&, told = 0.0](const MemoryNeed& need) mutable {
      // Said again only if refinement has made it another.
      if (std::abs(need.peak() - told) < 0.1 * told) return;
      display.Clear();
      console.Say((told > 0 ? "refined, it needs about " : "needs about ") + MemoryText(need.peak()) +
                  " of memory");
      told = need.peak();
    };
    if (CheckpointWriter::Possible(flags.output)) {
      control.checkpoint = [&](const Solution& s) { checkpoints.Write(s); };
      control.checkpoint_seconds = flags.checkpoint_seconds;
    }
    return flags.resume.empty() ? Solve(std::move(start.scene), start.options, control)
                                : Resume(std::move(start), control);
  }();
  const double cpu_seconds = double(std::clock() - cpu_start) / CLOCKS_PER_SEC;

  WriteSolution(solution, flags.output);

  const size_t faces_cut = solution.scene.faces.size() - faces_read;
  if (faces_cut > 0) {
    console.Say("contacts: cut along where surfaces touch, which made " + Count(faces_cut, "triangle") +
                " more");
  }
  for (size_t i = warnings_told; i < solution.scene.warnings.size(); ++i) {
    console.Warn(solution.scene.warnings[i]);
  }
  console.Say(MaterialText(MaterialRows(solution)));
  console.Say(LedgerText(solution.ledger));
  const double emitted = Total(solution.ledger.emitted), mirrored = Total(solution.ledger.mirrored);
  if (mirrored > 0.001 * emitted) {
    console.Warn(
        Format("%.1f", 100 * mirrored / emitted) +
        " % of the emitted power fell on ideal mirrors, where shooting stops: light thrown by mirrors "
        "is missing from the lobes; --transport links follows it");
  }
  if (JudgeSolution(solution) == Trust::kCoarse) console.Warn(TrustSentence(solution));
  console.Say(MeshText(solution));
  console.Say(StopText(solution) + Format("; %.2f s", solution.solve_seconds) +
              Format(" (%.2f CPU s)", cpu_seconds));
  console.Say("wrote " + flags.output);
  if (console.json()) console.Result("", SolveJson(solution, split, cpu_seconds, flags.output));

  if (solution.stop_reason == StopReason::kConverged) {
    if (JudgeSolution(solution) != Trust::kWrong) return kDone;
    PrintError(flags.output + ": was saved, but " + TrustSentence(solution));
    return kNotTrusted;
  }
  PrintError("stopped early, " + StopText(solution) + "; the solution was saved as " + flags.output +
             ", and --resume goes on from it");
  return kStoppedEarly;
}

}  // namespace

void AddSolveCommand(CLI::App& app, Command* command) {
  auto flags = std::make_shared<SolveFlags>();
  CLI::App* solve = app.add_subcommand("solve", "Solve a scene: fill every node's lobe");
  solve->footer(
      "Reads a glTF 2.0 scene (.glb or .gltf), cuts its surfaces into elements, and lets light bounce until\n"
      "less than --residual of the emitted power is left. Lengths are in metres; a glTF emissive strength of "
      "1\n"
      "is a radiance of 1 W/(m2 sr). An interrupt (Ctrl-C) or a limit saves what there is and exits with 3;\n"
      "a solution whose mesh made or lost more than a tenth of the light is saved, and the exit code is 4;\n"
      "--resume goes on from there to the same bits, and a solve that was killed from its last checkpoint.\n"
      "\n"
      "Examples:\n"
      "  lobe solve scene.glb -o solution.glb\n"
      "  lobe solve scene.glb -o fine.glb --edge 0.1 --light-samples 256 --max-seconds 600\n"
      "  lobe solve --resume fine.glb --max-seconds 0");
  solve->add_option("SCENE", flags->scene, "glTF scene, .glb or .gltf; with --resume it may be left out")
      ->type_name("");
  solve
      ->add_option("-o,--output", flags->output,
                   "Solution to write, .glb or .gltf; with --resume, by default what is resumed")
      ->type_name("FILE");
  solve
      ->add_option("--resume", flags->resume,
                   "Go on from a solution that stopped early, with its settings; of these only --residual, "
                   "--max-steps and --max-seconds can be changed")
      ->type_name("FILE");
  SolveOptions& o = flags->options;
  solve->add_option("--edge", o.mesh.max_edge, "Longest edge of an element, metres")
      ->type_name("M")
      ->capture_default_str();
  solve
      ->add_option("--contact-distance", o.contact_distance,
                   "Cut surfaces where others touch them or come nearer than this, metres; 0: nowhere")
      ->type_name("M")
      ->capture_default_str();
  solve
      ->add_option("--refine-error", flags->refine_error_percent,
                   "Split elements where light bends by more, percent of the brightness there; 0: never")
      ->type_name("PCT")
      ->capture_default_str();
  solve
      ->add_option(
          "--contact-error", flags->contact_error_percent,
          "Beside contacts, split also where reflected light bends by more, percent of the brightness "
          "there; 4 is accurate to a millimetre and takes several times as long; 0: never")
      ->type_name("PCT")
      ->capture_default_str();
  solve->add_option("--refine-rounds", o.refine.rounds, "Rounds of splitting; two of them halve an edge")
      ->type_name("N")
      ->capture_default_str();
  solve->add_option("--max-nodes", o.refine.max_nodes, "Split no further beyond so many nodes")
      ->type_name("N")
      ->capture_default_str();
  flags->lobes.AddTo(solve);
  const std::map<std::string, Transport> transports = {
      {"shooting", Transport::kShooting}, {"links", Transport::kLinks}, {"auto", Transport::kAuto}};
  solve
      ->add_option("--transport", o.transport,
                   "How reflected light travels: by shooting, through links, or auto, which is links")
      ->transform(CLI::CheckedTransformer(transports, CLI::ignore_case).description(""))
      ->type_name("HOW")
      ->default_str("auto");
  solve
      ->add_option("--links", o.links,
                   "Links (rays traced once) per diffuse node; glossy nodes take more, by their degree")
      ->type_name("M")
      ->capture_default_str();
  solve->add_flag_callback(
      "--plain-sweeps", [&o] { o.accelerate = false; },
      "No shooting ahead and no thinner links for dim bounces: slower, to check these against");
  solve->add_option("--light-samples", o.light_samples, "Shadow rays per node over all lamps together")
      ->type_name("N")
      ->capture_default_str();
  solve
      ->add_option("--delta-areas", o.delta_areas,
                   "With --transport shooting: delta areas (one shadow ray each) per node and step")
      ->type_name("N")
      ->capture_default_str();
  solve
      ->add_option(
          "--residual", o.residual,
          "Stop when unshot over emitted power is below this, between 0 and 1, and in dim places, too, "
          "all but 15 times that of their own light has been passed on")
      ->type_name("R")
      ->capture_default_str();
  solve
      ->add_option("--step-fraction", o.step_fraction,
                   "With --transport shooting: share of the unshot power that a step shoots, above 0 to 1")
      ->type_name("F")
      ->capture_default_str();
  solve->add_option("--max-steps", o.max_steps, "Stop after so many steps of reflected light")
      ->type_name("N")
      ->capture_default_str();
  solve->add_option("--max-seconds", o.max_seconds, "Stop this run after so many seconds; 0: no limit")
      ->type_name("S")
      ->capture_default_str();
  solve
      ->add_option("--checkpoint-seconds", flags->checkpoint_seconds,
                   "Save what there is so far about so often, under the output's name; 0: never")
      ->type_name("S")
      ->capture_default_str();
  solve
      ->add_option(
          "--max-memory", flags->max_memory_gigabytes,
          "Memory to take at most, GB; what needs more is refused, and refinement stops before it [what "
          "the machine has available]")
      ->type_name("GB");
  AddSeedFlag(solve, &o.seed);
  solve->callback([flags, solve, command] {
    *command = [flags, solve](Console& console) { return RunSolve(*flags, *solve, console); };
  });
}

}  // namespace lobe
