#include "tests/support/rooms/solid.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace lobe::test {
namespace {

struct Shape {
  std::string name;
  Solid solid;
  double volume;    // of what it is an image of
  float deviation;  // by which its volume may be smaller
};

std::vector<Shape> Shapes() {
  constexpr double kPi = std::numbers::pi;
  std::vector<Shape> out = {{"box", Box({-1, 0, 2}, {1, 3, 4}), 12, 1e-6f},
                            {"icosphere", Icosphere(0.5f, 3), kPi / 6, 0.02f},
                            {"capped in one group", Cylinder(0.3f, 2, 48, false), 0.18 * kPi, 0.01f},
                            {"cylinder", Cylinder(0.3f, 2, 8), 0.18 * kPi, 0.11f},
                            {"torus", Torus(0.5f, 0.2f, 48, 16), 2 * kPi * kPi * 0.5 * 0.04, 0.04f}};
  for (const int sides : {8, 16, 48}) {
    out.push_back({"ball of " + std::to_string(sides), Ball(0.5f, sides, sides / 2), kPi / 6,
                   sides == 8 ? 0.25f : 0.07f});
  }
  // A box of edge 2 rounded by r: the Minkowski sum of one of edge 2 - 2 r and a ball.
  const double r = 0.25, inner = 2 - 2 * r;
  const double rounded =
      std::pow(inner, 3) + 6 * inner * inner * r + 3 * kPi * inner * r * r + 4 * kPi / 3 * r * r * r;
  out.push_back({"bevelled box", BevelledBox({-1, 0, -1}, {1, 2, 1}, float(r), 4), rounded, 0.005f});
  out.push_back({"chamfered box", BevelledBox({-1, 0, -1}, {1, 2, 1}, float(r), 1), rounded, 0.06f});
  return out;
}

TEST(SolidTest, EveryShapeIsClosedAndItsFrontsAreOutside) {
  for (const Shape& s : Shapes()) {
    EXPECT_TRUE(s.solid.IsClosed()) << s.name;
    EXPECT_LE(s.solid.Volume(), s.volume * (1 + 1e-5)) << s.name;
    EXPECT_GE(s.solid.Volume(), s.volume * (1 - double(s.deviation))) << s.name;
  }
}

TEST(SolidTest, NoShapeHasTrianglesWithoutAreaOrNormalsBehindThem) {
  for (const Shape& s : Shapes()) {
    for (const Shading shading : {Shading::kFlat, Shading::kSmooth, Shading::kSmoothByArea}) {
      SceneBuilder builder;
      s.solid.AddTo(&builder, builder.AddLambert(Rgb::Constant(0.5f)), shading);
      const Scene scene = builder.Build();
      for (const Face& face : scene.faces) {
        EXPECT_GT(scene.Area(face), 1e-6f) << s.name;
        for (const uint32_t v : face.vertex) {
          EXPECT_NEAR(scene.normals[v].norm(), 1, 1e-5) << s.name;
          EXPECT_GT(scene.normals[v].dot(scene.GeometricNormal(face)), 0.1f) << s.name;
        }
      }
    }
  }
}

TEST(SolidTest, SmoothNormalsOfABallPointFromItsCentreAndFlatOnesAcrossItsFacets) {
  SceneBuilder builder;
  Icosphere(0.5f, 2).AddTo(&builder, builder.AddLambert(Rgb::Constant(0.5f)), Shading::kSmooth);
  Ball(0.5f, 16, 8).AddTo(&builder, 0, Shading::kFlat);
  const Scene scene = builder.Build();
  for (const Face& face : scene.faces) {
    for (const uint32_t v : face.vertex) {
      const Vec3 expected = face.surface == 0 ? scene.positions[v].normalized() : scene.GeometricNormal(face);
      EXPECT_GT(scene.normals[v].dot(expected), face.surface == 0 ? 0.995f : 0.99999f);
    }
  }
}

TEST(SolidTest, BevelsSmoothedByAreaLeaveLargeFacesFlat) {
  SceneBuilder builder;
  BevelledBox({-1, 0, -1}, {1, 2, 1}, 0.02f, 3)
      .AddTo(&builder, builder.AddLambert(Rgb::Constant(0.5f)), Shading::kSmoothByArea);
  const Scene scene = builder.Build();
  int large = 0;
  for (const Face& face : scene.faces) {
    if (scene.Area(face) < 1) continue;
    ++large;
    for (const uint32_t v : face.vertex) EXPECT_GT(scene.normals[v].dot(scene.GeometricNormal(face)), 0.999f);
  }
  EXPECT_EQ(large, 12);
}

}  // namespace
}  // namespace lobe::test
