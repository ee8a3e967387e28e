#include "scene/closest_point.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace lobe {
namespace {

// A right triangle in the plane z = 2, legs along x (3 long) and y (4 long).
const std::array<Vec3, 3> kTriangle = {Vec3(1, 1, 2), Vec3(4, 1, 2), Vec3(1, 5, 2)};

void ExpectClosest(const Vec3& point, float u, float v, float distance) {
  const ClosestPoint c = ClosestPointOnTriangle(point, kTriangle);
  EXPECT_NEAR(c.u, u, 1e-6f) << point.transpose();
  EXPECT_NEAR(c.v, v, 1e-6f) << point.transpose();
  EXPECT_NEAR(c.distance, distance, 1e-5f) << point.transpose();
}

TEST(ClosestPointTest, IsTheFootOfThePerpendicularInside) {
  ExpectClosest({1.75f, 2, 5}, 0.25f, 0.25f, 3);
  ExpectClosest({1.75f, 2, -1}, 0.25f, 0.25f, 3);
}

TEST(ClosestPointTest, IsOnTheNearestEdgeOutside) {
  ExpectClosest({2.5f, -3, 2}, 0.5f, 0, 4);
  ExpectClosest({-4, 3, 2}, 0, 0.5f, 5);
  // The hypotenuse's middle (2.5, 3), moved outwards along (4, 3) / 5 by 5.
  ExpectClosest({6.5f, 6, 2}, 0.5f, 0.5f, 5);
}

TEST(ClosestPointTest, IsACornerBeyondTheEdges) {
  ExpectClosest({-2, -3, 2}, 0, 0, 5);
  ExpectClosest({7, -3, 2}, 1, 0, 5);
  ExpectClosest({1, 9, 5}, 0, 1, 5);
}

TEST(ClosestPointTest, WorksWithoutArea) {
  const std::array<Vec3, 3> line = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(1, 0, 0)};
  EXPECT_NEAR(ClosestPointOnTriangle({1.5f, 3, 0}, line).distance, 3, 1e-6f);
  const std::array<Vec3, 3> dot = {Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)};
  EXPECT_NEAR(ClosestPointOnTriangle({1, 1, 3}, dot).distance, 2, 1e-6f);
}

// Against a dense grid of the triangle's own points: none is nearer, one is nearly as near.
TEST(ClosestPointTest, NoPointOfTheTriangleIsNearer) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-3, 3);
  const auto point = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  for (int trial = 0; trial < 50; ++trial) {
    const std::array<Vec3, 3> t = {point(), point(), point()};
    const Vec3 p = point();
    const ClosestPoint c = ClosestPointOnTriangle(p, t);
    const Vec3 at = t[0] + c.u * (t[1] - t[0]) + c.v * (t[2] - t[0]);
    EXPECT_NEAR((p - at).norm(), c.distance, 1e-5f);
    float nearest = 1e9f;
    constexpr int kSteps = 100;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const Vec3 q = t[0] + (t[1] - t[0]) * (float(i) / kSteps) + (t[2] - t[0]) * (float(j) / kSteps);
        nearest = std::min(nearest, (p - q).norm());
      }
    }
    EXPECT_LE(c.distance, nearest + 1e-5f);
    EXPECT_GE(c.distance, nearest - 0.15f) << "a grid cell is at most 0.1 wide";
  }
}

}  // namespace
}  // namespace lobe
