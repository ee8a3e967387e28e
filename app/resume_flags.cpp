#include "app/resume_flags.h"

#include <charconv>
#include <functional>
#include <map>
#include <set>

#include "app/commands.h"

namespace lobe {
namespace {

using Value = std::function<std::string(const SolveOptions&)>;

// Flags that may differ from run to run: limits, and what says nothing about light.
const std::set<std::string> kFree = {"SCENE",       "--output",      "--resume",     "--residual",
                                     "--max-steps", "--max-seconds", "--threads",    "--json",
                                     "--quiet",     "--help",        "--max-memory", "--checkpoint-seconds"};

std::string Number(double value) { return Format("%.9g", value); }

// The fewest digits that tell it from other floats: 0.3, not 0.300000012.
std::string Number(float value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

// What decides about the solution, by flag, as the flag would be given.
const std::map<std::string, Value>& Settings() {
  static const std::map<std::string, Value> settings = {
      {"--edge", [](const SolveOptions& o) { return Number(o.mesh.max_edge); }},
      {"--contact-distance", [](const SolveOptions& o) { return Number(o.contact_distance); }},
      {"--lmax", [](const SolveOptions& o) { return std::to_string(o.lobes.l_max); }},
      {"--lobe-error", [](const SolveOptions& o) { return Number(100 * o.lobes.error); }},
      {"--force-lmax",
       [](const SolveOptions& o) {
         return o.lobes.force_l_max < 0 ? std::string("none") : std::to_string(o.lobes.force_l_max);
       }},
      {"--refine-error", [](const SolveOptions& o) { return Number(100 * o.refine.error); }},
      {"--contact-error", [](const SolveOptions& o) { return Number(100 * o.refine.contact_error); }},
      {"--refine-rounds", [](const SolveOptions& o) { return std::to_string(o.refine.rounds); }},
      {"--max-nodes", [](const SolveOptions& o) { return std::to_string(o.refine.max_nodes); }},
      {"--transport",
       [](const SolveOptions& o) {
         // Two names of one thing.
         return std::string(Name(o.transport == Transport::kAuto ? Transport::kLinks : o.transport));
       }},
      {"--links", [](const SolveOptions& o) { return std::to_string(o.links); }},
      {"--plain-sweeps", [](const SolveOptions& o) { return std::string(o.accelerate ? "no" : "yes"); }},
      {"--light-samples", [](const SolveOptions& o) { return std::to_string(o.light_samples); }},
      {"--delta-areas", [](const SolveOptions& o) { return std::to_string(o.delta_areas); }},
      {"--step-fraction", [](const SolveOptions& o) { return Number(o.step_fraction); }},
      {"--seed", [](const SolveOptions& o) { return std::to_string(o.seed); }}};
  return settings;
}

std::string Flag(const CLI::Option& option) {
  return option.get_lnames().empty() ? option.get_name() : "--" + option.get_lnames().front();
}

bool Given(const CLI::App& command, const std::string& flag) {
  const CLI::Option* option = command.get_option_no_throw(flag);
  return option && option->count() > 0;
}

}  // namespace

void RefuseOtherSettings(const CLI::App& command, const SolveOptions& given, const SolveOptions& own,
                         const std::string& file) {
  for (const CLI::Option* option : command.get_options()) {
    const std::string flag = Flag(*option);
    if (option->count() == 0 || kFree.contains(flag)) continue;
    const auto setting = Settings().find(flag);
    if (setting == Settings().end()) {
      throw UsageError(flag + " cannot be given with --resume, which goes on with the settings of " + file);
    }
    const std::string wanted = setting->second(given), found = setting->second(own);
    if (wanted != found) {
      throw UsageError(flag + ": " + wanted + " differs from the " + found + " that " + file +
                       " was solved with, and --resume cannot change it; leave it out, or solve anew");
    }
  }
}

SolveOptions WithGivenLimits(const CLI::App& command, const SolveOptions& given, SolveOptions own) {
  if (Given(command, "--residual")) own.residual = given.residual;
  if (Given(command, "--max-steps")) own.max_steps = given.max_steps;
  if (Given(command, "--max-seconds")) own.max_seconds = given.max_seconds;
  return own;
}

}  // namespace lobe
