#include "tests/support/rooms/solid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>

namespace lobe::test {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// Points at one place to within this, relative to nothing: bodies measure centimetres to metres.
constexpr float kSamePlace = 1e-6f;

using Grid = std::function<Vec3(int i, int j)>;

/// The quads of a surface of parameters i (around the axis, closed) and j (upwards).
void AddQuads(const Grid& at, int columns, int rows, Solid* solid) {
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int next = (i + 1) % columns;
      solid->AddPolygon({at(i, j), at(next, j), at(next, j + 1), at(i, j + 1)});
    }
  }
}

Vec3 OnCircle(float radius, int i, int sides) {
  const float phi = 2 * kPi * static_cast<float>(i) / static_cast<float>(sides);
  return {radius * std::sin(phi), 0, radius * std::cos(phi)};
}

}  // namespace

void Solid::AddPolygon(const std::vector<Vec3>& corners, int group) {
  Polygon polygon{{}, group};
  for (const Vec3& p : corners) {
    const auto same = std::find_if(points_.begin(), points_.end(), [&](const Vec3& q) {
      return (p - q).squaredNorm() < kSamePlace * kSamePlace;
    });
    const auto index = static_cast<uint32_t>(same - points_.begin());
    if (same == points_.end()) points_.push_back(p);
    if (std::find(polygon.corner.begin(), polygon.corner.end(), index) == polygon.corner.end()) {
      polygon.corner.push_back(index);
    }
  }
  if (polygon.corner.size() >= 3) polygons_.push_back(std::move(polygon));
}

void Solid::Move(const Eigen::Affine3f& by) {
  for (Vec3& p : points_) p = by * p;
}

Solid Solid::Without(const std::vector<int>& groups) const {
  Solid out = *this;
  std::erase_if(out.polygons_, [&](const Polygon& p) {
    return std::find(groups.begin(), groups.end(), p.group) != groups.end();
  });
  return out;
}

Eigen::AlignedBox3f Solid::Bounds() const {
  Eigen::AlignedBox3f box;
  for (const Vec3& p : points_) box.extend(p);
  return box;
}

double Solid::Volume() const {
  double volume = 0;
  for (const Polygon& p : polygons_) {
    volume += double(AreaVector(p).dot(points_[p.corner[0]])) / 3;
  }
  return volume;
}

bool Solid::IsClosed() const {
  std::set<std::pair<uint32_t, uint32_t>> edges;
  for (const Polygon& p : polygons_) {
    for (size_t k = 0; k < p.corner.size(); ++k) {
      if (!edges.emplace(p.corner[k], p.corner[(k + 1) % p.corner.size()]).second) return false;
    }
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& e) {
    return edges.contains({e.second, e.first});
  });
}

Vec3 Solid::AreaVector(const Polygon& p) const {
  Vec3 sum = Vec3::Zero();
  const Vec3& a = points_[p.corner[0]];
  for (size_t k = 1; k + 1 < p.corner.size(); ++k) {
    sum += (points_[p.corner[k]] - a).cross(points_[p.corner[k + 1]] - a) / 2;
  }
  return sum;
}

std::vector<Vec3> Solid::CornerNormals(const Polygon& p, Shading shading,
                                       const std::vector<std::vector<uint32_t>>& around) const {
  std::vector<Vec3> normals(p.corner.size(), AreaVector(p).normalized());
  if (shading == Shading::kFlat) return normals;
  for (size_t k = 0; k < p.corner.size(); ++k) {
    Vec3 sum = Vec3::Zero();
    for (const uint32_t other : around[p.corner[k]]) {
      const Polygon& q = polygons_[other];
      if (q.group != p.group) continue;
      const Vec3 area = AreaVector(q);
      if (shading == Shading::kSmoothByArea) {
        sum += area;
        continue;
      }
      const size_t n = q.corner.size();
      const size_t at = std::find(q.corner.begin(), q.corner.end(), p.corner[k]) - q.corner.begin();
      const Vec3 to = (points_[q.corner[(at + 1) % n]] - points_[p.corner[k]]).normalized();
      const Vec3 from = (points_[q.corner[(at + n - 1) % n]] - points_[p.corner[k]]).normalized();
      sum += std::acos(std::clamp(to.dot(from), -1.0f, 1.0f)) * area.normalized();
    }
    normals[k] = sum.normalized();
  }
  return normals;
}

uint32_t Solid::AddTo(SceneBuilder* scene, uint32_t material, Shading shading) const {
  std::vector<std::vector<uint32_t>> around(points_.size());
  for (uint32_t i = 0; i < polygons_.size(); ++i) {
    for (const uint32_t corner : polygons_[i].corner) around[corner].push_back(i);
  }
  std::vector<Vec3> positions, normals;
  std::vector<std::array<uint32_t, 3>> triangles;
  // Corners are shared within a smoothing group, or a flat polygon.
  std::map<std::pair<uint32_t, int>, uint32_t> vertices;
  for (uint32_t i = 0; i < polygons_.size(); ++i) {
    const Polygon& p = polygons_[i];
    const std::vector<Vec3> corner_normals = CornerNormals(p, shading, around);
    std::vector<uint32_t> index;
    for (size_t k = 0; k < p.corner.size(); ++k) {
      const int sharing = shading == Shading::kFlat ? static_cast<int>(i) : p.group;
      const auto [vertex, is_new] =
          vertices.try_emplace({p.corner[k], sharing}, static_cast<uint32_t>(positions.size()));
      if (is_new) {
        positions.push_back(points_[p.corner[k]]);
        normals.push_back(corner_normals[k]);
      }
      index.push_back(vertex->second);
    }
    for (size_t k = 1; k + 1 < index.size(); ++k) triangles.push_back({index[0], index[k], index[k + 1]});
  }
  return scene->AddMesh(positions, normals, triangles, material);
}

Solid Box(const Vec3& min, const Vec3& max) {
  Solid solid;
  const auto at = [&](int x, int y, int z) {
    return Vec3(x ? max.x() : min.x(), y ? max.y() : min.y(), z ? max.z() : min.z());
  };
  solid.AddPolygon({at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)});
  solid.AddPolygon({at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)});
  solid.AddPolygon({at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)});
  solid.AddPolygon({at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)});
  solid.AddPolygon({at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)});
  solid.AddPolygon({at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)});
  return solid;
}

Solid BevelledBox(const Vec3& min, const Vec3& max, float bevel, int segments) {
  // A ball pulled apart along its axes: eight octants at the corners of a smaller box, joined by flats.
  const Vec3 middle = (min + max) / 2, half = (max - min) / 2 - Vec3::Constant(bevel);
  const auto at = [&](int i, int j) {
    const int quarter = i / (segments + 1), upper = j / (segments + 1);
    const float step = kPi / 2 / static_cast<float>(segments);
    const float phi = kPi / 2 * static_cast<float>(quarter) + step * static_cast<float>(i % (segments + 1));
    const float up = step * static_cast<float>(upper ? j - segments - 1 : j - segments);
    const Vec3 n(std::cos(up) * std::sin(phi), std::sin(up), std::cos(up) * std::cos(phi));
    const Vec3 side(quarter < 2 ? 1.0f : -1.0f, upper ? 1.0f : -1.0f,
                    quarter == 0 || quarter == 3 ? 1.0f : -1.0f);
    return Vec3(middle + side.cwiseProduct(half) + bevel * n);
  };
  Solid solid;
  const int columns = 4 * (segments + 1), rows = 2 * segments + 1;
  AddQuads(at, columns, rows, &solid);
  const auto corner = [&](int quarter, int row) { return at(quarter * (segments + 1), row); };
  solid.AddPolygon({corner(0, rows), corner(1, rows), corner(2, rows), corner(3, rows)});
  solid.AddPolygon({corner(3, 0), corner(2, 0), corner(1, 0), corner(0, 0)});
  return solid;
}

Solid Ball(float radius, int columns, int rings) {
  Solid solid;
  AddQuads(
      [&](int i, int j) {
        const float up = kPi * (static_cast<float>(j) / static_cast<float>(rings) - 0.5f);
        return Vec3(OnCircle(radius * std::cos(up), i, columns) + Vec3(0, radius * std::sin(up), 0));
      },
      columns, rings, &solid);
  return solid;
}

Solid Icosphere(float radius, int subdivisions) {
  const float g = std::numbers::phi_v<float>;
  const Vec3 p[] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  constexpr int kFaces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  std::vector<std::array<Vec3, 3>> triangles;
  for (const auto& f : kFaces) triangles.push_back({p[f[0]], p[f[1]], p[f[2]]});
  for (int level = 0; level < subdivisions; ++level) {
    std::vector<std::array<Vec3, 3>> finer;
    for (auto [a, b, c] : triangles) {
      const Vec3 ab = ((a + b) / 2).normalized(), bc = ((b + c) / 2).normalized(),
                 ca = ((c + a) / 2).normalized();
      a.normalize(), b.normalize(), c.normalize();
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  Solid solid;
  for (const auto& [a, b, c] : triangles) {
    solid.AddPolygon({radius * a.normalized(), radius * b.normalized(), radius * c.normalized()});
  }
  return solid;
}

Solid Cylinder(float radius, float height, int sides, bool caps_apart) {
  Solid solid;
  const auto at = [&](int i, int j) { return Vec3(OnCircle(radius, i, sides) + Vec3(0, j ? height : 0, 0)); };
  AddQuads(at, sides, 1, &solid);
  std::vector<Vec3> top, bottom;
  for (int i = 0; i < sides; ++i) {
    top.push_back(at(i, 1));
    bottom.push_back(at(sides - 1 - i, 0));
  }
  solid.AddPolygon(top, caps_apart ? 1 : 0);
  solid.AddPolygon(bottom, caps_apart ? 2 : 0);
  return solid;
}

Solid Torus(float major_radius, float minor_radius, int major_sides, int minor_sides) {
  Solid solid;
  AddQuads(
      [&](int i, int j) {
        const float phi = 2 * kPi * static_cast<float>(j % minor_sides) / static_cast<float>(minor_sides);
        return Vec3(OnCircle(major_radius + minor_radius * std::cos(phi), i, major_sides) +
                    Vec3(0, minor_radius * std::sin(phi), 0));
      },
      major_sides, minor_sides, &solid);
  return solid;
}

}  // namespace lobe::test
