// How near a solve comes to the limit its rays set: CPU time of a whole solve over the time a bare loop
// around Embree needs to trace the same rays, one thread. Prints a table of docs/validation.md#ray-limit. Run
// from the project's root: ray_limit [RUNS]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <tbb/global_control.h>

#include "bench/bare_embree.h"
#include "bench/timing.h"
#include "brdf/frame.h"
#include "scene/gltf_scene.h"
#include "scene/ray_tracer.h"
#include "solver/exposure.h"
#include "solver/hash.h"
#include "solver/link_pattern.h"
#include "solver/links.h"
#include "solver/shooting.h"
#include "solver/solver.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

struct Case {
  const char* label;
  std::string scene;
  SolveOptions options;
};

void Print(const Case& test, int runs) {
  const Scene scene = ReadGltfScene("tests/scenes/" + test.scene + ".glb");
  // The rays: shadow rays to the emitters and links, for the nodes the solve ends with.
  const Solution s = Solve(scene, test.options);
  const RayTracer tracer(s.scene);
  TableCache cache;
  std::vector<MaterialLobes> materials;
  for (const auto& m : s.scene.materials) materials.emplace_back(m.reflectance, s.options.lobes, cache);
  const ShootingField emission(s.mesh, FindEmitters(s.scene));
  const SpecularSurfaces specular(s.scene);
  Receiver receiver(s.mesh, tracer, materials, specular);
  std::vector<float> out(size_t(6) * kMaxBasisSize);
  std::vector<Ray> shadow, links;
  for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
    receiver.Gather(n, emission, s.options.light_samples, 0.0f, 1, out.data());
    shadow.insert(shadow.end(), receiver.last_rays().begin(), receiver.last_rays().end());
    const MaterialLobes& m = materials[s.mesh.patches[s.mesh.node_patch[n]].material];
    LinkDirections directions(Links::PatternOf(m, s.options.links));
    directions.Start(n, s.options.seed);
    const Frame frame(s.mesh.node_normal[n]);
    const Vec3 from = s.mesh.node_sample_position[n] + s.mesh.node_sample_normal[n] * tracer.epsilon();
    for (int r = 0; r < directions.pattern().rings; ++r) {
      for (int j = 0; j < directions.pattern().sectors; ++j) {
        links.push_back(
            {from, 0, frame.ToWorld(directions.Local(r, j)), std::numeric_limits<float>::infinity()});
      }
    }
  }
  BareEmbree bare(s.scene);
  std::vector<double> ratios, rates;
  TimeSplit split;
  for (int run = 0; run < runs; ++run) {
    SolveControl control;
    split = {};
    control.time_split = &split;
    const double t0 = CpuSeconds();
    Solve(scene, test.options, control);
    const double solve = CpuSeconds() - t0;
    const double rays = bare.Nearest(links) + bare.Occlusion(shadow);
    ratios.push_back(solve / rays);
    rates.push_back(1e-6 * double(links.size() + shadow.size()) / rays);
  }
  std::sort(ratios.begin(), ratios.end());
  std::sort(rates.begin(), rates.end());
  const double whole = split.preparation + split.emission + split.links + split.reflection;
  std::printf("| %s | %zu | %.2f + %.2f | %.1f | %.2f | %.0f %% | %.0f %% | %.0f %% | %.0f %% |\n",
              test.label, s.mesh.node_count(), 1e-6 * double(shadow.size()), 1e-6 * double(links.size()),
              rates[rates.size() / 2], ratios[ratios.size() / 2], 100 * split.preparation / whole,
              100 * split.emission / whole, 100 * split.links / whole, 100 * split.reflection / whole);
}

// How fast this machine traces incoherent rays one by one among 20,000 triangles: what times are scaled by.
void PrintMachine() {
  test::SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  b.AddBox({-2, -2, -2}, {2, 2, 2}, grey, /*inward=*/true);
  for (int i = 0; i < 11; ++i) {
    const float phi = 2.4f * float(i), height = -1.5f + 0.15f * float(i);
    b.AddSphere({1.2f * std::cos(phi), height, 1.2f * std::sin(phi)}, 0.4f, grey, 22);
  }
  const Scene scene = b.Build();
  const RayTracer tracer(scene);
  RandomStream random(1);
  std::vector<Ray> rays;
  for (int i = 0; i < 1000000; ++i) {
    const auto even = [&] { return 2 * random.Next() - 1; };
    rays.push_back({1.9f * Vec3(even(), even(), even()), 0, Vec3(even(), even(), even()).normalized(),
                    std::numeric_limits<float>::infinity()});
  }
  std::vector<double> rates;
  float sink = 0;
  for (int run = 0; run < 5; ++run) {
    const double start = CpuSeconds();
    for (const Ray& ray : rays) sink += tracer.Intersect(ray).u;
    rates.push_back(1e-6 * double(rays.size()) / (CpuSeconds() - start));
  }
  std::printf("This machine: %.1f million incoherent rays a CPU second among %zu triangles%s\n\n",
              Median(rates), scene.faces.size(), sink == 0.125f ? " " : "");
}

}  // namespace
}  // namespace lobe

int main(int argc, char** argv) {
  using namespace lobe;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
  PrintMachine();
  SolveOptions forced;
  forced.lobes.force_l_max = 12;
  std::printf(
      "| scene | nodes | million shadow rays + links | million rays/s, bare Embree | solve over bare Embree, "
      "median | preparation | emission | links | sweeps |\n|---|---|---|---|---|---|---|---|---|\n");
  Print({"cornell_diffuse", "cornell_diffuse", {}}, runs);
  Print({"cornell_glossy, as authored", "cornell_glossy", {}}, runs);
  Print({"cornell_glossy, every gloss at l_max 12", "cornell_glossy", forced}, runs);
  return 0;
}
