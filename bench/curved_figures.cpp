// Prints docs/validation.md#curved as Markdown: smooth-shaded metal of few facets, as nodes hold it and as
// mode auto shows it, against mode gather (two pictures of 16 samples and 16 gather samples, free of their
// noise).

#include <cstdio>
#include <exception>

#include "render/compare.h"
#include "render/renderer.h"
#include "solver/solver.h"
#include "tests/support/metal.h"
#include "tests/support/smooth_things.h"

namespace lobe {
namespace {

constexpr int kSize = 96;

Scene Room(bool ball, float roughness, int facets) {
  test::SceneBuilder b;
  b.AddBox({-2, -1.5f, -2}, {2, 1.5f, 2}, b.AddLambert(Rgb::Constant(0.7f)), /*inward=*/true);
  b.AddQuad({-1.99f, -1, -1}, {-1.99f, 1, -1}, {-1.99f, 1, 1}, {-1.99f, -1, 1},
            b.AddLambert({0.7f, 0.1f, 0.1f}));
  b.AddQuad({-0.4f, 1.4f, 0.6f}, {0.4f, 1.4f, 0.6f}, {0.4f, 1.4f, 1.2f}, {-0.4f, 1.4f, 1.2f},
            b.AddEmitter(Rgb::Constant(20)));
  const uint32_t metal = b.AddMaterial("metal", test::Metal(roughness, {0.9f, 0.8f, 0.7f}));
  if (ball) {
    b.AddSphere({0, 0, 0}, 0.5f, metal, facets / 2);
  } else {
    test::AddColumn(b, {0, -0.5f, 0}, 0.4f, 1, metal, facets);
  }
  b.AddCamera("view0", {0.6f, 0.4f, 1.95f}, {0, 0, 0}, Vec3::UnitY(), 0.52f);
  return b.Build();
}

void PrintRow(bool ball, float roughness) {
  std::printf("| %s | %.1f |", ball ? "ball" : "column", double(roughness));
  for (const int facets : {6, 12, 24, 48, 96}) {
    SolveOptions options;
    options.mesh.max_edge = 0.4f;
    const Solution solution = Solve(Room(ball, roughness, facets), options);
    const Renderer renderer(solution);
    const CameraView view(solution.scene.cameras[0], kSize, kSize);
    const auto picture = [&](RenderMode mode, uint64_t seed) {
      RenderOptions o;
      o.width = o.height = kSize;
      o.mode = mode;
      o.gather_samples = 16;
      o.seed = seed;
      return renderer.Render(view, o, nullptr);
    };
    const Image a = picture(RenderMode::kGather, 1), b = picture(RenderMode::kGather, 2);
    const auto error = [&](const Image& image) { return 100 * Compare(image, a, &b, nullptr).block_error; };
    const double stored = error(picture(RenderMode::kStored, 3));
    std::printf(" %.1f / %.1f |", stored, error(picture(RenderMode::kAuto, 3)));
    std::fflush(stdout);
  }
  std::printf("\n");
}

void Print() {
  std::printf("| thing | roughness | 6 facets around | 12 | 24 | 48 | 96 |\n|---|---|---|---|---|---|---|\n");
  for (const bool ball : {true, false}) {
    for (const float roughness : {0.4f, 0.5f, 0.6f, 0.8f, 1.0f}) PrintRow(ball, roughness);
  }
}

}  // namespace
}  // namespace lobe

int main() {
  try {
    lobe::Print();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "curved_figures: %s\n", e.what());
    return 1;
  }
}
