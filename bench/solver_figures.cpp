// Prints the solver's figures of docs/validation.md as Markdown: solver_figures TOPIC. Topics are listed
// without one. Run from the project's root.

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <tbb/global_control.h>

#include "bench/timing.h"
#include "bench/topics.h"
#include "scene/gltf_scene.h"
#include "solver/solver.h"
#include "tests/support/gloss_furnace.h"
#include "tests/support/metal.h"
#include "tests/support/scene_builder.h"
#include "tests/support/truth.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;
const std::string kTests = "tests";

MetallicRoughness Metal(float roughness) { return test::Metal(roughness, Rgb::Constant(0.9f)); }

struct NodeError {
  double mean, worst;
  size_t nodes;
};
NodeError Furnace(float edge, bool block) {
  test::SceneBuilder b;
  const uint32_t wall = b.AddMaterial("wall", Lambert{Rgb::Constant(0.5f)}, Rgb::Constant(1));
  b.AddBox({0, 0, 0}, {4, 3, 5}, wall, true);
  if (block) b.AddBox({1, 1, 1}, {2, 2, 2}, wall);
  SolveOptions o;
  o.mesh.max_edge = edge;
  o.residual = 1e-5;
  const Solution s = Solve(b.Build(), o);
  const auto area = NodeAreas(s.mesh, s.hidden);
  NodeError out{0, 0, s.mesh.node_count()};
  double sum = 0;
  for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
    const double radiance = 1 + s.total.Flux(n)[1] / kPi;
    out.mean += area[n] * radiance;
    sum += area[n];
    out.worst = std::max(out.worst, std::abs(radiance / 2 - 1));
  }
  out.mean /= sum;
  return out;
}

void Furnaces() {
  std::printf(
      "| closed room, emission 1, albedo 0.5 | nodes | mean radiance (2) | worst node "
      "|\n|---|---|---|---|\n");
  for (const bool block : {false, true}) {
    for (const float edge : {1.0f, 0.5f, 0.25f}) {
      const NodeError e = Furnace(edge, block);
      std::printf("| %s | %zu | %.4f | %.2f %% |\n", block ? "with a floating block" : "empty", e.nodes,
                  e.mean, 100 * e.worst);
    }
  }
  std::printf(
      "\n| block in a white furnace | stated error | worst node, lobe against a(wo) |\n|---|---|---|\n");
  for (const float roughness : {1.0f, 0.5f, 0.3f}) {
    const test::GlossFurnace metal(Metal(roughness));
    std::printf("| metal, roughness %.1f | %.1f %% | %.2f %% |\n", double(roughness), 100 * metal.stated,
                100 * metal.worst);
  }
  const test::GlossFurnace phong(Phong{Rgb::Constant(0.8f), 20});
  std::printf("| Phong 20 | %.1f %% | %.2f %% |\n", 100 * phong.stated, 100 * phong.worst);
}

void FormFactors() {
  const double parallel =
      2 / kPi * (std::log(std::sqrt(4.0 / 3)) + 2 * std::sqrt(2.0) * std::atan(1 / std::sqrt(2.0)) - kPi / 2);
  const double upright =
      1 / kPi * (kPi / 2 - std::sqrt(2.0) * std::atan(1 / std::sqrt(2.0)) + 0.25 * std::log(0.75));
  std::printf("| unit squares | closed form | edge 0.25 | 0.1 | 0.05 |\n|---|---|---|---|---|\n");
  for (const bool is_parallel : {true, false}) {
    const double exact = is_parallel ? parallel : upright;
    std::printf("| %s | %.5f |", is_parallel ? "parallel" : "perpendicular", exact);
    for (const float edge : {0.25f, 0.1f, 0.05f}) {
      test::SceneBuilder b;
      const uint32_t lamp = b.AddEmitter(Rgb::Constant(1)), grey = b.AddLambert(Rgb::Constant(0.5f));
      if (is_parallel) {
        b.AddQuad({0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}, lamp);
      } else {
        b.AddQuad({0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, lamp);  // faces +x
      }
      b.AddQuad({0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, grey);
      SolveOptions o;
      o.mesh.max_edge = edge;
      o.max_steps = 0;
      const double f = Solve(b.Build(), o).ledger.delivered[0] / kPi;
      std::printf(" %.5f (%+.2f %%) |", f, 100 * (f / exact - 1));
    }
    std::printf("\n");
  }
}

struct Trial {
  Solution solution;
  double cpu;
};
Trial SolveFile(const std::string& name, const SolveOptions& o) {
  Scene scene = ReadGltfScene(kTests + "/scenes/" + name + ".glb");
  const double start = CpuSeconds();
  Solution s = Solve(std::move(scene), o);
  return {std::move(s), CpuSeconds() - start};
}

// "pixel / block" of each view that has references.
std::string Errors(const std::string& name, const Solution& s, double* cpu) {
  std::string out;
  const double start = CpuSeconds();
  for (const Comparison& c : test::CompareWithTruth(s, kTests, name)) {
    char text[64];
    std::snprintf(text, sizeof text, " %.2f / %.2f |", 100 * c.pixel_error, 100 * c.block_error);
    out += text;
  }
  *cpu = (CpuSeconds() - start) / double(s.scene.cameras.size());
  return out;
}

void Row(const std::string& label, const std::string& scene, const SolveOptions& o) {
  const Trial t = SolveFile(scene, o);
  double view = 0;
  const std::string errors = Errors(scene, t.solution, &view);
  std::printf("| %s | %s | %zu | %.1f | %.2f |%s %.2f %% |\n", scene.c_str(), label.c_str(),
              t.solution.mesh.node_count(), t.cpu, view, errors.c_str(),
              100 * t.solution.ledger.RelativeImbalance());
  std::fflush(stdout);
}

void Header(const char* what) {
  std::printf(
      "| scene | %s | nodes | solve, CPU s | view, CPU s | view0 pixel / block %% | view1 pixel / block %% | "
      "imbalance |\n"
      "|---|---|---|---|---|---|---|---|\n",
      what);
}

const char* const kBoxes[] = {"cornell_diffuse", "cornell_glossy"};
const char* const kScenes[] = {"cornell_diffuse", "cornell_glossy", "lampshade"};

void Cornell() {
  Header("edge");
  for (const char* scene : kBoxes) {
    for (const float edge : {1.6f, 0.8f, 0.4f, 0.2f}) {
      SolveOptions o;
      o.mesh.max_edge = edge;
      char label[16];
      std::snprintf(label, sizeof label, "%.1f m", double(edge));
      Row(label, scene, o);
    }
  }
}

template <typename T>
void Sweep(const char* what, const std::vector<T>& values, const std::function<void(SolveOptions&, T)>& set,
           const std::vector<const char*>& scenes) {
  Header(what);
  for (const char* scene : scenes) {
    for (const T value : values) {
      SolveOptions o;
      set(o, value);
      char label[32];
      std::snprintf(label, sizeof label, "%g", double(value));
      Row(label, scene, o);
    }
  }
}

void LightSamples() {
  Sweep<int>("light samples", {8, 16, 32, 64, 128, 256}, [](SolveOptions& o, int v) { o.light_samples = v; },
             {kBoxes[0]});
}
void DeltaAreas() {
  Sweep<int>("delta areas", {32, 64, 128, 256, 512, 1024},
             [](SolveOptions& o, int v) {
               o.transport = Transport::kShooting;
               o.delta_areas = v;
             },
             {kBoxes[0], kBoxes[1]});
}
void Portions() {
  Sweep<double>("step fraction", {1, 0.9, 0.5, 0.25},
                [](SolveOptions& o, double v) {
                  o.transport = Transport::kShooting;
                  o.step_fraction = v;
                },
                {kBoxes[0]});
}
void Border() {
  Sweep<double>("border inset", {0.001, 0.02, 0.1, 0.3},
                [](SolveOptions& o, double v) { o.mesh.border_inset = float(v); }, {kBoxes[0]});
}
void Contacts() {
  for (const float edge : {0.8f, 0.4f, 0.2f}) {
    char what[64];
    std::snprintf(what, sizeof what, "contact distance, edge %g m", double(edge));
    Sweep<double>(what, {0, 0.002},
                  [edge](SolveOptions& o, double v) {
                    o.mesh.max_edge = edge;
                    o.contact_distance = float(v);
                  },
                  {kBoxes[0], kBoxes[1]});
  }
  std::printf("| scene | nodes, not cut | cut | hidden, not cut | cut |\n|---|---|---|---|---|\n");
  for (const char* name : {"cornell_diffuse", "glossy_floor", "lampshade", "furnace_glossy"}) {
    size_t nodes[2];
    ptrdiff_t hidden[2];
    for (const int cut : {0, 1}) {
      SolveOptions o;
      o.max_steps = 0;
      if (!cut) o.contact_distance = 0;
      const Solution s = SolveFile(name, o).solution;
      nodes[cut] = s.mesh.node_count();
      hidden[cut] = std::count(s.hidden.begin(), s.hidden.end(), 1);
    }
    std::printf("| %s | %zu | %zu | %td | %td |\n", name, nodes[0], nodes[1], hidden[0], hidden[1]);
  }
}
void LobeError() {
  Sweep<double>("lobe error, lmax 20", {0.5, 0.3, 0.2, 0.1, 0.05},
                [](SolveOptions& o, double v) { o.lobes.error = v; }, {kBoxes[1]});
  Sweep<int>("lmax, lobe error 10 %", {0, 4, 8, 12, 16, 20, 24},
             [](SolveOptions& o, int v) { o.lobes.l_max = v; }, {kBoxes[1]});
}
void Residual() {
  Sweep<double>("residual", {0.1, 0.01, 1e-3, 1e-4}, [](SolveOptions& o, double v) { o.residual = v; },
                {kBoxes[0]});
}

// Uniform meshes against refined ones, shooting against links.
void TransportFigures() {
  Header("transport, mesh");
  for (const char* scene : kScenes) {
    for (const Transport transport : {Transport::kShooting, Transport::kLinks}) {
      for (const bool refined : {false, true}) {
        for (const float edge : {0.8f, 0.4f, 0.2f}) {
          // Shooting on the fine meshes of the lampshade takes minutes.
          if (transport == Transport::kShooting && edge < 0.4f && scene == kScenes[2]) continue;
          SolveOptions o;
          o.transport = transport;
          o.mesh.max_edge = edge;
          if (!refined) o.refine.error = 0;
          char label[64];
          std::snprintf(label, sizeof label, "%s, %s %g m", Name(transport),
                        refined ? "refined from" : "uniform", double(edge));
          Row(label, scene, o);
        }
      }
    }
  }
}

void LinkCounts() {
  Sweep<int>("links", {64, 128, 256, 512, 1024, 2048}, [](SolveOptions& o, int v) { o.links = v; },
             {kBoxes[0], kBoxes[1]});
  Header("late bounces");
  for (const char* scene : kBoxes) {
    for (const bool accelerate : {true, false}) {
      SolveOptions o;
      o.accelerate = accelerate;
      Row(accelerate ? "shot ahead, thinner links" : "plain sweeps", scene, o);
    }
  }
}

void RefineErrors() {
  Sweep<double>("refine error", {0, 0.3, 0.2, 0.1, 0.05, 0.02},
                [](SolveOptions& o, double v) { o.refine.error = v; }, {kScenes[0], kScenes[1], kScenes[2]});
  Sweep<int>("refine rounds", {2, 4, 6, 8}, [](SolveOptions& o, int v) { o.refine.rounds = v; },
             {kScenes[0], kScenes[1], kScenes[2]});
}

// One scene, its 38 triangles cut ever finer.
void Growth() {
  std::printf(
      "| scene | nodes | links | solve, CPU s | exponent | peak memory so far, MB | bytes of lobes a node |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const char* scene : kBoxes) {
    double nodes_before = 0, cpu_before = 0;
    for (const float edge : {0.95f, 0.3f, 0.095f, 0.03f}) {
      SolveOptions o;
      o.mesh.max_edge = edge;
      o.refine.error = 0;
      o.lobes.force_l_max = 12;
      const Trial t = SolveFile(scene, o);
      rusage usage;
      getrusage(RUSAGE_SELF, &usage);
      const double nodes = double(t.solution.mesh.node_count());
      std::printf("| %s | %.0f | %.1f M | %.2f |", scene, nodes,
                  1e-6 * double(t.solution.history.back().rays), t.cpu);
      if (nodes_before > 0) {
        std::printf(" %.2f |", std::log(t.cpu / cpu_before) / std::log(nodes / nodes_before));
      } else {
        std::printf(" |");
      }
      std::printf(" %.0f | %.0f |\n", double(usage.ru_maxrss) / 1024,
                  double(t.solution.total.bytes()) / nodes);
      std::fflush(stdout);
      nodes_before = nodes;
      cpu_before = t.cpu;
    }
  }
}

void Threads() {
  std::printf("| scene | edge | one thread over two, wall time, median of 5 |\n|---|---|---|\n");
  for (const char* scene : kBoxes) {
    for (const float edge : {0.4f, 0.2f}) {
      std::vector<double> ratios;
      for (int run = 0; run < 5; ++run) {
        double seconds[2];
        for (const size_t threads : {1, 2}) {
          const tbb::global_control cap(tbb::global_control::max_allowed_parallelism, threads);
          SolveOptions o;
          o.mesh.max_edge = edge;
          seconds[threads - 1] = SolveFile(scene, o).solution.solve_seconds;
        }
        ratios.push_back(seconds[0] / seconds[1]);
      }
      std::printf("| %s | %g m | %.2f |\n", scene, double(edge), Median(ratios));
    }
  }
}

const Topics kTopics = {{"furnaces", Furnaces},
                        {"form-factors", FormFactors},
                        {"cornell", Cornell},
                        {"transport", TransportFigures},
                        {"links", LinkCounts},
                        {"refine", RefineErrors},
                        {"growth", Growth},
                        {"threads", Threads},
                        {"light-samples", LightSamples},
                        {"delta-areas", DeltaAreas},
                        {"step-fraction", Portions},
                        {"border", Border},
                        {"contacts", Contacts},
                        {"lobe-error", LobeError},
                        {"residual", Residual}};

}  // namespace
}  // namespace lobe

int main(int argc, char** argv) { return lobe::PrintTopic("solver_figures", lobe::kTopics, argc, argv); }
