// Prints the renderer's figures of docs/validation.md as Markdown, and draws them into docs/images:
// render_figures TOPIC. Topics are listed without one. Run from the project's root. (What the path tracer's
// rays cost: `figures paths`.)

#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/log_log_plot.h"
#include "bench/timing.h"
#include "bench/topics.h"
#include "render/compare.h"
#include "render/exr.h"
#include "render/path_tracing.h"
#include "render/renderer.h"
#include "scene/gltf_scene.h"
#include "solver/solver.h"

namespace lobe {
namespace {

const std::string kTests = "tests", kImages = "docs/images";
const char* const kScenes[] = {"cornell_glossy", "glossy_floor", "lampshade"};
constexpr float kDefaultEdge = 0.4f, kCoarseEdge = 0.8f, kFineEdge = 0.2f;

// A scene, its views, and what they should look like.
struct Subject {
  struct Truth {
    Image a, b;
    Mask mask;
  };
  std::string name;
  Scene scene;
  std::vector<Truth> truths;  // by camera

  explicit Subject(const std::string& scene_name)
      : name(scene_name), scene(ReadGltfScene(kTests + "/scenes/" + scene_name + ".glb")) {
    for (const Camera& camera : scene.cameras) {
      const std::string path = kTests + "/truth/" + name + "." + camera.name;
      truths.push_back({ReadExr(path + ".a.exr"), ReadExr(path + ".b.exr"), ReadPngMask(path + ".mask.png")});
    }
  }
};

struct ViewErrors {
  double pixel, block;
};

// One setting, on every view.
struct Measurement {
  float edge = 0;  // 0: path tracer
  std::string mode;
  int samples = 0, gather_samples = 0;
  double preparation = 0;     // CPU s before the first view
  std::vector<double> views;  // CPU s of each
  std::vector<ViewErrors> errors;

  double further_view() const {
    return std::accumulate(views.begin(), views.end(), 0.0) / double(views.size());
  }
  double first_view() const { return preparation + further_view(); }
  // Over the views, as one picture of them all would have it.
  double Rms(double ViewErrors::*figure) const {
    double sum = 0;
    for (const ViewErrors& e : errors) sum += e.*figure * (e.*figure);
    return std::sqrt(sum / double(errors.size()));
  }
};

using RenderView = std::function<Image(const CameraView&, const RenderOptions&)>;

// Quick pictures are timed as the median of three.
Measurement Measure(const Subject& subject, const RenderView& render, const RenderOptions& base) {
  constexpr double kQuick = 0.3;
  Measurement m;
  m.samples = base.samples_per_pixel;
  for (size_t i = 0; i < subject.truths.size(); ++i) {
    const Subject::Truth& truth = subject.truths[i];
    RenderOptions o = base;
    o.width = truth.a.width;
    o.height = truth.a.height;
    const CameraView view(subject.scene.cameras[i], o.width, o.height);
    Image image;
    std::vector<double> seconds;
    do {
      const double start = CpuSeconds();
      image = render(view, o);
      seconds.push_back(CpuSeconds() - start);
    } while (seconds.size() < 3 && seconds[0] < kQuick);
    m.views.push_back(Median(seconds));
    const Comparison c = Compare(image, truth.a, &truth.b, &truth.mask);
    m.errors.push_back({c.pixel_error, c.block_error});
  }
  return m;
}

// A solve and what all its views share.
struct Solved {
  Solution solution;
  std::unique_ptr<Renderer> renderer;
  double cpu;

  Solved(const Subject& subject, float edge) {
    SolveOptions options;
    options.mesh.max_edge = edge;
    const double start = CpuSeconds();
    solution = Solve(subject.scene, options);
    renderer = std::make_unique<Renderer>(solution);
    cpu = CpuSeconds() - start;
  }
  Measurement Measured(const Subject& subject, RenderMode mode, const char* name, int samples,
                       int gather_samples) const {
    RenderOptions o;
    o.mode = mode;
    o.samples_per_pixel = samples;
    if (gather_samples > 0) o.gather_samples = gather_samples;
    Measurement m = Measure(
        subject,
        [&](const CameraView& view, const RenderOptions& with) {
          return renderer->Render(view, with, nullptr);
        },
        o);
    m.edge = solution.options.mesh.max_edge;
    m.mode = name;
    m.gather_samples = gather_samples;
    m.preparation = cpu;
    return m;
  }
};

std::vector<Measurement> PathTraced(const Subject& subject, const std::vector<int>& samples) {
  const double start = CpuSeconds();
  const PathTracer paths(subject.scene);
  const double preparation = CpuSeconds() - start;
  std::vector<Measurement> out;
  for (const int spp : samples) {
    RenderOptions o;
    o.samples_per_pixel = spp;
    out.push_back(Measure(
        subject,
        [&](const CameraView& view, const RenderOptions& with) {
          return RenderPathTraced(paths, view, with);
        },
        o));
    out.back().mode = "path";
    out.back().preparation = preparation;
  }
  return out;
}

// --- modes -----------------------------------------------------------------------------------------------

struct ModeName {
  RenderMode mode;
  const char* name;
  Drawing::Colour colour;
};
const ModeName kModes[] = {{RenderMode::kStored, "stored", {30, 110, 200}},
                           {RenderMode::kDirect, "direct", {20, 150, 90}},
                           {RenderMode::kGather, "gather", {205, 70, 40}},
                           {RenderMode::kAuto, "auto", {150, 70, 180}}};
constexpr Drawing::Colour kPathColour{40, 40, 46};

bool Gathers(RenderMode mode) { return mode == RenderMode::kGather || mode == RenderMode::kAuto; }

// Everything is tried on the default solve; coarser and finer ones show which of it is the mesh.
std::vector<Measurement> MeasureModes(const Subject& subject) {
  constexpr int kMostGathered = 256;  // samples a pixel: more would take minutes and change nothing
  std::vector<Measurement> out;
  for (const float edge : {kCoarseEdge, kDefaultEdge, kFineEdge}) {
    const Solved solved(subject, edge);
    const bool whole = edge == kDefaultEdge;
    for (const ModeName& m : kModes) {
      for (const int samples : whole ? std::vector{1, 4, 16, 64} : std::vector{4, 16}) {
        for (const int gather : !Gathers(m.mode) ? std::vector{0}
                                : whole          ? std::vector{1, 4, 16}
                                                 : std::vector{4}) {
          if (samples * gather > kMostGathered) continue;
          out.push_back(solved.Measured(subject, m.mode, m.name, samples, gather));
        }
      }
    }
  }
  const std::vector<Measurement> paths = PathTraced(subject, {4, 16, 64, 256});
  out.insert(out.end(), paths.begin(), paths.end());
  return out;
}

void PrintModes(const Subject& subject, const std::vector<Measurement>& all) {
  std::printf(
      "\n`%s`\n\n| edge | mode | samples a pixel | gather samples | first view with solve, CPU s | each "
      "further view, CPU s |",
      subject.name.c_str());
  for (const Camera& c : subject.scene.cameras) std::printf(" %s pixel / block %% |", c.name.c_str());
  std::printf("\n|---|---|---|---|---|---|");
  for (size_t i = 0; i < subject.scene.cameras.size(); ++i) std::printf("---|");
  std::printf("\n");
  for (const Measurement& m : all) {
    if (m.edge > 0) {
      std::printf("| %.1f m |", double(m.edge));
    } else {
      std::printf("| |");
    }
    std::printf(" %s | %d |", m.mode.c_str(), m.samples);
    if (m.gather_samples > 0) {
      std::printf(" %d |", m.gather_samples);
    } else {
      std::printf(" |");
    }
    std::printf(" %.2f | %.3f |", m.first_view(), m.further_view());
    for (const ViewErrors& e : m.errors) std::printf(" %.2f / %.2f |", 100 * e.pixel, 100 * e.block);
    std::printf("\n");
  }
  std::fflush(stdout);
}

// Curves of one panel: samples a pixel grow along each; the gather samples that are not the default's are
// marks.
std::vector<PlotSeries> Curves(const std::vector<Measurement>& all, double (Measurement::*seconds)() const,
                               double ViewErrors::*figure) {
  const int gather_default = RenderOptions().gather_samples;
  std::vector<PlotSeries> out;
  const auto add = [&](const std::string& name, Drawing::Colour colour, double dash, bool joined,
                       auto&& belongs) {
    PlotSeries s{name, colour, dash, joined, {}};
    for (const Measurement& m : all) {
      if (belongs(m)) s.points.emplace_back((m.*seconds)(), 100 * m.Rms(figure));
    }
    if (!s.points.empty()) out.push_back(std::move(s));
  };
  add("path tracer", kPathColour, 0, true, [](const Measurement& m) { return m.mode == "path"; });
  for (const ModeName& mode : kModes) {
    const std::string name = mode.name;
    const auto of = [&](float edge, bool by_default) {
      return [=](const Measurement& m) {
        return m.mode == name && m.edge == edge &&
               (m.gather_samples == 0 || m.gather_samples == gather_default) == by_default;
      };
    };
    add(name + ", edge 0.4 m", mode.colour, 0, true, of(kDefaultEdge, true));
    add(name + ", 1 or 16 gathered", mode.colour, 0, false, of(kDefaultEdge, false));
    add(name + ", edge 0.8 m", mode.colour, 2, true, of(kCoarseEdge, true));
    add(name + ", edge 0.2 m", mode.colour, 7, true, of(kFineEdge, true));
  }
  return out;
}

void WriteText(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

void PlotModes(const Subject& subject, const std::vector<Measurement>& all) {
  const std::string further = "CPU seconds of a further view",
                    first = "CPU seconds of a first view, with solve";
  std::vector<LogLogPanel> panels;
  for (const auto& [figure, name] :
       {std::pair{&ViewErrors::pixel, "pixel error, %"}, std::pair{&ViewErrors::block, "block error, %"}}) {
    panels.push_back({"", first, name, Curves(all, &Measurement::first_view, figure)});
    panels.push_back({"", further, name, Curves(all, &Measurement::further_view, figure)});
  }
  WriteText(kImages + "/modes_" + subject.name + ".svg",
            DrawLogLogPanels(subject.name + ", 256 x 256 pixels, views together", panels, 2).Svg());
}

void Modes() {
  for (const char* name : kScenes) {
    const Subject subject(name);
    const std::vector<Measurement> all = MeasureModes(subject);
    PrintModes(subject, all);
    PlotModes(subject, all);
  }
}

// --- ratio -----------------------------------------------------------------------------------------------

// CPU seconds at which the path tracer has an error: between measured points straight in the logarithms of
// both, beyond them by 1 / sqrt(samples), its law.
struct PathCost {
  double seconds;
  bool measured;
};
PathCost CostOfPaths(const std::vector<Measurement>& paths, size_t view, double error) {
  const auto pixel = [&](size_t i) { return paths[i].errors[view].pixel; };
  for (size_t i = 0; i + 1 < paths.size(); ++i) {
    if (error > pixel(i) || error < pixel(i + 1)) continue;
    const double t = std::log(pixel(i) / error) / std::log(pixel(i) / pixel(i + 1));
    return {paths[i].views[view] * std::pow(paths[i + 1].views[view] / paths[i].views[view], t), true};
  }
  const size_t end = error > pixel(0) ? 0 : paths.size() - 1;
  return {paths[end].views[view] * std::pow(pixel(end) / error, 2), false};
}

void Ratio() {
  std::printf(
      "Equal error: path tracer's seconds between measured points (16, 64 samples a pixel) straight "
      "in "
      "both logarithms;\n~ beyond them by its law, error as 1 / sqrt(samples).\n\n"
      "| view | mode | pixel error %% | a further view, CPU s | path tracer at that error, CPU s | ratio "
      "|\n|---|---|---|---|---|---|\n");
  for (const char* name : kScenes) {
    const Subject subject(name);
    const Solved solved(subject, kDefaultEdge);
    const std::vector<Measurement> paths = PathTraced(subject, {16, 64});
    const RenderOptions defaults;
    for (const ModeName& mode : kModes) {
      if (mode.mode != RenderMode::kStored && mode.mode != RenderMode::kAuto) continue;
      const Measurement m = solved.Measured(subject, mode.mode, mode.name, defaults.samples_per_pixel,
                                            Gathers(mode.mode) ? defaults.gather_samples : 0);
      for (size_t i = 0; i < m.errors.size(); ++i) {
        const double error = m.errors[i].pixel;
        const PathCost cost = CostOfPaths(paths, i, error);
        std::printf("| %s %s | %s | %.2f | %.2f | %s%.0f | %s%.0f |\n", name,
                    subject.scene.cameras[i].name.c_str(), mode.name, 100 * error, m.views[i],
                    cost.measured ? "" : "~", cost.seconds, cost.measured ? "" : "~",
                    cost.seconds / m.views[i]);
      }
    }
    std::fflush(stdout);
  }
}

const Topics kTopics = {{"modes", Modes}, {"ratio", Ratio}};

}  // namespace
}  // namespace lobe

int main(int argc, char** argv) { return lobe::PrintTopic("render_figures", lobe::kTopics, argc, argv); }
