#include "scene/scene.h"

#include <cmath>

#include "scene/input_error.h"

namespace lobe {

namespace {

// In double, so that the normals of thin triangles far from the origin keep their digits.
Vec3d Cross(const std::array<Vec3, 3>& p) {
  const Vec3d a = p[0].cast<double>();
  return (p[1].cast<double>() - a).cross(p[2].cast<double>() - a);
}

}  // namespace

Vec3 Scene::GeometricNormal(const Face& f) const { return Cross(Corners(f)).normalized().cast<float>(); }

Vec3 Scene::CornerNormal(const Face& f, int corner) const {
  const Vec3 geometric = GeometricNormal(f);
  const Vec3& normal = normals[f.vertex[corner]];
  const float cosine = normal.dot(geometric);
  if (!(std::abs(cosine) > kGrazing)) return geometric;
  return cosine > 0 ? normal : Vec3(-normal);
}

float Scene::Area(const Face& f) const { return static_cast<float>(0.5 * Cross(Corners(f)).norm()); }

Eigen::AlignedBox3f Scene::Bounds() const {
  Eigen::AlignedBox3f box;
  for (const Face& f : faces) {
    for (uint32_t v : f.vertex) box.extend(positions[v]);
  }
  return box;
}

const Camera& Scene::FindCamera(const std::string& name) const {
  std::string names;
  for (const Camera& camera : cameras) {
    if (camera.name == name) return camera;
    names += (names.empty() ? "'" : ", '") + camera.name + "'";
  }
  throw InputError(path + ": no camera is named '" + name + "'; " +
                   (names.empty() ? "the file has no cameras" : "there are " + names));
}

Camera LookAt(const Vec3& eye, const Vec3& target, const Vec3& up, float fov_y) {
  const auto say = [](const Vec3& v) {
    return std::to_string(v.x()) + "," + std::to_string(v.y()) + "," + std::to_string(v.z());
  };
  if (!eye.allFinite() || !target.allFinite() || !up.allFinite()) {
    throw InputError("camera: eye, target and up must be finite numbers");
  }
  if (!(fov_y > 0) || !(fov_y < static_cast<float>(M_PI))) {
    throw InputError("camera: the vertical field of view is " + std::to_string(fov_y * 180 / M_PI) +
                     " degrees, expected more than 0 and less than 180");
  }
  const Vec3d back = eye.cast<double>() - target.cast<double>();
  if (back.norm() == 0) throw InputError("camera: eye and target are the same point " + say(eye));
  const Vec3d right = up.cast<double>().cross(back);
  // Sine of the angle between them; below a thousandth of a degree "up" says nothing about roll.
  if (!(right.norm() > 1e-5 * back.norm() * up.cast<double>().norm())) {
    throw InputError("camera: up " + say(up) + " is parallel to the view or zero; choose another up");
  }
  Camera camera;
  camera.eye = eye;
  camera.back = back.normalized().cast<float>();
  camera.right = right.normalized().cast<float>();
  camera.up = back.cross(right).normalized().cast<float>();
  camera.fov_y = fov_y;
  return camera;
}

}  // namespace lobe
