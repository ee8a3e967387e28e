// The program: flags in, words and exit code out. What each command does is in its own file.

#include <charconv>
#include <csignal>
#include <exception>
#include <memory>
#include <new>
#include <optional>

#include <tbb/global_control.h>

#include "app/commands.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

constexpr const char* kDescription =
    "Lobe solves glossy global illumination once, on a mesh, and shows it from anywhere.\n"
    "Every mesh node stores the light that leaves it in every direction, as a short list of\n"
    "spherical-harmonic coefficients: its lobe. `lobe solve` fills the lobes, `lobe render` reads them.\n";

constexpr const char* kFooter =
    "Examples:\n"
    "  lobe info scene.glb\n"
    "  lobe solve scene.glb -o solution.glb --edge 0.2\n"
    "  lobe render solution.glb --camera view0 -o view.exr -o view.png --size 800x600 --mask lamps.png\n"
    "  lobe render solution.glb --all-cameras -o '{camera}.exr'\n"
    "  lobe inspect solution.glb --camera view0 --pixel 120,80 -o lobe.svg\n"
    "  lobe compare view.exr reference.exr --mask lamps.png -o difference.png\n"
    "  lobe brdf ggx:roughness=0.4,f0=0.9 -o ggx.png\n"
    "  lobe view solution.glb\n"
    "  lobe export solution.glb -o public/room --gzip\n"
    "\n"
    "Results go to standard output, progress and warnings to standard error.\n"
    "Exit codes: 0 done; 1 something was wrong with the input or the machine; 2 wrong usage;\n"
    "3 stopped early (interrupt, a time or step limit, not converging), result saved;\n"
    "4 finished and saved, but its ledger says not to trust it.\n"
    "`lobe COMMAND --help` explains a command's flags.";

void AddCommonFlags(CLI::App* command, CommonFlags* flags) {
  command->add_option("--threads", flags->threads, "Threads to use [all processors]")
      ->type_name("N")
      ->group("Common");
  command->add_flag("--json", flags->json, "Print one JSON object on standard output, nothing else")
      ->group("Common");
  command->add_flag("--quiet", flags->quiet, "No progress, warnings or tables on standard error")
      ->group("Common");
}

ExitCode Run(CLI::App& app, const CommonFlags& flags, const Command& command, bool threads_given) {
  try {
    if (threads_given && flags.threads < 1) {
      throw UsageError("--threads: " + std::to_string(flags.threads) +
                       " is out of range: 1 or more is expected");
    }
    std::optional<tbb::global_control> limit;
    if (threads_given) limit.emplace(tbb::global_control::max_allowed_parallelism, size_t(flags.threads));
    Console console(flags.json, flags.quiet);
    return command(console);
  } catch (const UsageError& e) {
    PrintError(std::string(e.what()) + " (lobe " + app.get_subcommands().front()->get_name() + " --help)");
    return kWrongUsage;
  } catch (const std::bad_alloc&) {
    const std::string name = app.get_subcommands().front()->get_name();
    PrintError(std::string("out of memory") + (name == "solve"    ? "; longer edges (--edge) need less"
                                               : name == "render" ? "; a smaller picture (--size) needs less"
                                                                  : ""));
  } catch (const std::exception& e) {
    PrintError(e.what());
  }
  return kFailed;
}

/// "Could not convert: --edge = 1,2" with what was expected; empty if `words` are others.
std::string ConversionSentence(const CLI::App& app, const std::string& words) {
  const std::string prefix = "Could not convert: ", middle = " = ";
  const size_t end = words.find(middle);
  if (words.rfind(prefix, 0) != 0 || end == std::string::npos || app.get_subcommands().empty()) return {};
  const std::string flag = words.substr(prefix.size(), end - prefix.size());
  const CLI::Option* option = app.get_subcommands().front()->get_option_no_throw(flag);
  if (!option) return {};
  // In every help text N is an integer.
  const bool integer = option->get_type_name() == "N";
  return flag + ": '" + words.substr(end + middle.size()) + "' is not " +
         (integer ? "a whole number, or too large" : "a number");
}

/// CLI11's words, or better ones where it does not know what was meant.
std::string UsageSentence(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  const auto chosen = app.get_subcommands();
  if (chosen.empty() && argc > 1 && argv[1][0] != '-') {
    return std::string("'") + argv[1] +
           "' is no command; solve, render, info, inspect, compare, brdf, view and export are (lobe --help)";
  }
  std::string sentence = error.what();
  if (const auto value = ConversionSentence(app, sentence); !value.empty()) sentence = value;
  if (dynamic_cast<const CLI::ExtrasError*>(&error) && !app.remaining(true).empty()) {
    // CLI11 lists them backwards.
    const std::string first = app.remaining(true).front();
    sentence =
        "'" + first + (first[0] == '-' ? "' is no flag of this command" : "' is one argument too many");
  }
  sentence += chosen.empty() ? " (lobe --help)" : " (lobe " + chosen.front()->get_name() + " --help)";
  return sentence;
}

int Main(int argc, char** argv) {
  CLI::App app{kDescription, "lobe"};
  app.set_version_flag("--version", "lobe " LOBE_VERSION);
  app.footer(kFooter);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);

  Command command;
  AddSolveCommand(app, &command);
  AddRenderCommand(app, &command);
  AddInfoCommand(app, &command);
  AddInspectCommand(app, &command);
  AddCompareCommand(app, &command);
  AddBrdfCommand(app, &command);
  AddViewCommand(app, &command);
  AddExportCommand(app, &command);
  CommonFlags flags;
  for (CLI::App* sub : app.get_subcommands({})) AddCommonFlags(sub, &flags);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& e) {
    PrintError(UsageSentence(app, e, argc, argv));
    return kWrongUsage;
  }
  return Run(app, flags, command, app.get_subcommands().front()->count("--threads") > 0);
}

}  // namespace

void AddSeedFlag(CLI::App* command, uint64_t* seed) {
  command->add_option("--seed", *seed, "Seed of all random choices; the same seed gives the same bits")
      ->type_name("N")
      ->capture_default_str()
      // CLI11 would wrap negative numbers around and cut off large ones.
      ->check([](const std::string& text) -> std::string {
        uint64_t value = 0;
        const char* end = text.data() + text.size();
        const auto [next, error] = std::from_chars(text.data(), end, value);
        if (error == std::errc() && next == end) return {};
        return "'" + text + "' is not a whole number from 0 to 18446744073709551615";
      });
}

}  // namespace lobe

int main(int argc, char** argv) {
  // A file size limit is an error like any other, which writing reports.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return lobe::Main(argc, argv);
  } catch (const std::exception& e) {
    lobe::PrintError(e.what());
    return lobe::kFailed;
  }
}
