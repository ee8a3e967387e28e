#pragma once

#include <cmath>
#include <numbers>

#include "tests/support/scene_builder.h"

namespace lobe::test {

/// An upright cylinder without ends, smooth, its foot's centre at `foot`.
inline uint32_t AddColumn(SceneBuilder& b, const Vec3& foot, float radius, float height, uint32_t material,
                          int facets) {
  std::vector<Vec3> positions, normals;
  std::vector<std::array<uint32_t, 3>> triangles;
  for (int i = 0; i < facets; ++i) {
    const double phi = 2 * std::numbers::pi * i / facets;
    const Vec3 n(float(std::sin(phi)), 0, float(std::cos(phi)));
    for (const float y : {0.0f, height}) {
      positions.push_back(foot + radius * n + Vec3(0, y, 0));
      normals.push_back(n);
    }
    const uint32_t a = uint32_t(2 * i), c = uint32_t(2 * ((i + 1) % facets));
    triangles.push_back({a, c, c + 1});
    triangles.push_back({a, c + 1, a + 1});
  }
  return b.AddMesh(positions, normals, triangles, material);
}

/// A torus around the y axis, smooth: `around` facets along its ring of radius `ring`, `across` around the
/// tube.
inline uint32_t AddTorus(SceneBuilder& b, const Vec3& centre, float ring, float tube, uint32_t material,
                         int around, int across) {
  std::vector<Vec3> positions, normals;
  std::vector<std::array<uint32_t, 3>> triangles;
  const auto at = [&](int i, int j) { return uint32_t((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i) {
    const double phi = 2 * std::numbers::pi * i / around;
    const Vec3 out(float(std::sin(phi)), 0, float(std::cos(phi)));
    for (int j = 0; j < across; ++j) {
      const double psi = 2 * std::numbers::pi * j / across;
      const Vec3 n = float(std::cos(psi)) * out + Vec3(0, float(std::sin(psi)), 0);
      positions.push_back(centre + ring * out + tube * n);
      normals.push_back(n);
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return b.AddMesh(positions, normals, triangles, material);
}

/// A cube of twelve triangles whose eight vertices have one normal each, as "shade smooth" leaves it.
inline uint32_t AddSmoothCube(SceneBuilder& b, const Vec3& centre, float half, uint32_t material) {
  std::vector<Vec3> positions, normals;
  for (int i = 0; i < 8; ++i) {
    const Vec3 n(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f);
    positions.push_back(centre + half * n);
    normals.push_back(n.normalized());
  }
  return b.AddMesh(positions, normals,
                   {{0, 4, 6},
                    {0, 6, 2},
                    {1, 3, 7},
                    {1, 7, 5},
                    {0, 1, 5},
                    {0, 5, 4},
                    {2, 6, 7},
                    {2, 7, 3},
                    {0, 2, 3},
                    {0, 3, 1},
                    {4, 5, 7},
                    {4, 7, 6}},
                   material);
}

}  // namespace lobe::test
