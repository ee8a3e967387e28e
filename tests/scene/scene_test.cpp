#include "scene/scene.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/input_errors.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::ExpectInputError;
using test::SceneBuilder;

TEST(SceneTest, AreaAndNormalOfATriangleAreThoseOfItsCrossProduct) {
  SceneBuilder b;
  b.AddTriangle({1, 2, 3}, {4, 2, 3}, {1, 2, 5}, b.AddLambert(Rgb::Zero()));
  const Scene scene = b.Build();
  EXPECT_NEAR(scene.Area(scene.faces[0]), 3, 1e-6);
  EXPECT_LT((scene.GeometricNormal(scene.faces[0]) - Vec3(0, -1, 0)).norm(), 1e-6f);
}

TEST(SceneTest, NormalsOfTinyTrianglesFarAwayKeepTheirDigits) {
  SceneBuilder b;
  const float h = 1.0f / 1024;  // exact beside 1000
  b.AddTriangle({1000, 1000, 1000}, {1000 + h, 1000, 1000}, {1000, 1000 + h, 1000 + h},
                b.AddLambert(Rgb::Zero()));
  const Scene scene = b.Build();
  EXPECT_LT((scene.GeometricNormal(scene.faces[0]) - Vec3(0, -1, 1).normalized()).norm(), 1e-6f);
}

TEST(SceneTest, BoundsHoldTheFacesOnly) {
  SceneBuilder b;
  b.AddBox({-1, 0, 2}, {3, 4, 5}, b.AddLambert(Rgb::Zero()));
  Scene scene = b.Build();
  scene.positions.push_back({100, 100, 100});  // no face's
  EXPECT_EQ(scene.Bounds().min(), Vec3(-1, 0, 2));
  EXPECT_EQ(scene.Bounds().max(), Vec3(3, 4, 5));
  EXPECT_TRUE(Scene{}.Bounds().isEmpty());
}

TEST(SceneTest, MissingCameraIsToldWithThoseThereAre) {
  SceneBuilder b;
  b.AddTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, b.AddLambert(Rgb::Zero()));
  ExpectInputError([&] { b.Build().FindCamera("door"); }, {"test scene", "'door'", "no cameras"});
  b.AddCamera("window", {0, 0, 5}, {0, 0, 0});
  b.AddCamera("stairs", {1, 0, 5}, {0, 0, 0});
  ExpectInputError([&] { b.Build().FindCamera("door"); }, {"'door'", "'window', 'stairs'"});
  const Scene scene = b.Build();
  EXPECT_EQ(scene.FindCamera("stairs").eye, Vec3(1, 0, 5));
}

TEST(CameraTest, LookAtGivesRightHandedUnitAxesThatFaceTheTarget) {
  const Vec3 eye(1, 2, 3), target(-0.5f, 1, 7), up(0.1f, 1, 0.2f);
  const Camera c = LookAt(eye, target, up, 0.6f);
  EXPECT_LT((c.back - (eye - target).normalized()).norm(), 1e-6f);
  EXPECT_LT((c.right.cross(c.up) - c.back).norm(), 1e-6f);
  EXPECT_NEAR(c.right.dot(up), 0, 1e-6);
  EXPECT_GT(c.up.dot(up), 0);
  for (const Vec3& axis : {c.right, c.up, c.back}) EXPECT_NEAR(axis.norm(), 1, 1e-6);
  EXPECT_EQ(c.fov_y, 0.6f);
}

TEST(CameraTest, LookAtRefusesViewsWithoutMeaning) {
  const Vec3 o = Vec3::Zero(), x = Vec3::UnitX(), y = Vec3::UnitY();
  ExpectInputError([&] { LookAt(x, x, y, 1); }, {"same point"});
  ExpectInputError([&] { LookAt(o, y, y, 1); }, {"parallel"});
  ExpectInputError([&] { LookAt(o, x, o, 1); }, {"parallel", "zero"});
  ExpectInputError([&] { LookAt(o, x, y, 0); }, {"field of view", "0.0"});
  ExpectInputError([&] { LookAt(o, x, y, 3.2f); }, {"field of view", "180"});
  ExpectInputError([&] { LookAt(o, {std::numeric_limits<float>::infinity(), 0, 0}, y, 1); }, {"finite"});
  ExpectInputError([&] { LookAt(o, x, y, std::nanf("")); }, {"field of view"});
}

}  // namespace
}  // namespace lobe
