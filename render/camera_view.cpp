#include "render/camera_view.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace lobe {
namespace {

using RowMatrix4 = Eigen::Matrix<float, 4, 4, Eigen::RowMajor>;

RowMatrix4 WorldToCameraMatrix(const Camera& c) {
  RowMatrix4 m = RowMatrix4::Zero();
  m.block<3, 1>(0, 0) = c.right;
  m.block<3, 1>(0, 1) = c.up;
  m.block<3, 1>(0, 2) = -c.back;
  m(3, 0) = -c.eye.dot(c.right);
  m(3, 1) = -c.eye.dot(c.up);
  m(3, 2) = c.eye.dot(c.back);
  m(3, 3) = 1;
  return m;
}

std::vector<float> Floats(const RowMatrix4& m) { return {m.data(), m.data() + 16}; }

}  // namespace

CameraView::CameraView(const Camera& camera, int width, int height)
    : camera_(camera), width_(width), height_(height) {
  if (width < 1 || height < 1) throw std::invalid_argument("CameraView: a picture has at least one pixel");
  tan_y_ = std::tan(0.5f * camera.fov_y);
  tan_x_ = tan_y_ * float(width) / float(height);
}

Ray CameraView::EyeRay(float x, float y) const {
  const float sx = (2 * x / float(width_) - 1) * tan_x_;
  const float sy = (1 - 2 * y / float(height_)) * tan_y_;
  Ray ray;
  ray.origin = camera_.eye;
  ray.direction = (sx * camera_.right + sy * camera_.up - camera_.back).normalized();
  ray.t_min = 0;
  ray.t_max = std::numeric_limits<float>::infinity();
  return ray;
}

CameraView::Film CameraView::film() const {
  return {-tan_x_ * camera_.right + tan_y_ * camera_.up - camera_.back,
          2 * tan_x_ / float(width_) * camera_.right, -2 * tan_y_ / float(height_) * camera_.up};
}

std::vector<float> CameraView::WorldToCamera() const { return Floats(WorldToCameraMatrix(camera_)); }

std::vector<float> CameraView::WorldToNdc() const {
  // (x, y, z, 1) in camera space to (z/2 + x / 2 tan_x, z/2 - y / 2 tan_y, z - near, z). The third
  // component is thrown away by readers; 1 mm (chosen) keeps the matrix invertible.
  constexpr float kNear = 1e-3f;
  RowMatrix4 projection = RowMatrix4::Zero();
  projection(0, 0) = 0.5f / tan_x_;
  projection(1, 1) = -0.5f / tan_y_;
  projection.row(2) << 0.5f, 0.5f, 1, 1;
  projection(3, 2) = -kNear;
  return Floats(WorldToCameraMatrix(camera_) * projection);
}

}  // namespace lobe
