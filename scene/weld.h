#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include "sh/vector.h"

namespace lobe {

/// Gives corners at one place, with about one normal, one number. Corners join the first to come among
/// those within reach, so the outcome depends on their order alone.
class Welder {
 public:
  /// Positions differ by at most `distance` (metres) in each axis, normals by at most `angle` (radians).
  Welder(const Eigen::AlignedBox3f& bounds, double distance, double angle);

  /// Number of the corner, counted from 0 in order of first appearance. `normal` is of unit length.
  uint32_t Add(const Vec3& position, const Vec3& normal);
  /// A number of its own for a corner that nothing is to join.
  uint32_t AddAlone(const Vec3& position, const Vec3& normal);

  /// By number; those of the first corner.
  const std::vector<Vec3>& positions() const { return positions_; }
  const std::vector<Vec3>& normals() const { return normals_; }

 private:
  Vec3d origin_;
  double distance_, cell_, cos_angle_;
  std::vector<Vec3> positions_, normals_;
  std::vector<uint32_t> next_;  // in the same grid cell
  std::unordered_map<uint64_t, uint32_t> first_in_cell_;
};

/// Parts corners that hang together only across contact lines. `triangles` hold numbers of `welder`; bit k of
/// `contact[i]` says that triangle i's edge from corner k to k + 1 is such a line (Face::contact). Corners at
/// the end of a line keep one number if the triangles around it share edges all the way from one side to
/// the other; new numbers come in order of triangles. Corners that touch no line are left alone.
///
/// Returns, by number, corners around which the surface extends by much more than a straight angle, as
/// outside the foot of a box and around the end of a wall: shadows begin there, so light depends on the
/// direction one comes from, and no single value will do.
std::vector<bool> PartAtContacts(const std::vector<uint32_t>& contact, Welder* welder,
                                 std::vector<std::array<uint32_t, 3>>* triangles);

}  // namespace lobe
