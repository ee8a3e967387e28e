#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "sh/vector.h"

namespace lobe {

/// Narrows the part t0..t1 of a segment to where what is linear along it, from `at_a` to `at_b`, is within
/// [low, high]. False: nothing is left.
inline bool ClipToRange(double low, double high, double at_a, double at_b, double* t0, double* t1) {
  const double change = at_b - at_a;
  if (change == 0) return at_a >= low && at_a <= high;
  double enter = (low - at_a) / change, leave = (high - at_a) / change;
  if (enter > leave) std::swap(enter, leave);
  *t0 = std::max(*t0, enter);
  *t1 = std::min(*t1, leave);
  return *t0 < *t1;
}

/// A triangle and its plane in double precision, for questions of what lies over it.
struct FlatTriangle {
  std::array<Vec3d, 3> corner;
  Vec3d normal;                 ///< unit
  std::array<Vec3d, 3> inward;  ///< of edge k, from corner k to k + 1: unit, in the plane
  double longest = 0;           ///< edge
  double lowest;                ///< height, over the longest edge

  /// A triangle's part over another has at most six corners.
  struct Polygon {
    std::array<Vec3d, 8> corner;
    int count = 0;
  };

  explicit FlatTriangle(const std::array<Vec3d, 3>& corners) : corner(corners) {
    const Vec3d cross = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    normal = cross.normalized();
    for (int k = 0; k < 3; ++k) {
      const Vec3d along = corner[(k + 1) % 3] - corner[k];
      longest = std::max(longest, along.norm());
      inward[k] = normal.cross(along).normalized();
    }
    lowest = cross.norm() / longest;
  }
  explicit FlatTriangle(const std::array<Vec3, 3>& p)
      : FlatTriangle(std::array<Vec3d, 3>{p[0].cast<double>(), p[1].cast<double>(), p[2].cast<double>()}) {}

  double Height(const Vec3d& p) const { return normal.dot(p - corner[0]); }
  double Inside(int k, const Vec3d& p) const { return inward[k].dot(p - corner[k]); }
  bool LiesUnder(const Vec3d& p, double margin) const {
    return Inside(0, p) >= -margin && Inside(1, p) >= -margin && Inside(2, p) >= -margin;
  }

  /// The part of another triangle that is over or under this one made larger by `margin`.
  Polygon PartOver(const std::array<Vec3d, 3>& other, double margin) const {
    Polygon polygon, cut;
    polygon.count = 3;
    std::copy(other.begin(), other.end(), polygon.corner.begin());
    for (int k = 0; k < 3; ++k) {
      cut.count = 0;
      for (int i = 0; i < polygon.count; ++i) {
        const Vec3d &p = polygon.corner[i], &q = polygon.corner[(i + 1) % polygon.count];
        const double at_p = Inside(k, p) + margin, at_q = Inside(k, q) + margin;
        if (at_p >= 0) cut.corner[cut.count++] = p;
        if ((at_p < 0) != (at_q < 0)) cut.corner[cut.count++] = p + (q - p) * (at_p / (at_p - at_q));
      }
      std::swap(polygon, cut);
      if (polygon.count < 2) return {};
    }
    return polygon;
  }

  /// Narrows the part t0..t1 of a segment likewise. False: nothing is left.
  bool ClipSegment(const Vec3d& a, const Vec3d& b, double margin, double* t0, double* t1) const {
    for (int k = 0; k < 3; ++k) {
      if (!ClipToRange(-margin, INFINITY, Inside(k, a), Inside(k, b), t0, t1)) return false;
    }
    return true;
  }
};

}  // namespace lobe
