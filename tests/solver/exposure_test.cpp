#include "solver/exposure.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "scene/contacts.h"
#include "scene/input_error.h"
#include "scene/tessellate.h"
#include "solver/links.h"
#include "solver/solution.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

std::vector<MaterialLobes> LobesOf(const Scene& scene) {
  TableCache cache;
  std::vector<MaterialLobes> out;
  for (const auto& m : scene.materials) out.emplace_back(m.reflectance, LobeOptions{}, cache);
  return out;
}

// Ideal mirrors stop what is emitted.
EmissionLoss LossWithoutMirrors(const Scene& scene, const Mesh& mesh, const RayTracer& tracer) {
  return FindEmissionLoss(scene, mesh, tracer,
                          std::vector<const MaterialLobes*>(scene.materials.size(), nullptr), 1);
}

// A room with a lamp; `boxes` of the given sidedness standing in it.
Scene RoomWithBox(bool double_sided, float y0) {
  SceneBuilder b;
  const uint32_t wall = b.AddMaterial("wall", Lambert{}, Rgb::Zero(), double_sided);
  b.AddBox({0, 0, 0}, {3, 3, 3}, wall, true);
  b.AddBox({1, y0, 1}, {2, y0 + 1, 2}, b.AddMaterial("box", Lambert{}, Rgb::Zero(), double_sided));
  b.AddQuad({1, 2.9f, 1}, {2, 2.9f, 1}, {2, 2.9f, 2}, {1, 2.9f, 2}, b.AddEmitter(Rgb::Constant(1)));
  return b.Build();
}

TEST(ExposureTest, InsideOfAClosedDoubleSidedBoxIsUnlit) {
  const Scene scene = RoomWithBox(true, 1);
  const auto lit = FindLitSides(scene, RayTracer(scene), 1);
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    if (scene.material(scene.faces[f]).emits()) continue;
    EXPECT_TRUE(lit[2 * f]) << "front of face " << f;
    EXPECT_FALSE(lit[2 * f + 1]) << "back of face " << f;
  }
}

// A marble of 1 cm on a floor of 10 m under the open sky: walks meet it about once in 10^6 steps.
TEST(ExposureTest, FindsASmallThingInALargeScene) {
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    SceneBuilder b;
    b.AddQuad({-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, b.AddLambert(Rgb::Constant(0.5f)));
    b.AddQuad({-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}, b.AddEmitter(Rgb::Constant(1)));
    b.AddSphere({2, 0.01f, 2}, 0.01f, b.AddMaterial("marble", Lambert{}, Rgb::Zero(), true), 8);
    const Scene scene = b.Build();
    const auto lit = FindLitSides(scene, RayTracer(scene), seed);
    const size_t marble = scene.faces.size() - 1;
    EXPECT_TRUE(lit[2 * marble]) << "seed " << seed;
    EXPECT_FALSE(lit[2 * marble + 1]) << "its inside, seed " << seed;
  }
}

Material Paper(float t = 0.5f) {
  MetallicRoughness m;
  m.metallic = 0;
  m.diffuse_transmission = t;
  return {.name = "paper", .reflectance = m, .double_sided = true};
}

std::vector<bool> LitFaces(const Scene& scene, const std::string& material, Side side, uint64_t seed = 1) {
  const auto lit = FindLitSides(scene, RayTracer(scene), seed);
  std::vector<bool> out;
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    if (scene.material(scene.faces[f]).name == material) out.push_back(lit[2 * f + size_t(side)]);
  }
  return out;
}

// A lamp inside closed boxes of paper, `layers` deep, in a room with a picture turned to the wall: light
// comes out however thick it is and however little gets through, and goes on. Through opaque boxes it does
// not.
TEST(ExposureTest, WhatLiesBehindALampshadeIsLit) {
  for (const bool translucent : {true, false}) {
    for (const int layers : {1, 3}) {
      SceneBuilder b;
      b.AddBox({-2, -2, -2}, {2, 2, 2}, b.AddMaterial("wall", Lambert{}), /*inward=*/true);
      b.AddQuad({-1.5f, -1, -1}, {-1.5f, -1, 1}, {-1.5f, 1, 1}, {-1.5f, 1, -1},
                b.AddMaterial("picture", Lambert{}));
      const uint32_t shade = b.AddMaterial(Paper(translucent ? 0.01f : 0.0f));
      for (int i = 1; i <= layers; ++i) {
        const float r = 0.3f + 0.1f * float(i);
        b.AddBox(Vec3::Constant(-r), Vec3::Constant(r), shade);
      }
      b.AddSphere({0, 0, 0}, 0.1f, b.AddEmitter(Rgb::Constant(1)), 6);
      const Scene scene = b.Build();
      for (const char* name : {"wall", "picture"}) {
        const auto lit = LitFaces(scene, name, Side::kFront);
        EXPECT_EQ(std::count(lit.begin(), lit.end(), translucent), long(lit.size())) << name << ' ' << layers;
      }
      const auto inside = LitFaces(scene, "paper", Side::kBack),
                 outside = LitFaces(scene, "paper", Side::kFront);
      EXPECT_TRUE(inside[0]);
      EXPECT_EQ(std::count(outside.begin(), outside.end(), true), translucent ? long(outside.size()) : 0);
    }
  }
}

// The same the other way round: what stands in a paper box is lit from the room.
TEST(ExposureTest, WhatStandsInAPaperBoxIsLit) {
  SceneBuilder b;
  b.AddBox({-2, -2, -2}, {2, 2, 2}, b.AddMaterial("wall", Lambert{}), /*inward=*/true);
  b.AddQuad({-1, 1.9f, -1}, {1, 1.9f, -1}, {1, 1.9f, 1}, {-1, 1.9f, 1}, b.AddEmitter(Rgb::Constant(1)));
  b.AddBox({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, b.AddMaterial(Paper()));
  b.AddSphere({0, 0, 0}, 0.2f, b.AddMaterial("doll", Lambert{}, Rgb::Zero(), true), 6);
  const Scene scene = b.Build();
  const auto doll = LitFaces(scene, "doll", Side::kFront), stuffing = LitFaces(scene, "doll", Side::kBack);
  EXPECT_EQ(std::count(doll.begin(), doll.end(), true), long(doll.size()));
  EXPECT_EQ(std::count(stuffing.begin(), stuffing.end(), true), 0) << "the doll is opaque";
}

// A centimetre of lantern on a floor of ten metres, with a ball in it and one in that: seldom met by chance,
// so rays aimed at the outer one find it, and from its inside the next.
TEST(ExposureTest, WhatASmallSheetHidesInALargeSceneIsLit) {
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    SceneBuilder b;
    b.AddQuad({-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, b.AddLambert(Rgb::Constant(0.5f)));
    b.AddQuad({-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}, b.AddEmitter(Rgb::Constant(1)));
    const uint32_t paper = b.AddMaterial(Paper());
    for (const float r : {0.01f, 0.007f}) b.AddSphere({2, 0.01f, 2}, r, paper, 8);
    b.AddSphere({2, 0.01f, 2}, 0.004f, b.AddMaterial("pearl", Lambert{}), 8);
    const Scene scene = b.Build();
    const auto pearl = LitFaces(scene, "pearl", Side::kFront, seed);
    EXPECT_EQ(std::count(pearl.begin(), pearl.end(), true), long(pearl.size())) << "seed " << seed;
  }
}

TEST(ExposureTest, FloorUnderABoxIsUnlitOnceCutAlongTheContact) {
  for (const float y0 : {0.0f, -0.01f}) {  // standing, and sunk a centimetre
    const Scene scene = CutAlongContacts(RoomWithBox(true, y0));
    const auto lit = FindLitSides(scene, RayTracer(scene), 1);
    int under = 0, beside = 0;
    for (size_t f = 0; f < scene.faces.size(); ++f) {
      const auto p = scene.Corners(scene.faces[f]);
      const Vec3 centre = (p[0] + p[1] + p[2]) / 3;
      if (scene.faces[f].surface != 0 || centre.y() != 0) continue;
      const bool is_under = centre.x() > 1 && centre.x() < 2 && centre.z() > 1 && centre.z() < 2;
      EXPECT_EQ(lit[2 * f], !is_under) << "at " << centre.transpose();
      ++(is_under ? under : beside);
    }
    EXPECT_GE(under, 2);
    EXPECT_GE(beside, 6);
  }
}

TEST(ExposureTest, NodesUnderABoxAreHiddenAndOthersAreNot) {
  for (const bool double_sided : {false, true}) {
    for (const float y0 : {0.0f, -0.01f}) {  // standing, and sunk a centimetre
      const Scene scene = RoomWithBox(double_sided, y0);
      const RayTracer tracer(scene);
      TessellateOptions options;
      options.max_edge = 0.3f;
      const Mesh mesh = Tessellate(scene, options, FindLitSides(scene, tracer, 1));
      const Links links(scene, mesh, tracer, LobesOf(scene), {.links = 64});
      for (uint32_t n = 0; n < mesh.node_count(); ++n) {
        const Vec3& p = mesh.node_position[n];
        const auto& patch = mesh.patches[mesh.node_patch[n]];
        if (scene.materials[patch.material].name != "wall") continue;
        const bool under = p.y() < 0.001f && p.x() > 1.01f && p.x() < 1.99f && p.z() > 1.01f && p.z() < 1.99f;
        const bool clear = p.y() > 0.001f || p.x() < 0.99f || p.x() > 2.01f || p.z() < 0.99f || p.z() > 2.01f;
        if (under) {
          EXPECT_TRUE(links.hidden()[n]) << p.transpose();
        }
        // The ceiling right above the lamp sees little but the lamp's black back: hidden or not is all one.
        if (clear && p.y() < 2.999f) {
          EXPECT_FALSE(links.hidden()[n]) << p.transpose();
        }
      }
    }
  }
}

TEST(ExposureTest, AClosedRoomLosesNothing) {
  const Scene scene = RoomWithBox(false, 1);
  const RayTracer tracer(scene);
  const Mesh mesh = Tessellate(scene, {}, FindLitSides(scene, tracer, 1));
  EXPECT_EQ(LossWithoutMirrors(scene, mesh, tracer).escaped.maxCoeff(), 0);
  const Links links(scene, mesh, tracer, LobesOf(scene), {.links = 64});
  for (uint32_t n = 0; n < mesh.node_count(); ++n) {
    for (const uint32_t link : links.of(n)) EXPECT_NE(link, Links::kEscaped);
  }
}

TEST(ExposureTest, EmissionOfALampInTheOpenEscapes) {
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, b.AddEmitter(Rgb::Constant(1)));
  const Scene scene = b.Build();
  const RayTracer tracer(scene);
  const Mesh mesh = Tessellate(scene, {}, FindLitSides(scene, tracer, 1));
  EXPECT_EQ(LossWithoutMirrors(scene, mesh, tracer).escaped.minCoeff(), 1);
}

TEST(ExposureTest, HiddenNodesHaveNoWeight) {
  Mesh mesh;
  mesh.elements = {{0, 1, 2}};
  const Mesh::Location where{0, {0.5f, 0.3f, 0.2f}};
  const NodeWeights all = Interpolate(mesh, {0, 0, 0}, where);
  EXPECT_EQ(all.count, 3);
  const NodeWeights two = Interpolate(mesh, {1, 0, 0}, where);
  ASSERT_EQ(two.count, 2);
  EXPECT_NEAR(two.weight[0], 0.6f, 1e-6);
  EXPECT_NEAR(two.weight[1], 0.4f, 1e-6);
  EXPECT_EQ(Interpolate(mesh, {1, 1, 1}, where).count, 0);
  const NodeWeights at_hidden = Interpolate(mesh, {1, 0, 0}, {0, {1, 0, 0}});
  EXPECT_NEAR(at_hidden.weight[0] + at_hidden.weight[1], 1, 1e-6);
}

}  // namespace
}  // namespace lobe
