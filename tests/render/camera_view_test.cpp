#include "render/camera_view.h"

#include <cmath>

#include <gtest/gtest.h>

namespace lobe {
namespace {

constexpr float kRounding = 2e-6f;

/// A camera at a generic place in a generic attitude.
Camera GenericCamera() {
  Camera camera;
  camera.eye = Vec3(1.3f, -0.4f, 2.2f);
  const Eigen::Matrix3f turn =
      (Eigen::AngleAxisf(0.7f, Vec3(0.36f, 0.48f, 0.8f)) * Eigen::AngleAxisf(-1.1f, Vec3::UnitY()))
          .toRotationMatrix();
  camera.right = turn.col(0);
  camera.up = turn.col(1);
  camera.back = turn.col(2);
  camera.fov_y = 0.9f;
  return camera;
}

Eigen::RowVector4f Multiply(const Vec3& p, const std::vector<float>& m) {
  return Eigen::RowVector4f(p.x(), p.y(), p.z(), 1) *
         Eigen::Map<const Eigen::Matrix<float, 4, 4, Eigen::RowMajor>>(m.data());
}

TEST(CameraViewTest, TheMiddleLooksAlongMinusBack) {
  const Camera camera = GenericCamera();
  const Ray ray = CameraView(camera, 640, 480).EyeRay(320, 240);
  EXPECT_LT((ray.direction + camera.back).norm(), kRounding);
  EXPECT_EQ(ray.origin, camera.eye);
  EXPECT_EQ(ray.t_min, 0);
  EXPECT_TRUE(std::isinf(ray.t_max));
}

TEST(CameraViewTest, FovSpansTheHeightWhateverTheAspect) {
  const Camera camera = GenericCamera();
  for (const int width : {100, 480, 1900}) {
    const CameraView view(camera, width, 480);
    const Vec3 top = view.EyeRay(0.5f * float(width), 0).direction;
    const Vec3 bottom = view.EyeRay(0.5f * float(width), 480).direction;
    EXPECT_NEAR(std::acos(top.dot(bottom)), camera.fov_y, 1e-5f);
    EXPECT_GT(top.dot(camera.up), 0) << "y counts downwards";
  }
}

TEST(CameraViewTest, PixelsAreSquare) {
  const Camera camera = GenericCamera();
  const CameraView view(camera, 640, 480);
  const auto on_film = [&](float x, float y) -> Vec3 {
    const Vec3 d = view.EyeRay(x, y).direction;
    return d / -d.dot(camera.back);
  };
  const Vec3 at = on_film(500, 100);
  EXPECT_NEAR((on_film(501, 100) - at).norm(), (on_film(500, 101) - at).norm(), 1e-5f);
  EXPECT_GT((on_film(501, 100) - at).dot(camera.right), 0) << "x counts to the right";
}

TEST(CameraViewTest, WorldToCameraIsLeftHandedAlongTheView) {
  const Camera camera = GenericCamera();
  const auto m = CameraView(camera, 64, 48).WorldToCamera();
  const Vec3 p = camera.eye + 2 * camera.right + 3 * camera.up - 5 * camera.back;
  EXPECT_LT((Multiply(p, m) - Eigen::RowVector4f(2, 3, 5, 1)).norm(), 1e-5f);
}

TEST(CameraViewTest, WorldToNdcPutsAPointWhereItsEyeRayIs) {
  const CameraView view(GenericCamera(), 640, 480);
  const auto m = view.WorldToNdc();
  for (const auto& [x, y] : {std::pair{12.5f, 470.0f}, {320.0f, 240.0f}, {600.25f, 3.0f}, {0.0f, 0.0f}}) {
    const Ray ray = view.EyeRay(x, y);
    const Eigen::RowVector4f ndc = Multiply(ray.origin + 3.7f * ray.direction, m);
    EXPECT_NEAR(ndc[0] / ndc[3], x / 640, 1e-5f);
    EXPECT_NEAR(ndc[1] / ndc[3], y / 480, 1e-5f);
  }
}

}  // namespace
}  // namespace lobe
