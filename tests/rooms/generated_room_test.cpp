#include "tests/support/rooms/generated_room.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "render/camera_view.h"
#include "scene/gltf_scene.h"
#include "scene/ray_tracer.h"
#include "tests/support/rooms/room_trial.h"
#include "tests/support/scene_glb.h"
#include "tests/support/scratch_folder.h"

namespace lobe::test {
namespace {

constexpr uint64_t kRooms = 200;

bool SameGeometry(const Scene& a, const Scene& b) {
  return a.positions == b.positions && a.normals == b.normals && a.faces.size() == b.faces.size() &&
         a.materials.size() == b.materials.size() && a.cameras[0].eye == b.cameras[0].eye;
}

TEST(GeneratedRoomTest, SameSeedGivesTheSameRoomAndAnotherAnother) {
  EXPECT_TRUE(SameGeometry(GeneratedRoom(7).scene, GeneratedRoom(7).scene));
  EXPECT_FALSE(SameGeometry(GeneratedRoom(7).scene, GeneratedRoom(8).scene));
}

TEST(GeneratedRoomTest, EveryModelShapeAndSizeOccursAmongTwoHundred) {
  std::set<std::string> features;
  float least = 1000, most = 0;
  int easy = 0;
  for (uint64_t seed = 1; seed <= kRooms; ++seed) {
    const GeneratedRoom room(seed);
    features.insert(room.features.begin(), room.features.end());
    least = std::min(least, room.size);
    most = std::max(most, room.size);
    easy += room.sharp_area < 0.1 && !room.solid_glass && room.lamps_seen_directly;
  }
  for (const char* expected : {"lambert",
                               "oren-nayar",
                               "phong",
                               "blinn-phong",
                               "ward",
                               "cook-torrance",
                               "ashikhmin-shirley",
                               "plastic",
                               "metal",
                               "dielectric",
                               "translucent",
                               "pane",
                               "mirror",
                               "glass",
                               "ball",
                               "cylinder",
                               "torus",
                               "bevel",
                               "box",
                               "smooth cube",
                               "table",
                               "cabinet",
                               "column",
                               "sheet",
                               "sheet over floor",
                               "gap",
                               "smooth",
                               "smooth sharp",
                               "panel",
                               "fixture",
                               "wall lamp",
                               "bulb",
                               "tube",
                               "shaded",
                               "uplight",
                               "5+ lamps",
                               "steel cabin",
                               "bright walls"}) {
    EXPECT_TRUE(features.contains(expected)) << expected;
  }
  EXPECT_LT(least, 0.1f);
  EXPECT_GT(most, 250);
  EXPECT_GT(easy, 60) << "rooms that the bound on blocks is for";
}

TEST(GeneratedRoomTest, CameraSeesClosedWallsAndNoBacks) {
  for (uint64_t seed = 1; seed <= kRooms; ++seed) {
    const Scene scene = GeneratedRoom(seed).scene;
    const RayTracer tracer(scene);
    const CameraView view(scene.cameras[0], 24, 24);
    int backs = 0;
    for (int i = 0; i < 24 * 24; ++i) {
      const RayHit hit = tracer.Intersect(view.EyeRay(float(i % 24) + 0.5f, float(i / 24) + 0.5f));
      ASSERT_TRUE(hit.hit()) << seed;
      backs += hit.side == Side::kBack && !scene.material(scene.faces[hit.face]).double_sided;
    }
    EXPECT_LE(backs, 2) << seed;
  }
}

double Area(const Scene& scene) {
  double area = 0;
  for (const Face& face : scene.faces) area += double(scene.Area(face));
  return area;
}

TEST(GeneratedRoomTest, ComesBackFromItsFileWithoutAWarning) {
  const ScratchFolder folder;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene scene = GeneratedRoom(seed).scene;
    const std::string path = folder.File("room.glb");
    WriteSceneGlb(scene, path);
    const Scene read = ReadGltfScene(path);
    // Faces that lie back to back are cut along each other's outlines: the same surfaces in more pieces.
    EXPECT_GE(read.faces.size(), scene.faces.size()) << seed;
    EXPECT_NEAR(Area(read) / Area(scene), 1, 1e-5) << seed;
    EXPECT_EQ(read.warnings, std::vector<std::string>()) << seed;
  }
}

}  // namespace
}  // namespace lobe::test
