#include <algorithm>
#include <string>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace lobe
