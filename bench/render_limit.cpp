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
#include "render/renderer.h"
#include "scene/gltf_scene.h"
#include "solver/solver.h"

namespace lobe {
namespace {

constexpr int kSize = 1024, kSamples = 4;

void Print(const std::string& name, int runs) {
  const Solution solution = Solve(ReadGltfScene("tests/scenes/" + name + ".glb"), {});
  const Renderer renderer(solution);
  BareEmbree bare(solution.scene);
  RenderOptions options;
  options.width = options.height = kSize;
  options.samples_per_pixel = kSamples;
  for (const Camera& camera : solution.scene.cameras) {
    const CameraView view(camera, kSize, kSize);
    const EyeRays eye_rays(view, options);
    std::vector<Ray> rays;
    // In the order in which the renderer traces them.
    const int side = eye_rays.block_side();
    EyePacket packet;
    for (int y = 0; y < kSize; y += side) {
      for (int x = 0; x < kSize; x += side) {
        for (int k = 0; k < eye_rays.packets_per_block(); ++k) {
          eye_rays.Packet(x, y, k, &packet);
          for (int i = 0; i < kLanes; ++i) rays.push_back(packet.ray(eye_rays.eye(), i));
        }
      }
    }
    std::vector<double> ratios, rates;
    for (int run = 0; run < runs; ++run) {
      const double t0 = CpuSeconds();
      renderer.Render(view, options, nullptr);
      const double picture = CpuSeconds() - t0, limit = bare.Nearest(rays);
      ratios.push_back(picture / limit);
      rates.push_back(1e-6 * double(rays.size()) / limit);
    }
    std::printf("| %s %s | %.1f | %.2f |\n", name.c_str(), camera.name.c_str(), Median(rates),
                Median(ratios));
  }
}

}  // namespace
}  // namespace lobe

int main(int argc, char** argv) {
  using namespace lobe;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 7;
  Print("cornell_diffuse", runs);
  Print("cornell_glossy", runs);
  return 0;
}
