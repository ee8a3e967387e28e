#include "solver/solution_json.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/gltf_output.h"

namespace lobe {
namespace {

using nlohmann::json;

constexpr size_t kIntMax = std::numeric_limits<int>::max();

constexpr StopReason kStopReasons[] = {StopReason::kConverged,     StopReason::kStepLimit,
                                       StopReason::kTimeLimit,     StopReason::kInterrupted,
                                       StopReason::kNotConverging, StopReason::kUnfinished};
constexpr GlossKind kGlossKinds[] = {GlossKind::kNone, GlossKind::kLobe, GlossKind::kSharp,
                                     GlossKind::kMirror};

constexpr Transport kTransports[] = {Transport::kShooting, Transport::kLinks, Transport::kAuto};

/// JSON has no infinity and no NaN, which a diverging solution may hold; they become the largest float.
double Finite(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return std::isnan(value) ? kLargest : std::clamp(value, -kLargest, kLargest);
}

double RequiredNumber(const GltfJson& fields, const char* name) {
  if (!fields.Has(name)) fields.FailValue(name, "a number");
  return fields.Number(name, 0);
}
float RequiredFloat(const GltfJson& fields, const char* name) {
  return static_cast<float>(RequiredNumber(fields, name));
}
int RequiredInt(const GltfJson& fields, const char* name) {
  return static_cast<int>(fields.RequiredWhole(name, kIntMax));
}

/// The value whose Name is the text of member `name`.
template <typename Enum, size_t count>
Enum ReadName(const GltfJson& fields, const char* name, const Enum (&values)[count]) {
  const std::string text = fields.String(name);
  std::string known;
  for (const Enum value : values) {
    if (text == Name(value)) return value;
    known += (known.empty() ? "'" : ", '") + std::string(Name(value)) + "'";
  }
  fields.FailValue(name, "one of " + known);
}

// One list for both directions, so that neither can forget an entry.
constexpr std::pair<const char*, Ledger::Power Ledger::*> kLedgerEntries[] = {
    {"emitted", &Ledger::emitted},     {"sent", &Ledger::sent},
    {"delivered", &Ledger::delivered}, {"absorbed", &Ledger::absorbed},
    {"inGlass", &Ledger::in_glass},    {"reflected", &Ledger::reflected},
    {"mirrored", &Ledger::mirrored},   {"truncated", &Ledger::truncated},
    {"escaped", &Ledger::escaped},     {"blocked", &Ledger::blocked},
    {"passedOn", &Ledger::passed_on},  {"unshot", &Ledger::unshot},
    {"imbalance", &Ledger::imbalance}, {"belowFacets", &Ledger::below_facets}};

// Absent from solutions of earlier versions.
bool IsOptional(Ledger::Power Ledger::*entry) {
  return entry == &Ledger::in_glass || entry == &Ledger::below_facets;
}

json Settings(const SolveOptions& o) {
  json out = {{"maxEdge", JsonNumber(o.mesh.max_edge)},
              {"creaseAngle", JsonNumber(o.mesh.crease_angle)},
              {"borderInset", JsonNumber(o.mesh.border_inset)},
              {"contactDistance", JsonNumber(o.contact_distance)},
              {"lMax", o.lobes.l_max},
              {"lobeError", o.lobes.error},
              {"refineError", o.refine.error},
              {"contactError", o.refine.contact_error},
              {"refineRounds", o.refine.rounds},
              {"maxNodes", o.refine.max_nodes},
              {"transport", Name(o.transport)},
              {"links", o.links},
              {"accelerate", o.accelerate},
              {"thinLateLinks", o.thin_late_links},
              {"lightSamples", o.light_samples},
              {"deltaAreas", o.delta_areas},
              {"residual", o.residual},
              {"stepFraction", o.step_fraction},
              {"maxSteps", o.max_steps},
              {"maxSeconds", o.max_seconds},
              {"seed", std::to_string(o.seed)}};  // 64 bits: too many for a number in JavaScript
  if (o.lobes.force_l_max >= 0) out["forceLMax"] = o.lobes.force_l_max;
  return out;
}

SolveOptions ReadSettings(const GltfJson& fields) {
  SolveOptions o;
  o.mesh.max_edge = RequiredFloat(fields, "maxEdge");
  o.mesh.crease_angle = RequiredFloat(fields, "creaseAngle");
  o.mesh.border_inset = RequiredFloat(fields, "borderInset");
  // Solutions older than contact lines have none.
  o.contact_distance = fields.Has("contactDistance") ? RequiredFloat(fields, "contactDistance") : 0.0f;
  o.lobes.l_max = RequiredInt(fields, "lMax");
  o.lobes.error = RequiredNumber(fields, "lobeError");
  o.lobes.force_l_max = fields.Has("forceLMax") ? RequiredInt(fields, "forceLMax") : -1;
  o.refine.error = RequiredNumber(fields, "refineError");
  o.refine.contact_error = fields.Number("contactError", 0);
  o.refine.rounds = RequiredInt(fields, "refineRounds");
  o.refine.max_nodes = fields.RequiredWhole("maxNodes");
  o.transport = ReadName(fields, "transport", kTransports);
  o.links = RequiredInt(fields, "links");
  o.accelerate = fields.Bool("accelerate", true);
  o.thin_late_links = fields.Bool("thinLateLinks", true);
  o.light_samples = RequiredInt(fields, "lightSamples");
  o.delta_areas = RequiredInt(fields, "deltaAreas");
  o.residual = RequiredNumber(fields, "residual");
  o.step_fraction = RequiredNumber(fields, "stepFraction");
  o.max_steps = RequiredInt(fields, "maxSteps");
  o.max_seconds = RequiredNumber(fields, "maxSeconds");
  const std::string seed = fields.String("seed");
  const auto end = seed.data() + seed.size();
  if (const auto read = std::from_chars(seed.data(), end, o.seed);
      read.ptr != end || read.ec != std::errc()) {
    fields.FailValue("seed", "a string of decimal digits, below 2^64");
  }
  if (const std::string wrong = o.Validate(); !wrong.empty()) fields.Fail("settings: " + wrong);
  return o;
}

}  // namespace

const char* Name(Side side) { return side == Side::kFront ? "front" : "back"; }

json SolutionRecord(const Solution& solution) {
  json record;
  record["settings"] = Settings(solution.options);

  record["materials"] = json::array();
  for (size_t m = 0; m < solution.material_kinds.size(); ++m) {
    record["materials"].push_back(
        {{"kind", Name(solution.material_kinds[m])}, {"error", Finite(solution.material_errors[m])}});
  }

  for (const auto& [name, entry] : kLedgerEntries) {
    const Ledger::Power& power = solution.ledger.*entry;
    if (IsOptional(entry) && power == Ledger::Power{}) continue;
    record["ledger"][name] = {Finite(power[0]), Finite(power[1]), Finite(power[2])};
  }

  record["history"] = json::array();
  for (const StepRecord& step : solution.history) {
    record["history"].push_back({{"step", step.step},
                                 {"residual", Finite(step.residual)},
                                 {"seconds", step.seconds},
                                 {"rays", step.rays},
                                 {"shooters", step.shooters}});
  }
  record["stopReason"] = Name(solution.stop_reason);
  if (solution.resumed > 0) record["resumed"] = solution.resumed;
  record["solveSeconds"] = solution.solve_seconds;
  return record;
}

void ReadSolutionRecord(const GltfJson& record, Solution* solution) {
  solution->options = ReadSettings(record.Object("settings"));

  for (size_t m = 0; m < record.Count("materials"); ++m) {
    const GltfJson fields = record.Entry("materials", m, "materials");
    solution->material_kinds.push_back(ReadName(fields, "kind", kGlossKinds));
    solution->material_errors.push_back(RequiredNumber(fields, "error"));
  }

  const GltfJson ledger = record.Object("ledger");
  for (const auto& [name, entry] : kLedgerEntries) {
    if (!ledger.Numbers(name, 3, (solution->ledger.*entry).data()) && !IsOptional(entry))
      ledger.FailValue(name, "3 numbers");
  }

  for (size_t i = 0; i < record.Count("history"); ++i) {
    const GltfJson fields = record.Entry("history", i, "history");
    StepRecord step;
    step.step = RequiredInt(fields, "step");
    step.residual = RequiredNumber(fields, "residual");
    step.seconds = RequiredNumber(fields, "seconds");
    step.rays = fields.RequiredWhole("rays");
    step.shooters =
        static_cast<uint32_t>(fields.RequiredWhole("shooters", std::numeric_limits<uint32_t>::max()));
    solution->history.push_back(step);
  }
  solution->stop_reason = ReadName(record, "stopReason", kStopReasons);
  if (record.Has("resumed")) solution->resumed = RequiredInt(record, "resumed");
  solution->solve_seconds = RequiredNumber(record, "solveSeconds");
}

}  // namespace lobe
