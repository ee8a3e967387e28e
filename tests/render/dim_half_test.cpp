// tests/scenes/wall_half_millimetre_short.glb: an upright wall of sheets ends half a millimetre before floor
// and ceiling; the half of the room behind the camera's wall is 1000 times as bright.

#include <gtest/gtest.h>

#include "render/renderer.h"
#include "scene/gltf_scene.h"
#include "solver/solver.h"
#include "tests/support/path_classes.h"
#include "tests/support/small_pictures.h"

namespace lobe {
namespace {

TEST(DimHalfOfARoomTest, LosesNothingBesideABrightHalf) {
  const Solution s = Solve(ReadGltfScene(LOBE_TEST_DATA "/scenes/wall_half_millimetre_short.glb"), {});
  const CameraView view(s.scene.FindCamera("dark"), 96, 96);
  const double mean =
      test::MeanOf(Renderer(s).Render(view, test::OptionsFor(test::kAutoMode, 96, 16), nullptr)).mean();
  // The dim lamp alone, by the path tracer; with what leaks around the wall, 7.78e-4 +- 0.2 %.
  EXPECT_GT(mean, 6.84e-4);
  EXPECT_NEAR(mean / 7.78e-4, 1, 0.05);
}

}  // namespace
}  // namespace lobe
