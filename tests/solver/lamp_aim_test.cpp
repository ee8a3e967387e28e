#include "solver/lamp_aim.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/gltf_scene.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> WarningsOf(const SceneBuilder& b) {
  Scene scene = b.Build();
  const RayTracer tracer(scene);
  WarnOfLampsInsideOut(&scene, tracer, 1);
  return scene.warnings;
}

/// A room of 4 by 3 by 4 metres, and a lamp's material.
struct Room : SceneBuilder {
  uint32_t grey = AddLambert(Rgb::Constant(0.5f));
  uint32_t lamp = AddEmitter(Rgb::Constant(1));
  Room() { AddBox({0, 0, 0}, {4, 3, 4}, grey, /*inward=*/true); }
  uint32_t AddPanel(float y, bool up, uint32_t material) {
    return up ? AddQuad({1, y, 1}, {1, y, 3}, {3, y, 3}, {3, y, 1}, material)
              : AddQuad({1, y, 1}, {3, y, 1}, {3, y, 3}, {1, y, 3}, material);
  }
};

const auto kInsideOut = AllOf(HasSubstr("lamp 'quad 1' is inside out"), HasSubstr("as 'box 0' does"));

TEST(LampAimTest, APanelThatFacesItsHousingIsInsideOut) {
  Room room;
  room.AddPanel(2.9f, /*up=*/true, room.lamp);
  room.AddBox({0.9f, 2.85f, 0.9f}, {3.1f, 2.95f, 3.1f}, room.grey);  // closed around it
  EXPECT_THAT(WarningsOf(room), IsEmpty()) << "its back is shut in, too";
  Room open;
  open.AddPanel(2.9f, true, open.lamp);
  // The housing's inside is seen: light goes round and round in it.
  const uint32_t can = open.AddMaterial("can", Lambert{Rgb::Constant(0.8f)}, Rgb::Zero(), true);
  open.AddMesh({{1, 2.9f, 1}, {3, 2.9f, 1}, {3, 2.9f, 3}, {1, 2.9f, 3}, {2, 2.99f, 2}},
               std::vector<Vec3>(5, Vec3::UnitY()), {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}, can);
  EXPECT_THAT(WarningsOf(open), ElementsAre(kInsideOut));
}

TEST(LampAimTest, APanelThatFacesTheSkyIsInsideOut) {
  SceneBuilder b;
  b.AddQuad({-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}, b.AddLambert(Rgb::Constant(0.5f)));
  b.AddQuad({-1, 2, -1}, {-1, 2, 1}, {1, 2, 1}, {1, 2, -1}, b.AddEmitter(Rgb::Constant(1)));
  EXPECT_THAT(WarningsOf(b), ElementsAre(AllOf(HasSubstr("'quad 1' is inside out"), HasSubstr("'quad 0'"))));
}

TEST(LampAimTest, ABulbWhoseFrontsAreInsideIsInsideOut) {
  for (const bool inward : {false, true}) {
    Room room;
    room.AddSphere({2, 2, 2}, 0.1f, room.lamp, 8, inward);
    if (inward) {
      EXPECT_THAT(WarningsOf(room), ElementsAre(HasSubstr("'sphere 1' is inside out")));
    } else {
      EXPECT_THAT(WarningsOf(room), IsEmpty());
    }
  }
}

TEST(LampAimTest, LampsThatAreMeantSoAreNot) {
  for (const bool up : {false, true}) {
    Room room;  // by way of the ceiling, ten centimetres above
    room.AddPanel(2.9f, up, room.lamp);
    EXPECT_THAT(WarningsOf(room), IsEmpty()) << up;
  }
  Room two_sided;
  two_sided.AddPanel(2.9f, true, two_sided.AddMaterial("lamp", Lambert{}, Rgb::Constant(1), true));
  EXPECT_THAT(WarningsOf(two_sided), IsEmpty());
  SceneBuilder furnace;
  furnace.AddBox({0, 0, 0}, {1, 1, 1}, furnace.AddEmitter(Rgb::Constant(1)), true);
  EXPECT_THAT(WarningsOf(furnace), IsEmpty());
  for (const char* name : {"cornell_diffuse", "glossy_floor", "lampshade", "glass_room", "lamp_twice",
                           "lamp_in_ceiling_plane"}) {
    Scene scene = ReadGltfScene(std::string(LOBE_TEST_DATA "/scenes/") + name + ".glb");
    scene.warnings.clear();
    WarnOfLampsInsideOut(&scene, RayTracer(scene), 1);
    EXPECT_THAT(scene.warnings, IsEmpty()) << name;
  }
}

TEST(LampAimTest, ASceneOfOneTriangleLightsNothing) {
  SceneBuilder b;
  b.AddTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, b.AddEmitter(Rgb::Constant(1)));
  EXPECT_THAT(WarningsOf(b), ElementsAre("the lamps light nothing: all their light leaves the scene"));
}

}  // namespace
}  // namespace lobe
