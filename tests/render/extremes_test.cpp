// Pictures where numbers run out: docs/validation.md#extremes.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "render/camera_view.h"
#include "render/exr.h"
#include "render/png.h"
#include "render/renderer.h"
#include "solver/solver.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/small_pictures.h"
#include "tests/support/two_rooms.h"

namespace lobe {
namespace {

constexpr int kSize = 24;

Image Picture(const Solution& s, const std::string& camera, const test::NamedMode& mode) {
  const CameraView view(s.scene.FindCamera(camera), kSize, kSize);
  return Renderer(s).Render(view, test::OptionsFor(mode, kSize, 16), nullptr);
}

// Against the same rooms with both lamps at 1: what is left is the noise of other samples of the same lamps,
// in `direct` that of one of them a pixel, found by direction alone since by light the bright one is always
// drawn.
TEST(ExtremesTest, PicturesAndFilesOfARoomInTrillionthsBesideOneInTrillionsAreRight) {
  SolveOptions o;
  o.mesh.max_edge = 0.8f;
  o.residual = 1e-5;
  o.refine.error = 0;
  const test::ScratchFolder folder;
  const Solution expected = Solve(test::MakeTwoRooms(1, 1).scene, o);
  WriteSolution(Solve(test::MakeTwoRooms(1e12f, 1e-12f).scene, o), folder.File("rooms.glb"));
  const Solution s = ReadSolution(folder.File("rooms.glb"));
  for (const auto& [camera, scale] : {std::pair{"bright", 1e12}, {"dim", 1e-12}}) {
    for (const auto& [mode, tolerance] :
         {std::pair{test::kStoredMode, 1e-3}, {test::kAutoMode, 1e-3}, {test::kDirectMode, 0.1}}) {
      const Image image = Picture(s, camera, mode), unit = Picture(expected, camera, mode);
      for (const Rgb& pixel : image.pixels) ASSERT_TRUE(pixel.isFinite().all()) << mode.name;
      EXPECT_NEAR(test::MeanOf(image)[1] / test::MeanOf(unit)[1] / scale, 1, tolerance)
          << mode.name << ", " << camera;
      if (mode.mode != RenderMode::kStored) continue;

      // Every float survives OpenEXR, and a PNG exposed for the room shows it: a byte of half is linear 0.21.
      WriteExr(image, {}, folder.File("a.exr"));
      const Image back = ReadExr(folder.File("a.exr"));
      for (size_t i = 0; i < image.pixels.size(); ++i) {
        ASSERT_TRUE((back.pixels[i] == image.pixels[i]).all()) << camera;
      }
      const float stops = float(std::log2(0.2 / test::MeanOf(unit)[1]));
      WritePng(image, stops - float(std::log2(scale)), folder.File("a.png"));
      WritePng(unit, stops, folder.File("unit.png"));
      const Mask shown = ReadPngMask(folder.File("a.png")), wanted = ReadPngMask(folder.File("unit.png"));
      int set = 0, differ = 0;
      for (size_t i = 0; i < wanted.set.size(); ++i) {
        set += wanted.set[i];
        differ += shown.set[i] != wanted.set[i];
      }
      EXPECT_GT(set, kSize * kSize / 10) << "halves of the picture are brighter and darker than half";
      EXPECT_LT(set, kSize * kSize * 9 / 10);
      EXPECT_LT(differ, kSize * kSize / 50) << camera;
    }
  }
}

}  // namespace
}  // namespace lobe
