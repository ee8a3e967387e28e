// How near a picture of stored light comes to the limit its eye rays set: CPU time of Renderer::Render over
// the time a bare loop around Embree needs to trace the same eye rays, one thread. Prints the table of
// docs/validation.md#render-limit. Run from the project's root: render_limit [RUNS]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <tbb/global_control.h>

#include "bench/bare_embree.h"
#include "bench/timing.h"
#include "render/eye_rays.h"
#include "render/packet_light.h"
#include "render/renderer.h"
#include "render/tile_renderer.h"
#include "scene/element_locator.h"
#include "scene/gltf_scene.h"
#include "solver/solver.h"

namespace lobe {
namespace {

constexpr int kSize = 1024, kSamples = 4;

// The picture's packets in the order of the renderer: fn(x, y, k) for packet k of the block at (x, y);
// start(tile) before those of a tile.
template <typename Start, typename Function>
void ForEachPacket(const EyeRays& eye_rays, int tile_side, const Start& start, const Function& fn) {
  const int side = eye_rays.block_side();
  const auto tile = [&](const Tile& t) {
    start(t);
    for (int y = t.y0; y < t.y1; y += side) {
      for (int x = t.x0; x < t.x1; x += side) {
        for (int k = 0; k < eye_rays.packets_per_block(); ++k) fn(x, y, k);
      }
    }
  };
  RenderOptions whole;
  whole.width = whole.height = kSize;
  ForEachTile(whole, tile_side, tile, {});
}

// CPU seconds of the stages so far: making rays, tracing them too, reading them too.
struct Stages {
  double make, trace, read;
  PacketLight::Counts counts;
};

Stages Measure(const EyeRays& eye_rays, int tile_side, const RayTracer& tracer, const Solution& solution,
               const ElementLocator& locator) {
  const std::vector<uint8_t> handled(2 * solution.scene.materials.size(), 1);
  PacketLight light(solution, locator, handled);
  const auto nothing = [](const Tile&) {};
  EyePacket rays;
  PacketHits hits;
  alignas(64) float radiance[3 * kLanes];
  volatile float sink = 0;
  const double t0 = CpuSeconds();
  ForEachPacket(eye_rays, tile_side, nothing, [&](int x, int y, int k) {
    eye_rays.Packet(x, y, k, &rays);
    sink = rays.x[0];
  });
  const double t1 = CpuSeconds();
  ForEachPacket(eye_rays, tile_side, nothing, [&](int x, int y, int k) {
    eye_rays.Packet(x, y, k, &rays);
    tracer.IntersectPacket(eye_rays.eye(), rays.x, rays.y, rays.z, &hits);
    sink = hits.u[0];
  });
  const double t2 = CpuSeconds();
  const auto start = [&](const Tile& t) {
    light.Start(eye_rays.film(), float(t.x0), float(t.y0), float(t.x1), float(t.y1));
  };
  ForEachPacket(eye_rays, tile_side, start, [&](int x, int y, int k) {
    eye_rays.Packet(x, y, k, &rays);
    tracer.IntersectPacket(eye_rays.eye(), rays.x, rays.y, rays.z, &hits);
    light.Read(rays, hits, 0xffff, radiance);
    sink = radiance[0];
  });
  const double t3 = CpuSeconds();
  return {t1 - t0, t2 - t1, t3 - t2, light.counts()};
}

void Print(const std::string& name, int runs) {
  const Solution solution = Solve(ReadGltfScene("tests/scenes/" + name + ".glb"), {});
  const Renderer renderer(solution);
  const RayTracer tracer(solution.scene);
  const ElementLocator locator(solution.mesh);
  BareEmbree bare(solution.scene);
  RenderOptions options;
  options.width = options.height = kSize;
  options.samples_per_pixel = kSamples;
  options.mode = RenderMode::kStored;
  for (const Camera& camera : solution.scene.cameras) {
    const CameraView view(camera, kSize, kSize);
    const EyeRays eye_rays(view, options);
    const int tile_side =
        TileRenderer(solution, tracer, locator, std::vector<uint8_t>(2 * solution.scene.materials.size(), 1))
            .TileSide(eye_rays, kSize, kSize);
    std::vector<Ray> rays;
    EyePacket packet;
    ForEachPacket(
        eye_rays, tile_side, [](const Tile&) {},
        [&](int x, int y, int k) {
          eye_rays.Packet(x, y, k, &packet);
          for (int i = 0; i < kLanes; ++i) rays.push_back(packet.ray(eye_rays.eye(), i));
        });
    std::vector<double> ratios, rates, make, trace, read, rest, memory;
    Stages s{};
    for (int run = 0; run < runs; ++run) {
      const double t0 = CpuSeconds();
      renderer.Render(view, options, nullptr);
      const double picture = CpuSeconds() - t0, limit = bare.Nearest(rays);
      s = Measure(eye_rays, tile_side, tracer, solution, locator);
      ratios.push_back(picture / limit);
      rates.push_back(1e-6 * double(rays.size()) / limit);
      make.push_back(s.make / limit);
      trace.push_back((s.trace - s.make) / limit);
      read.push_back((s.read - s.trace) / limit);
      const double t1 = CpuSeconds();
      const Image fresh(kSize, kSize);
      memory.push_back((CpuSeconds() - t1) / limit);
      rest.push_back((picture - s.read) / limit - memory.back());
    }
    std::printf("| %s %s | %.0f | **%.2f** | %.2f | %.2f | %.2f | %.2f | %.2f | %.3f | %.4f |\n",
                name.c_str(), camera.name.c_str(), Median(rates), Median(ratios), Median(make), Median(trace),
                Median(read), Median(memory), Median(rest), double(s.counts.lookups) / double(rays.size()),
                double(s.counts.grids + s.counts.exact_reads) / double(rays.size()));
  }
}

}  // namespace
}  // namespace lobe

int main(int argc, char** argv) {
  using namespace lobe;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 7;
  std::printf(
      "%d x %d pixels, %d samples each\n\n| view | million rays/s, bare Embree | picture over bare Embree, "
      "median | "
      "of it making rays | tracing | locating and reading | a new picture's memory | summing and the rest | "
      "lookups of elements a ray "
      "| "
      "lobes read, 16 directions at once, a ray |\n|---|---|---|---|---|---|---|---|---|---|\n",
      kSize, kSize, kSamples);
  Print("cornell_diffuse", runs);
  Print("cornell_glossy", runs);
  return 0;
}
