#include <string>

#include <gtest/gtest.h>

#include "render/compare.h"
#include "render/exr.h"
#include "render/renderer.h"
#include "scene/gltf_scene.h"
#include "solver/solver.h"

namespace lobe {
namespace {

// Pictures against pairs of references by an independent path tracer (tests/truth). Bounds are what first light
// promises at a longest edge of 0.4 m; docs/validation.md#cornell has the figures reached.
double WorstPixelError(const std::string& name, float edge) {
  const std::string folder = LOBE_TEST_DATA;
  SolveOptions options;
  options.mesh.max_edge = edge;
  const Solution solution = Solve(ReadGltfScene(folder + "/scenes/" + name + ".glb"), options);
  const Renderer renderer(solution);
  double worst = 0;
  for (const Camera& camera : solution.scene.cameras) {
    const std::string truth = folder + "/truth/" + name + "." + camera.name;
    const Image a = ReadExr(truth + ".a.exr"), b = ReadExr(truth + ".b.exr");
    const Mask mask = ReadPngMask(truth + ".mask.png");
    RenderOptions view;
    view.width = a.width;
    view.height = a.height;
    const Image picture = renderer.Render(CameraView(camera, a.width, a.height), view, nullptr);
    const Comparison c = Compare(picture, a, &b, &mask);
    EXPECT_NEAR(c.mean / c.reference_mean, 1, 0.02) << name << ' ' << camera.name;
    worst = std::max(worst, c.pixel_error);
  }
  return worst;
}

TEST(TruthTest, DiffuseCornellBoxIsWithinThreePercentAndBetterWhenFiner) {
  const double coarse = WorstPixelError("cornell_diffuse", 0.8f), fine = WorstPixelError("cornell_diffuse", 0.4f);
  EXPECT_LT(fine, 0.03);
  EXPECT_LT(fine, coarse);
}

TEST(TruthTest, GlossyCornellBoxIsWithinSixPercentAndBetterWhenFiner) {
  const double coarse = WorstPixelError("cornell_glossy", 0.8f), fine = WorstPixelError("cornell_glossy", 0.4f);
  EXPECT_LT(fine, 0.06);
  EXPECT_LT(fine, coarse);
}

}  // namespace
}  // namespace lobe
