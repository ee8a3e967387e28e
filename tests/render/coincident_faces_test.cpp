// Faces in one plane: every mode shows what the rule says (scene/plane_rule.h), and the solver emits what the
// path tracer does.

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "render/compare.h"
#include "scene/coincident_faces.h"
#include "scene/gltf_scene.h"
#include "tests/support/path_classes.h"
#include "tests/support/small_pictures.h"

namespace lobe {
namespace {

using namespace test;

double EmittedPower(const Scene& scene) {
  double power = 0;
  for (const Face& f : scene.faces) {
    const Material& m = scene.material(f);
    power += std::numbers::pi * double(m.emission.x()) * scene.Area(f) * (m.emits() + m.emits_behind());
  }
  return power;
}

/// Every mode against two path-traced pictures.
void ExpectEveryModeAgrees(const Scene& scene, const std::string& what, double most_block_error) {
  const Solution solution = Solve(scene, {});
  EXPECT_NEAR(solution.ledger.emitted[0], EmittedPower(scene), 1e-4 * EmittedPower(scene)) << what;
  constexpr int kSize = 48;
  const CameraView view(scene.cameras.at(0), kSize, kSize);
  const PathTracer paths(scene);
  std::array<Image, 2> truth;
  for (int i = 0; i < 2; ++i) {
    truth[i] = RenderPathTraced(paths, view, OptionsFor(kStoredMode, kSize, 100, uint64_t(i + 1)));
  }
  for (const NamedMode& mode : kAllModes) {
    const Image picture = Renderer(solution).Render(view, OptionsFor(mode, kSize, 25, 3), nullptr);
    const Comparison c = Compare(picture, truth[0], &truth[1], nullptr);
    EXPECT_LT(c.block_error, most_block_error) << what << ", mode " << mode.name;
    EXPECT_NEAR(c.bias, 0, 0.01) << what << ", mode " << mode.name;
  }
}

// The mesh of these rooms is off by 0.3 to 1.3 % (blocks); a lamp counted twice is off by 100 %, one that is
// seen by some modes alone by 200 %.
constexpr double kMostBlockError = 0.025;

TEST(CoincidentFacesRenderTest, ALampExportedTwiceIsOneLampInEveryMode) {
  const Scene scene = ReadGltfScene(LOBE_TEST_DATA "/scenes/lamp_twice.glb");
  EXPECT_NEAR(EmittedPower(scene), 40.21, 0.01) << "0.8 m by 0.8 m of radiance 20";
  ExpectEveryModeAgrees(scene, "lamp twice", kMostBlockError);
}

TEST(CoincidentFacesRenderTest, ALampInTheCeilingsPlaneIsSeenInEveryMode) {
  const Scene scene = ReadGltfScene(LOBE_TEST_DATA "/scenes/lamp_in_ceiling_plane.glb");
  EXPECT_NEAR(EmittedPower(scene), 30.16, 0.01);
  ExpectEveryModeAgrees(scene, "lamp in the ceiling's plane", kMostBlockError);
}

/// A room of 4 by 3 by 4 metres, seen from a corner.
struct Room : Stage {
  explicit Room(bool double_sided) {
    const uint32_t grey = AddMaterial("grey", Lambert{Rgb::Constant(0.5f)}, Rgb::Zero(), double_sided);
    AddBox({0, 0, 0}, {4, 3, 4}, grey, /*inward=*/true);
    AddCamera("view", {0.4f, 2.4f, 3.6f}, {2.4f, 0.8f, 1.6f}, Vec3::UnitY(), 1.2f);
  }
};

TEST(CoincidentFacesRenderTest, RugsPanelsAndWallsInOnePlaneLookTheSameInEveryMode) {
  for (const bool double_sided : {false, true}) {
    Room room(double_sided);
    const uint32_t panel = room.AddMaterial("panel", Lambert{Rgb::Zero()}, Rgb(8, 7, 6), double_sided);
    // Later and earlier in the file than what it lies on; a panel in two walls' corner; one on the other.
    room.Down(1, 2.5f, 1, 2, 3, panel);
    room.Up(1, 3, 1.3f, 3, 0, room.AddMaterial("rug", Lambert{Rgb(0.8f, 0.2f, 0.1f)}));
    room.Up(2, 3.5f, 0.5f, 2, 0, room.AddMaterial("mat", Lambert{Rgb(0.1f, 0.3f, 0.8f)}, Rgb::Zero(), true));
    Scene scene = room.Build();
    ResolveCoincidentFaces(&scene);
    ExpectEveryModeAgrees(scene, double_sided ? "double-sided" : "single-sided", kMostBlockError);
  }
}

// Rooms side by side whose walls have no thickness: each wall is seen from its room, whatever its size.
TEST(CoincidentFacesRenderTest, WallsBackToBackAreEachSeenFromTheirRoom) {
  Room room(false);
  const uint32_t red = room.AddMaterial("red", Lambert{Rgb(0.8f, 0.2f, 0.2f)});
  room.AddBox({4, 0, 1}, {7, 2.5f, 3.5f}, red, /*inward=*/true);
  room.Down(1, 3, 1, 3, 2.9f, room.lamp);
  room.Down(5, 6, 2, 3, 2.4f, room.lamp);
  room.AddCamera("red", {6.8f, 2.2f, 3.2f}, {4, 1, 2}, Vec3::UnitY(), 1.2f);
  Scene scene = room.Build();
  ResolveCoincidentFaces(&scene);
  EXPECT_TRUE(scene.warnings.empty());
  ExpectEveryModeAgrees(scene, "from the grey room", kMostBlockError);
  std::swap(scene.cameras[0], scene.cameras[1]);
  ExpectEveryModeAgrees(scene, "from the red room", kMostBlockError);
}

}  // namespace
}  // namespace lobe
