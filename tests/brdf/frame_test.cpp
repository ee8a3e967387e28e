#include "brdf/frame.h"

#include <cmath>

#include <gtest/gtest.h>

namespace lobe {
namespace {

TEST(FrameTest, IsRightHandedAndOrthonormalForEveryNormal) {
  for (int i = 0; i < 500; ++i) {
    const float z = 1.0f - 2.0f * float(i) / 499.0f, phi = 2.4f * float(i),
                s = std::sqrt(std::max(0.0f, 1 - z * z));
    const Frame f(Vec3(s * std::cos(phi), s * std::sin(phi), z).normalized());
    EXPECT_NEAR(f.x.norm(), 1, 2e-6);
    EXPECT_NEAR(f.y.norm(), 1, 2e-6);
    EXPECT_NEAR(f.x.dot(f.y), 0, 1e-6);
    EXPECT_LT((f.x.cross(f.y) - f.z).norm(), 2e-6);
  }
}

// The values a second reader must reproduce (docs/conventions.md#frame).
TEST(FrameTest, HasTheDocumentedAxes) {
  const Frame up(Vec3(0, 1, 0));
  EXPECT_LT((up.x - Vec3(1, 0, 0)).norm(), 1e-7);
  EXPECT_LT((up.y - Vec3(0, 0, -1)).norm(), 1e-7);
  const Frame down(Vec3(0, 0, -1));
  EXPECT_LT((down.x - Vec3(1, 0, 0)).norm(), 1e-7);
  EXPECT_LT((down.y - Vec3(0, -1, 0)).norm(), 1e-7);
}

TEST(FrameTest, LocalAndWorldAreInverse) {
  const Frame f(Vec3(0.3f, -0.5f, 0.8f).normalized());
  const Vec3 w = Vec3(-0.2f, 0.7f, 0.1f);
  EXPECT_LT((f.ToWorld(f.ToLocal(w)) - w).norm(), 1e-6);
}

TEST(FrameTest, DirectionsBelowTheHorizonAreBentToIt) {
  const Vec3 bent = BendToHorizon(Vec3(0.6f, 0.0f, -0.8f));
  EXPECT_LT((bent - Vec3(1, 0, 0)).norm(), 1e-6);
  const Vec3 above(0.6f, 0.0f, 0.8f);
  EXPECT_EQ(BendToHorizon(above), above);
  EXPECT_TRUE(BendToHorizon(Vec3(0, 0, -1)).allFinite());
}

}  // namespace
}  // namespace lobe
