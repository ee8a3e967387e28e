#pragma once

#include <vector>

#include "scene/ray_tracer.h"
#include "scene/scene.h"

namespace lobe {

/// Eye rays of a pinhole camera for pictures of one size. fov_y spans the height whatever the aspect.
class CameraView {
 public:
  CameraView(const Camera& camera, int width, int height);
  /// Through film position (x, y) in pixels, from the top left corner of the picture; pixel (i, j) has
  /// its centre at (i + 0.5, j + 0.5). Unit direction, t from 0 to infinity.
  Ray EyeRay(float x, float y) const;
  /// The same directions before they are made unit: corner + x * dx + y * dy, on the film one metre in front
  /// of the eye.
  struct Film {
    Vec3 corner, dx, dy;
  };
  Film film() const;
  const Camera& camera() const { return camera_; }

  /// The OpenEXR standard attributes of these names (ImfStandardAttributes.h), 16 floats row-major, to
  /// be multiplied by row vectors: p' = (p, 1) M, then divided by the fourth component.
  /// Camera space is OpenEXR's: left-handed, x right, y up, z along the view.
  std::vector<float> WorldToCamera() const;
  /// x and y run over 0..1 from the picture's top left to its bottom right.
  std::vector<float> WorldToNdc() const;

 private:
  Camera camera_;
  int width_, height_;
  float tan_x_, tan_y_;  ///< half the film at unit distance
};

}  // namespace lobe
