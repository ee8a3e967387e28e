#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "app/brdf_spec.h"
#include "app/commands.h"
#include "app/lobe_flags.h"
#include "app/report.h"
#include "app/values.h"
#include "brdf/lobe_accuracy.h"
#include "render/brdf_plot.h"
#include "scene/glb_writer.h"
#include "scene/input_error.h"
#include "sh/lobe.h"
#include "solver/options.h"

namespace lobe {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kTableAngles[] = {0, 15, 30, 45, 60, 70, 75, 80, 85, 88};
constexpr double kSliceAngles[] = {0, 30, 60, 80};
constexpr int kDegrees[] = {0, 1, 2, 3, 4, 5, 6, 8, 10, 12, 14, 16, 20, 24, 28, 32};

struct BrdfFlags {
  std::string spec;
  LobeFlags lobes;
  std::optional<std::string> output;
};

struct DegreeRow {
  int l_max;
  LobeAccuracy accuracy;
  int knots;
  double seconds;
  size_t bytes;
};

struct BrdfStudy {
  std::string name, model;
  LobeOptions options;
  BrdfPart part;  ///< what errors are of: the gloss, if there is one
  BuiltLobes built;
  LobeAccuracy accuracy;
  std::optional<LobeAccuracy> whole;  ///< of gloss and base together, if there are both
  std::vector<AngleAccuracy> angles;
  std::vector<DegreeRow> degrees;
};

DegreeRow AtDegree(const Reflectance& r, const AccuracyMeter& meter, int l_max) {
  LobeOptions options;
  options.force_l_max = l_max;
  TableCache cache;
  const BuiltLobes built = BuildLobes(r, options, cache);
  return {l_max, meter.Measure(built.lobes), built.lobes.spline().knots(), built.seconds,
          built.lobes.lobe_bytes()};
}

BrdfStudy Study(const NamedReflectance& named, const LobeOptions& options) {
  const Reflectance& r = named.reflectance;
  TableCache cache;
  BuiltLobes built = BuildLobes(r, options, cache);
  if (built.lobes.max_degree() < 0) {
    throw InputError(named.name + ": has no lobes, being black, an ideal mirror or clear glass (" +
                     Describe(r) + ")");
  }
  const BrdfPart part = JudgedPart(built.lobes);
  const AccuracyMeter meter(r, part);
  const LobeAccuracy accuracy = meter.Measure(built.lobes);
  BrdfStudy out{named.name, Describe(r), options, part, std::move(built), accuracy, {}, {}, {}};
  if (part == BrdfPart::kGloss && out.built.lobes.base.l_max >= 0) {
    out.whole = AccuracyMeter(r, BrdfPart::kWhole).Measure(out.built.lobes);
  }
  for (const double degrees : kTableAngles) {
    const double cosine = std::cos(degrees * kRadians);
    out.angles.push_back(Compare(ProjectExactly(r, part, cosine, AccuracyMeter::kMostDegree),
                                 LobeAt(out.built.lobes, part, cosine), cosine));
  }
  // A base has a degree of its own, which no flag forces.
  if (part == BrdfPart::kGloss) {
    for (const int l : kDegrees) out.degrees.push_back(AtDegree(r, meter, l));
  }
  return out;
}

/// What is less than rounding in single precision makes of it is nothing.
std::string Percent(double fraction) { return Format("%.3g %%", fraction < 1e-6 ? 0 : 100 * fraction); }
std::string Milliseconds(double seconds) { return Format("%.1f ms", 1e3 * seconds); }
const char* PartName(const BrdfStudy& s) { return s.part == BrdfPart::kGloss ? "gloss" : "base"; }
double ThetaDegrees(const AngleAccuracy& a) { return std::acos(std::min(1.0, a.cos_theta_i)) / kRadians; }

std::string Degree(int l_max) { return l_max < 0 ? "none" : std::to_string(l_max); }

std::string CostLine(const BrdfStudy& s) {
  const MaterialLobes& lobes = s.built.lobes;
  return "gloss: " + std::string(Name(lobes.kind())) + ", lmax base " + Degree(lobes.base.l_max) +
         ", gloss " + Degree(lobes.gloss.l_max) + "; " + std::to_string(lobes.spline().knots()) + " knots, " +
         Bytes(double(lobes.lobe_bytes())) + " a lobe";
}

std::string ErrorLine(const BrdfStudy& s) {
  const LobeAccuracy& a = s.accuracy;
  return std::string(PartName(s)) + " error " + Percent(a.error.total) + " by flux: truncation " +
         Percent(a.error.truncated) + ", between knots " + Percent(a.error.between) +
         "; worst to 85 degrees " + Percent(a.worst) + " at " + Format("%.0f", a.worst_theta / kRadians) +
         "; negative part " + Percent(a.negative);
}

std::string Text(const BrdfStudy& s) {
  std::string text = s.name + ": " + s.model + "\n  " + CostLine(s) + "\n  " + ErrorLine(s) + "\n";
  if (s.whole) {
    text += "  with its base: error " + Percent(s.whole->error.total) + ", worst " + Percent(s.whole->worst) +
            ", negative part " + Percent(s.whole->negative) + "\n";
  }
  text += "  built in " + Milliseconds(s.built.seconds) + "\n\n";
  Table over_angle("rrrrrrr");
  over_angle.AddRow({"theta_i", std::string("albedo of ") + PartName(s), "of its lobes", "error",
                     "truncation", "between knots", "negative"});
  for (const AngleAccuracy& a : s.angles) {
    over_angle.AddRow({Format("%.0f", ThetaDegrees(a)), Format("%.5f", a.albedo),
                       Format("%.5f", a.lobe_albedo), Percent(a.error.total), Percent(a.error.truncated),
                       Percent(a.error.between), Percent(a.negative)});
  }
  text += over_angle.Text();
  if (s.degrees.empty()) return text;
  text += "\n";
  Table over_degree("rrrrrrrrrr");
  over_degree.AddRow({"lmax", "terms", "error", "truncation", "between knots", "worst", "negative",
                      "albedo error", "knots", "build"});
  for (const DegreeRow& d : s.degrees) {
    const LobeAccuracy& a = d.accuracy;
    over_degree.AddRow({std::to_string(d.l_max), std::to_string(CoefficientCount(d.l_max)),
                        Percent(a.error.total), Percent(a.error.truncated), Percent(a.error.between),
                        Percent(a.worst), Percent(a.negative), Format("%.1e", a.albedo_error),
                        std::to_string(d.knots), Milliseconds(d.seconds)});
  }
  return text + over_degree.Text();
}

nlohmann::json ErrorJson(const LobeError& e) {
  return {{"total", e.total}, {"truncated", e.truncated}, {"between_knots", e.between}};
}

nlohmann::json AccuracyJson(const LobeAccuracy& a) {
  return {{"error", ErrorJson(a.error)},
          {"worst_error", a.worst},
          {"worst_theta_degrees", a.worst_theta / kRadians},
          {"negative_part", a.negative},
          {"albedo_error", a.albedo_error}};
}

nlohmann::json ToJsonObject(const BrdfStudy& s) {
  const MaterialLobes& lobes = s.built.lobes;
  nlohmann::json angles = nlohmann::json::array(), degrees = nlohmann::json::array();
  for (const AngleAccuracy& a : s.angles) {
    angles.push_back({{"theta_degrees", ThetaDegrees(a)},
                      {"albedo", a.albedo},
                      {"lobe_albedo", a.lobe_albedo},
                      {"error", ErrorJson(a.error)},
                      {"negative_part", a.negative}});
  }
  for (const DegreeRow& d : s.degrees) {
    nlohmann::json row = AccuracyJson(d.accuracy);
    row.update({{"l_max", d.l_max},
                {"terms", CoefficientCount(d.l_max)},
                {"knots", d.knots},
                {"build_seconds", d.seconds},
                {"lobe_bytes", d.bytes}});
    degrees.push_back(std::move(row));
  }
  nlohmann::json out = AccuracyJson(s.accuracy);
  out.update({{"spec", s.name},
              {"model", s.model},
              {"kind", Name(lobes.kind())},
              {"part", PartName(s)},
              {"l_max_base", lobes.base.l_max < 0 ? nlohmann::json() : nlohmann::json(lobes.base.l_max)},
              {"l_max_gloss", lobes.gloss.l_max < 0 ? nlohmann::json() : nlohmann::json(lobes.gloss.l_max)},
              {"knots", lobes.spline().knots()},
              {"build_seconds", s.built.seconds},
              {"lobe_bytes", lobes.lobe_bytes()},
              {"over_theta", angles},
              {"over_l_max", degrees}});
  if (s.whole) out["with_base"] = AccuracyJson(*s.whole);
  return out;
}

/// BRDF and lobe in the plane of incidence, base and gloss together.
BrdfPlot::Slice SliceAt(const Reflectance& r, const MaterialLobes& lobes, double theta_degrees) {
  // Even, so that the grid has the pole; fine enough for peaks a third of a degree wide.
  constexpr int kSteps = 1080;
  const double theta_i = theta_degrees * kRadians;
  const Vec3d wi(std::sin(theta_i), 0, std::cos(theta_i));
  const Eigen::VectorXd lobe = LobeAt(lobes, BrdfPart::kWhole, wi.z());
  const HemisphereBasis<double> basis(DegreeOf(int(lobe.size())));
  Eigen::VectorXd h(basis.size());
  BrdfPlot::Slice slice{theta_degrees, {}, {}};
  for (int i = 0; i <= kSteps; ++i) {
    // At the very horizon BRDFs are 0 by convention; a hair above they are not.
    const double theta_o = std::clamp(-90 + 180.0 * i / kSteps, -89.99, 89.99) * kRadians;
    const Vec3d wo(-std::sin(theta_o), 0, std::cos(theta_o));
    slice.exact.push_back(Luminance(EvaluateBase(r, wi, wo) + EvaluateGloss(r, wi, wo)));
    basis.Evaluate(wo.x(), wo.y(), wo.z(), h.data());
    slice.lobe.push_back(h.dot(lobe));
  }
  return slice;
}

BrdfPlot Plot(const BrdfStudy& s, const Reflectance& r) {
  const MaterialLobes& lobes = s.built.lobes;
  BrdfPlot plot;
  plot.title = s.name == s.model ? s.name : s.name + "  (" + s.model + ")";
  plot.part = PartName(s);
  plot.notes = {CostLine(s), ErrorLine(s)};
  for (const double theta : kSliceAngles) plot.slices.push_back(SliceAt(r, lobes, theta));
  for (double theta = 0; theta <= 88; theta += 4) {
    const double cosine = std::cos(theta * kRadians);
    const AngleAccuracy a = Compare(ProjectExactly(r, s.part, cosine, AccuracyMeter::kMostDegree),
                                    LobeAt(lobes, s.part, cosine), cosine);
    plot.angles.push_back(
        {theta, a.albedo, a.lobe_albedo, a.error.total, a.error.truncated, a.error.between});
  }
  for (const DegreeRow& d : s.degrees) {
    plot.degrees.push_back(
        {d.l_max, d.accuracy.error.total, d.accuracy.worst, d.accuracy.negative, d.accuracy.albedo_error});
  }
  plot.l_max = lobes.gloss.l_max;
  plot.tolerance = s.options.force_l_max < 0 ? s.options.error : 0;
  return plot;
}

void WritePlot(const BrdfPlot& plot, const std::string& path) {
  if (Extension(path) == ".png") {
    WriteBrdfPng(plot, path);
  } else {
    const std::string svg = BrdfSvg(plot);
    WriteFileAtomically(path, {reinterpret_cast<const uint8_t*>(svg.data()), svg.size()});
  }
}

ExitCode RunBrdf(const BrdfFlags& flags, Console& console) {
  SolveOptions options;
  options.lobes = flags.lobes.Options();
  if (const std::string wrong = options.Validate(); !wrong.empty()) throw UsageError(wrong);
  if (flags.output) {
    RequireExtension("-o", *flags.output, {".png", ".svg"});
    CheckWritable(*flags.output);
  }
  const NamedReflectance named = ParseBrdfSpec(flags.spec);
  for (const std::string& warning : named.warnings) console.Warn(warning);
  const BrdfStudy study = Study(named, options.lobes);
  if (flags.output) {
    WritePlot(Plot(study, named.reflectance), *flags.output);
    console.Say("wrote " + *flags.output);
  }
  console.Result(Text(study), ToJsonObject(study));
  return kDone;
}

}  // namespace

void AddBrdfCommand(CLI::App& app, Command* command) {
  auto flags = std::make_shared<BrdfFlags>();
  CLI::App* brdf = app.add_subcommand("brdf", "Compare a BRDF with its lobes");
  brdf->footer(
      "SPEC is FILE#MATERIAL, a material of a scene or solution; a measured file (.binary as MERL's, or "
      ".csv);\n"
      "or MODEL:PARAMETER=VALUE,... Colours are one number or R/G/B, 0..1. Models, with defaults in "
      "brackets:\n" +
      BrdfModelsHelp() +
      "\n"
      "Prints what lobes lose of the gloss (of the base, if there is no gloss), measured against the model\n"
      "itself: over the incident angle, and over lmax. Errors are cos-weighted, relative, in the mean over\n"
      "theta_i by flux; the worst is that of the worst theta_i up to 85 degrees. -o draws the BRDF and its "
      "lobe\n"
      "in the plane of incidence, and both tables.\n"
      "\n"
      "Examples:\n"
      "  lobe brdf ggx:roughness=0.4,f0=0.9 -o ggx.png\n"
      "  lobe brdf scene.glb#floor --lobe-error 5\n"
      "  lobe brdf plastic:albedo=0.6/0.2/0.1,roughness=0.3 --force-lmax 12 --json");
  brdf->add_option("SPEC", flags->spec, "What to look at, see below")->type_name("")->required();
  flags->lobes.AddTo(brdf);
  brdf->add_option("-o,--output", flags->output, "Picture to write, .png or .svg")->type_name("FILE");
  brdf->callback(
      [flags, command] { *command = [flags](Console& console) { return RunBrdf(*flags, console); }; });
}

}  // namespace lobe
