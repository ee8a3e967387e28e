#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "brdf/reflectance.h"
#include "brdf/rgb.h"
#include "sh/vector.h"

namespace lobe {

struct Material {
  std::string name;
  Reflectance reflectance = MetallicRoughness{};
  Rgb emission = Rgb::Zero();  ///< radiance, W m^-2 sr^-1, leaving the front (both sides if double_sided)
  /// Also of whatever transmits, since light goes both ways through it: readers see to that.
  bool double_sided = false;
  bool emits() const { return (emission > 0).any(); }
  /// The back, too. The inside of solid glass never does, whatever double_sided says.
  bool emits_behind() const { return emits() && double_sided && !body(); }
  bool transmits() const { return Transmits(reflectance); }
  bool glass() const { return IsGlass(reflectance); }  ///< light goes on through it, unscattered
  bool pane() const { return glass() && !thick(); }    ///< glass so thin that it goes straight on
  bool body() const { return glass() && thick(); }     ///< surface of solid glass, its front outside

 private:
  bool thick() const { return std::get<MetallicRoughness>(reflectance).thickness > 0; }
};

/// An input triangle in world space, the thing rays hit. Counter-clockwise seen from its front.
struct Face {
  std::array<uint32_t, 3> vertex;  ///< into Scene::positions
  uint32_t material;
  uint32_t surface;  ///< faces of one glTF node's primitive share it; welding stays inside
  /// Bit k: the edge from corner k to k + 1 lies on a contact line (scene/contacts.h), where light may jump:
  /// nodes are not shared across it. Set for the faces on both sides.
  uint32_t contact = 0;
};

struct Camera {
  std::string name;
  Vec3 eye, right, up, back;  ///< unit axes in world space; looks along -back
  float fov_y = 0.7f;         ///< vertical, radians
  float aspect = 1;           ///< width / height
};

/// A scene in world space, metres, Y up. Vertices are per corner group as in the file: position and
/// normal by the same index; faces that share a vertex index share its normal.
struct Scene {
  std::string path;
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< unit; flat ones where the file has none
  std::vector<Face> faces;
  std::vector<std::string> surface_names;  ///< per Face::surface, glTF node name
  std::vector<Material> materials;
  std::vector<Camera> cameras;
  /// One sentence each: what the file asks for that is not read, and what is used instead.
  std::vector<std::string> warnings;

  const Material& material(const Face& f) const { return materials[f.material]; }
  std::array<Vec3, 3> Corners(const Face& f) const {
    return {positions[f.vertex[0]], positions[f.vertex[1]], positions[f.vertex[2]]};
  }
  static constexpr float kGrazing = 1e-3f;    ///< (chosen)
  Vec3 GeometricNormal(const Face& f) const;  ///< unit
  /// Shading normal at a corner (0..2) of a face, on the front: one that points behind the face is turned,
  /// one that lies in its plane (cosine below kGrazing) replaced by the geometric normal.
  Vec3 CornerNormal(const Face& f, int corner) const;
  float Area(const Face& f) const;
  Eigen::AlignedBox3f Bounds() const;
  /// Throws InputError naming the camera asked for and those there are.
  const Camera& FindCamera(const std::string& name) const;
};

/// Vertical field of view in radians. `up` may not be parallel to the view; throws InputError then.
Camera LookAt(const Vec3& eye, const Vec3& target, const Vec3& up, float fov_y);

}  // namespace lobe
