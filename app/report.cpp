#include "app/report.h"

#include <algorithm>
#include <chrono>

#include "app/console.h"
#include "brdf/lobe_accuracy.h"
#include "solver/exposure.h"

namespace lobe {
namespace {

using nlohmann::json;

struct LedgerEntry {
  const char* name;
  Ledger::Power Ledger::*power;
  const char* meaning;
};
constexpr LedgerEntry kLedger[] = {
    {"emitted", &Ledger::emitted, "by the lamps"},
    {"imbalance", &Ledger::imbalance, "made (+) or lost (-) by the mesh"},
    {"absorbed", &Ledger::absorbed, "by surfaces"},
    {"in glass", &Ledger::in_glass, "absorbed on the way through glass"},
    {"blocked", &Ledger::blocked, "by black backs and unlit sides"},
    {"escaped", &Ledger::escaped, "out of the scene"},
    {"below facets", &Ledger::below_facets, "by smooth shading, into the facet itself"},
    {"mirrored", &Ledger::mirrored, "by ideal mirrors and glass, not followed"},
    {"truncated", &Ledger::truncated, "by cut-off lobes"},
    {"unshot", &Ledger::unshot, "still waiting"},
    {"sent", &Ledger::sent, "emitted and passed on"},
    {"passed on", &Ledger::passed_on, "by mirrors and glass"},
    {"delivered", &Ledger::delivered, "of both, arrived"},
    {"reflected", &Ledger::reflected, "of that, reflected"},
};
constexpr size_t kBalanceEntries = 10;  ///< the first ones balance; the others are turnover

double Sum(const Ledger::Power& power) { return power[0] + power[1] + power[2]; }

std::string Percent(double fraction) { return Format("%.3g", 100 * fraction) + " %"; }

std::string Degree(int l_max) { return l_max < 0 ? "-" : std::to_string(l_max); }

size_t HiddenCount(const Solution& s) {
  return static_cast<size_t>(
      std::count_if(s.hidden.begin(), s.hidden.end(), [](uint8_t h) { return h != 0; }));
}

size_t LobeBytes(const Solution& s) { return s.total.bytes() + s.direct.bytes() + s.unshot.bytes(); }

Rgb EmittedPower(const Scene& scene) {
  Rgb power = Rgb::Zero();
  for (const Emitter& e : FindEmitters(scene)) power += 3.14159265f * e.area * e.radiance;
  return power;
}

// None of diffuse materials.
std::optional<LobeCost> CostOf(const BuiltLobes& built) {
  const MaterialLobes& lobes = built.lobes;
  if (lobes.diffuse()) return std::nullopt;
  const BrdfPart part = JudgedPart(lobes);
  return LobeCost{part == BrdfPart::kGloss ? lobes.gloss.error : lobes.base.error, NegativePart(lobes, part),
                  lobes.spline().knots(), lobes.lobe_bytes(), built.seconds};
}

}  // namespace

BuiltLobes BuildLobes(const Reflectance& reflectance, const LobeOptions& options, TableCache& cache) {
  const auto start = std::chrono::steady_clock::now();
  MaterialLobes lobes(reflectance, options, cache);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  return {std::move(lobes), taken.count()};
}

json ToJson(const Rgb& c) { return {c[0], c[1], c[2]}; }
json ToJson(const Vec3& v) { return {v[0], v[1], v[2]}; }

std::vector<MaterialRow> MaterialRows(const Scene& scene, const LobeOptions& options) {
  TableCache cache;
  std::vector<MaterialRow> rows;
  for (const Material& m : scene.materials) {
    const BuiltLobes built = BuildLobes(m.reflectance, options, cache);
    rows.push_back({m.name, Describe(m.reflectance), built.lobes.kind(), built.lobes.transmits(),
                    built.lobes.base.l_max, built.lobes.gloss.l_max, built.lobes.gloss.error.total,
                    CostOf(built), m.emission});
  }
  return rows;
}

std::vector<MaterialRow> MaterialRows(const Solution& solution) {
  std::vector<MaterialRow> rows;
  for (size_t i = 0; i < solution.scene.materials.size(); ++i) {
    const Material& m = solution.scene.materials[i];
    rows.push_back({m.name,
                    Describe(m.reflectance),
                    solution.material_kinds[i],
                    m.transmits(),
                    -1,
                    -1,
                    solution.material_errors[i],
                    {},
                    m.emission});
  }
  for (size_t p = 0; p < solution.mesh.patches.size(); ++p) {
    MaterialRow& row = rows[solution.mesh.patches[p].material];
    row.l_max_base = solution.total.patch_degrees(uint32_t(p)).base;
    row.l_max_gloss = solution.total.patch_degrees(uint32_t(p)).gloss;
  }
  return rows;
}

void MeasureLobes(const Scene& scene, const LobeOptions& options, std::vector<MaterialRow>* rows) {
  TableCache cache;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    (*rows)[i].cost = CostOf(BuildLobes(scene.materials[i].reflectance, options, cache));
  }
}

std::string MaterialText(const std::vector<MaterialRow>& rows) {
  Table table("lllrrrr");
  table.AddRow({"material", "model", "kind", "l_max base", "gloss", "lobe error", "radiance"});
  for (const MaterialRow& r : rows) {
    const bool has_lobe = r.kind == GlossKind::kLobe || r.kind == GlossKind::kSharp;
    const bool emits = (r.emission > 0).any();
    table.AddRow({r.name.empty() ? "(unnamed)" : r.name, r.model,
                  Name(r.kind) + std::string(r.translucent ? ", translucent" : ""), Degree(r.l_max_base),
                  Degree(r.l_max_gloss), has_lobe ? Percent(r.lobe_error) : "-",
                  emits ? Short(Luminance(r.emission)) : "-"});
  }
  return table.Text();
}

std::string LobeCostText(const std::vector<MaterialRow>& rows) {
  Table table("lrrrrrrr");
  table.AddRow({"lobes of", "error", "truncation", "between knots", "negative", "knots", "a lobe", "build"});
  bool any = false;
  for (const MaterialRow& r : rows) {
    if (!r.cost) continue;
    any = true;
    table.AddRow({r.name.empty() ? "(unnamed)" : r.name, Percent(r.cost->error.total),
                  Percent(r.cost->error.truncated), Percent(r.cost->error.between), Percent(r.cost->negative),
                  std::to_string(r.cost->knots), Bytes(double(r.cost->lobe_bytes)),
                  Format("%.1f ms", 1e3 * r.cost->build_seconds)});
  }
  return any ? table.Text() : "";
}

json MaterialJson(const std::vector<MaterialRow>& rows) {
  json list = json::array();
  for (const MaterialRow& r : rows) {
    json entry = {{"name", r.name},
                  {"model", r.model},
                  {"kind", Name(r.kind)},
                  {"translucent", r.translucent},
                  {"lobe_error", r.lobe_error},
                  {"emission", ToJson(r.emission)}};
    entry["l_max_base"] = r.l_max_base < 0 ? json() : json(r.l_max_base);
    entry["l_max_gloss"] = r.l_max_gloss < 0 ? json() : json(r.l_max_gloss);
    if (r.cost) {
      entry["lobes"] = {{"error", r.cost->error.total},
                        {"truncated", r.cost->error.truncated},
                        {"between_knots", r.cost->error.between},
                        {"negative_part", r.cost->negative},
                        {"knots", r.cost->knots},
                        {"lobe_bytes", r.cost->lobe_bytes},
                        {"build_seconds", r.cost->build_seconds}};
    }
    list.push_back(std::move(entry));
  }
  return list;
}

std::string LedgerText(const Ledger& ledger) {
  const double emitted = Sum(ledger.emitted);
  Table table("lrrrrl");
  table.AddRow({"power", "R [W]", "G [W]", "B [W]", "of emitted", ""});
  for (size_t i = 0; i < std::size(kLedger); ++i) {
    if (i == kBalanceEntries) table.AddRow({""});
    const Ledger::Power& p = ledger.*kLedger[i].power;
    const bool rare = kLedger[i].power == &Ledger::in_glass || kLedger[i].power == &Ledger::below_facets;
    if (rare && Sum(p) == 0) continue;
    table.AddRow({kLedger[i].name, Short(p[0]), Short(p[1]), Short(p[2]),
                  emitted > 0 ? Format("%.2f %%", 100 * Sum(p) / emitted) : "-", kLedger[i].meaning});
  }
  return table.Text() + "  balance closes to " + Format("%.1e", ledger.Closure()) + "; imbalance " +
         Percent(ledger.RelativeImbalance()) + " of what was delivered\n";
}

json LedgerJson(const Ledger& ledger) {
  json out = {{"closure", ledger.Closure()}, {"relative_imbalance", ledger.RelativeImbalance()}};
  for (const LedgerEntry& entry : kLedger) out[entry.name] = ledger.*entry.power;
  return out;
}

json HistoryJson(const std::vector<StepRecord>& history) {
  json list = json::array();
  for (const StepRecord& r : history) {
    list.push_back({{"step", r.step},
                    {"residual", r.residual},
                    {"seconds", r.seconds},
                    {"rays", r.rays},
                    {"shooters", r.shooters}});
  }
  return list;
}

json SettingsJson(const SolveOptions& o) {
  return {{"edge", o.mesh.max_edge},
          {"lmax", o.lobes.l_max},
          {"force_lmax", o.lobes.force_l_max < 0 ? json() : json(o.lobes.force_l_max)},
          {"lobe_error", o.lobes.error},
          {"contact_distance", o.contact_distance},
          {"refine_error", o.refine.error},
          {"contact_error", o.refine.contact_error},
          {"refine_rounds", o.refine.rounds},
          {"max_nodes", o.refine.max_nodes},
          {"transport", Name(o.transport)},
          {"links", o.links},
          {"accelerate", o.accelerate},
          {"light_samples", o.light_samples},
          {"delta_areas", o.delta_areas},
          {"residual", o.residual},
          {"step_fraction", o.step_fraction},
          {"max_steps", o.max_steps},
          {"max_seconds", o.max_seconds},
          {"seed", o.seed}};
}

std::string StopText(const Solution& s) {
  const size_t steps = s.history.empty() ? 0 : s.history.size() - 1;
  return std::string(Name(s.stop_reason)) + ": " + Percent(s.residual()) +
         " of the emitted power is unshot after " + Count(steps, "step") + " of reflected light" +
         (s.resumed > 0 ? ", resumed " + Count(size_t(s.resumed), "time") : "") +
         (s.stop_reason == StopReason::kUnfinished ? " (a checkpoint: --resume goes on from it)" : "");
}

json SceneJson(const Scene& scene) {
  json cameras = json::array();
  for (const Camera& c : scene.cameras) {
    cameras.push_back({{"name", c.name},
                       {"eye", ToJson(c.eye)},
                       {"direction", ToJson(Vec3(-c.back))},
                       {"fov_y_degrees", c.fov_y * 180 / 3.14159265f},
                       {"aspect", c.aspect}});
  }
  const auto bounds = scene.Bounds();
  return {{"faces", scene.faces.size()},
          {"vertices", scene.positions.size()},
          {"surfaces", scene.surface_names.size()},
          {"emitting_faces", FindEmitters(scene).size()},
          {"emitted_power", ToJson(EmittedPower(scene))},
          {"bounds", bounds.isEmpty()
                         ? json()
                         : json{{"min", ToJson(Vec3(bounds.min()))}, {"max", ToJson(Vec3(bounds.max()))}}},
          {"cameras", cameras},
          {"warnings", scene.warnings}};
}

std::string SceneText(const Scene& scene) {
  const Rgb power = EmittedPower(scene);
  std::string text = "  " + Count(scene.faces.size(), "triangle") + " in " +
                     Count(scene.surface_names.size(), "surface") + ", " +
                     Count(FindEmitters(scene).size(), "emitting side") + " of " + Short(power[0]) + ", " +
                     Short(power[1]) + ", " + Short(power[2]) + " W\n";
  if (const auto bounds = scene.Bounds(); !bounds.isEmpty()) {
    const Vec3 size = bounds.sizes();
    text += "  " + Short(size.x()) + " x " + Short(size.y()) + " x " + Short(size.z()) + " m\n";
  }
  text += "  cameras: ";
  for (const Camera& c : scene.cameras) {
    if (&c != scene.cameras.data()) text += ", ";
    text += "'" + c.name + "'";
  }
  return text + (scene.cameras.empty() ? "none\n" : "\n");
}

json MeshJson(const Solution& s) {
  return {
      {"nodes", s.mesh.node_count()},     {"elements", s.mesh.element_count()},
      {"patches", s.mesh.patches.size()}, {"hidden_nodes", HiddenCount(s)},
      {"lobe_bytes", LobeBytes(s)},       {"coefficients_per_channel", s.total.bytes() / sizeof(float) / 3}};
}

std::string MeshText(const Solution& s) {
  return "  " + Count(s.mesh.node_count(), "node") + " (" + std::to_string(HiddenCount(s)) + " hidden), " +
         Count(s.mesh.element_count(), "element") + " in " + std::to_string(s.mesh.patches.size()) +
         " patch" + (s.mesh.patches.size() == 1 ? "" : "es") + "\n  lobes: " + Bytes(double(LobeBytes(s))) +
         ", " +
         Short(s.mesh.node_count() > 0
                   ? double(s.total.bytes()) / sizeof(float) / 3 / double(s.mesh.node_count())
                   : 0.0) +
         " coefficients a channel per node on average\n";
}

}  // namespace lobe
