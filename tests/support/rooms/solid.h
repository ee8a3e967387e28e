#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "sh/vector.h"
#include "tests/support/scene_builder.h"

namespace lobe::test {

/// How the normals at a polygon's corners follow from the polygons around them.
enum class Shading {
  kFlat,          ///< each polygon its own
  kSmooth,        ///< mean over the polygons of one smoothing group, each by its angle at the corner
  kSmoothByArea,  ///< the same by area: large flat faces between small bevels stay flat
};

/// A closed body of planar convex polygons, as a modelling program has it; fronts outside. The corners at one
/// place are one point.
class Solid {
 public:
  /// Corners counter-clockwise seen from outside. Those that fall together count once; of less than three
  /// nothing is left. Polygons of other groups have an edge of their own when shaded smooth.
  void AddPolygon(const std::vector<Vec3>& corners, int group = 0);
  void Move(const Eigen::Affine3f& by);
  /// The same without the polygons of these groups: open.
  Solid Without(const std::vector<int>& groups) const;

  Eigen::AlignedBox3f Bounds() const;
  /// Positive if fronts are outside.
  double Volume() const;
  /// Is every edge that of two polygons, which run along it in opposite directions?
  bool IsClosed() const;

  /// As one surface; returns its index.
  uint32_t AddTo(SceneBuilder* scene, uint32_t material, Shading shading) const;

 private:
  struct Polygon {
    std::vector<uint32_t> corner;
    int group;
  };
  Vec3 AreaVector(const Polygon& p) const;  ///< unit normal times area
  std::vector<Vec3> CornerNormals(const Polygon& p, Shading shading,
                                  const std::vector<std::vector<uint32_t>>& around) const;

  std::vector<Vec3> points_;
  std::vector<Polygon> polygons_;
};

/// Bodies of everyday facet counts. Those with an axis have it along y.
Solid Box(const Vec3& min, const Vec3& max);
/// Edges rounded by `bevel`, in `segments` facets; fewer than one would be a box.
Solid BevelledBox(const Vec3& min, const Vec3& max, float bevel, int segments);
/// A ball about the origin, with poles along y.
Solid Ball(float radius, int columns, int rings);
/// The same from an icosahedron: 20 * 4^subdivisions triangles.
Solid Icosphere(float radius, int subdivisions);
/// From y = 0 to `height`. The caps are smoothing groups of their own, or one with the side.
Solid Cylinder(float radius, float height, int sides, bool caps_apart = true);
/// About the origin.
Solid Torus(float major_radius, float minor_radius, int major_sides, int minor_sides);

}  // namespace lobe::test
