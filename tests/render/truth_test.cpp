#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "render/compare.h"
#include "render/renderer.h"
#include "scene/gltf_scene.h"
#include "solver/solver.h"
#include "tests/support/truth.h"

namespace lobe {
namespace {

// Pictures against pairs of references by an independent path tracer (tests/truth). Bounds are what first
// light promises at a longest edge of 0.4 m; docs/validation.md#cornell has the figures reached.
double WorstPixelError(const std::string& name, float edge) {
  const std::string folder = LOBE_TEST_DATA;
  SolveOptions options;
  options.mesh.max_edge = edge;
  const Solution solution = Solve(ReadGltfScene(folder + "/scenes/" + name + ".glb"), options);
  double worst = 0;
  for (const Comparison& c : test::CompareWithTruth(solution, folder, name)) {
    EXPECT_NEAR(c.mean / c.reference_mean, 1, 0.02) << name;
    worst = std::max(worst, c.pixel_error);
  }
  return worst;
}

TEST(TruthTest, DiffuseCornellBoxIsWithinThreePercentAndBetterWhenFiner) {
  const double coarse = WorstPixelError("cornell_diffuse", 0.8f),
               fine = WorstPixelError("cornell_diffuse", 0.4f);
  EXPECT_LT(fine, 0.03);
  EXPECT_LT(fine, coarse);
}

TEST(TruthTest, GlossyCornellBoxIsWithinSixPercentAndBetterWhenFiner) {
  const double coarse = WorstPixelError("cornell_glossy", 0.8f),
               fine = WorstPixelError("cornell_glossy", 0.4f);
  EXPECT_LT(fine, 0.06);
  EXPECT_LT(fine, coarse);
}

// A closed room whose walls emit 1 and reflect half, with a glowing, a white and a mirror block and a
// translucent sheet: every radiance anywhere is exactly 2, by any number of mirrors and through the sheet.
TEST(TruthTest, EveryRadianceInTheGlossyFurnaceIsTwo) {
  const Solution solution = Solve(ReadGltfScene(LOBE_TEST_DATA "/scenes/furnace_glossy.glb"), {});
  const Renderer renderer(solution);
  ASSERT_EQ(solution.scene.cameras.size(), 2u);
  for (const Camera& camera : solution.scene.cameras) {
    RenderOptions options;
    options.width = options.height = 256;
    const Image picture = renderer.Render(CameraView(camera, 256, 256), options, nullptr);
    Image two(256, 256);
    std::fill(two.pixels.begin(), two.pixels.end(), Rgb::Constant(2));
    const Comparison c = Compare(picture, two, nullptr, nullptr);
    EXPECT_LT(c.block_error, 0.005) << camera.name;
    EXPECT_NEAR(c.mean, 2, 0.004) << camera.name;
    RecordProperty(camera.name + "_block_error", std::to_string(c.block_error));
  }
}

}  // namespace
}  // namespace lobe
