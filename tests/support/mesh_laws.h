#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scene/mesh.h"
#include "scene/scene.h"

namespace lobe::test {

/// Directed sides of a patch's elements, with how often they occur.
inline std::map<std::pair<uint32_t, uint32_t>, int> DirectedSides(const Mesh& mesh,
                                                                  const Mesh::Patch& patch) {
  std::map<std::pair<uint32_t, uint32_t>, int> sides;
  for (uint32_t e = patch.element_begin; e < patch.element_end; ++e) {
    for (int k = 0; k < 3; ++k) ++sides[{mesh.elements[e][k], mesh.elements[e][(k + 1) % 3]}];
  }
  return sides;
}

/// Sides of one element only.
inline std::vector<std::pair<uint32_t, uint32_t>> BorderSides(const Mesh& mesh, const Mesh::Patch& patch) {
  const auto sides = DirectedSides(mesh, patch);
  std::vector<std::pair<uint32_t, uint32_t>> border;
  for (const auto& [side, count] : sides) {
    if (!sides.contains({side.second, side.first})) border.push_back(side);
  }
  return border;
}

/// How often a node lies inside an edge of an element of its own patch that does not have it as a corner:
/// there the two sides of the edge would be interpolated differently. An edge with an element on either side
/// has none, so only those of one element are looked at; slow and obvious. Patches whose border touches
/// itself count too, so scenes of tests should not have any.
inline size_t CountTJunctions(const Mesh& mesh) {
  size_t count = 0;
  for (const Mesh::Patch& patch : mesh.patches) {
    const auto border = BorderSides(mesh, patch);
    for (const auto& [a, b] : border) {
      const Vec3d p = mesh.node_position[a].cast<double>();
      const Vec3d along = mesh.node_position[b].cast<double>() - p;
      for (const auto& [n, unused] : border) {  // nodes of the border, each once or twice
        const Vec3d q = mesh.node_position[n].cast<double>() - p;
        const double t = q.dot(along) / along.squaredNorm();
        const bool inside = t > 1e-3 && t < 1 - 1e-3;
        // A midpoint may be a rounding error beside the edge, a node of a corner nearby is far.
        if (inside && (q - t * along).norm() < 1e-5 * along.norm()) ++count;
      }
    }
  }
  return count;
}

inline double BorderLength(const Mesh& mesh) {
  double length = 0;
  for (const Mesh::Patch& patch : mesh.patches) {
    for (const auto& [a, b] : BorderSides(mesh, patch)) {
      length += (mesh.node_position[a].cast<double>() - mesh.node_position[b].cast<double>()).norm();
    }
  }
  return length;
}

inline double SmallestAngle(const Mesh& mesh) {
  double smallest = 10;
  for (const auto& e : mesh.elements) {
    for (int k = 0; k < 3; ++k) {
      const Vec3d p = mesh.node_position[e[k]].cast<double>();
      const Vec3d a = mesh.node_position[e[(k + 1) % 3]].cast<double>() - p;
      const Vec3d b = mesh.node_position[e[(k + 2) % 3]].cast<double>() - p;
      smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  return smallest;
}

/// The layout that Mesh documents and the solution file relies on: patches cover nodes and elements in order;
/// nodes are numbered as elements meet them; elements are the leaves of trees in preorder, each once; a side
/// of an element occurs once in each direction; normals are unit and on the patch's side.
inline void ExpectMeshLayout(const Scene& scene, const Mesh& mesh) {
  const size_t nodes = mesh.node_count(), elements = mesh.element_count();
  ASSERT_EQ(mesh.node_normal.size(), nodes);
  ASSERT_EQ(mesh.node_sample_position.size(), nodes);
  ASSERT_EQ(mesh.node_sample_normal.size(), nodes);
  ASSERT_EQ(mesh.node_patch.size(), nodes);
  ASSERT_EQ(mesh.element_patch.size(), elements);
  ASSERT_EQ(mesh.roots.size(), 2 * scene.faces.size());
  uint32_t node = 0, element = 0;
  for (uint32_t p = 0; p < mesh.patches.size(); ++p) {
    const Mesh::Patch& patch = mesh.patches[p];
    ASSERT_EQ(patch.node_begin, node);
    ASSERT_EQ(patch.element_begin, element);
    for (; element < patch.element_end; ++element) {
      ASSERT_EQ(mesh.element_patch[element], p);
      for (const uint32_t n : mesh.elements[element]) {
        ASSERT_GE(n, patch.node_begin);
        ASSERT_LE(n, node) << "nodes are numbered in the order elements meet them";
        if (n == node) ++node;
      }
    }
    ASSERT_EQ(patch.node_end, node);
    for (uint32_t n = patch.node_begin; n < node; ++n) {
      ASSERT_EQ(mesh.node_patch[n], p);
      ASSERT_NEAR(mesh.node_normal[n].norm(), 1, 1e-5);
      ASSERT_NEAR(mesh.node_sample_normal[n].norm(), 1, 1e-5);
      ASSERT_GT(mesh.node_normal[n].dot(mesh.node_sample_normal[n]), 0);
      const float turned = (mesh.node_normal[n] - mesh.node_normal[patch.node_begin]).norm();
      ASSERT_LE(patch.planar ? turned : 0, 2e-6f);
    }
    for (const auto& [side, count] : DirectedSides(mesh, patch)) ASSERT_EQ(count, 1);
  }
  ASSERT_EQ(node, nodes);
  ASSERT_EQ(element, elements);

  // Roots in the order of their elements, each tree in preorder, give elements 0, 1, 2, ...
  struct Root {
    uint32_t first_element, index;
    bool operator<(const Root& other) const { return first_element < other.first_element; }
  };
  std::vector<Root> roots;
  for (uint32_t i = 0; i < mesh.roots.size(); ++i) {
    uint32_t cell = mesh.roots[i];
    if (cell == kNone) continue;
    while (mesh.cells[cell].child != kNone) cell = mesh.cells[cell].child;
    roots.push_back({mesh.cells[cell].element, i});
  }
  std::sort(roots.begin(), roots.end());
  uint32_t next = 0;
  size_t cells = 0;
  for (const Root& root : roots) {
    const Face& face = scene.faces[root.index / 2];
    std::vector<uint32_t> open = {mesh.roots[root.index]};
    while (!open.empty()) {
      const uint32_t c = open.back();
      const Mesh::Cell& cell = mesh.cells[c];
      open.pop_back();
      ++cells;
      if (cell.child != kNone) {
        ASSERT_GT(cell.child, c) << "children come after parents";
        ASSERT_LT(cell.apex, 3);
        open.insert(open.end(), {cell.child + 1, cell.child});
        continue;
      }
      ASSERT_EQ(cell.element, next++);
      const Mesh::Patch& patch = mesh.patches[mesh.element_patch[cell.element]];
      ASSERT_EQ(patch.surface, face.surface);
      ASSERT_EQ(patch.material, face.material);
      ASSERT_EQ(patch.side, root.index % 2 ? Side::kBack : Side::kFront);
    }
  }
  ASSERT_EQ(next, elements);
  ASSERT_EQ(cells, mesh.cells.size());
}

/// At random points of faces, the corners and weights of the element found give the point.
inline void ExpectLocateGivesThePoint(const Scene& scene, const Mesh& mesh, int points_per_side) {
  std::mt19937 bits(5);
  std::uniform_real_distribution<float> uniform;
  const float size = scene.Bounds().diagonal().norm();
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    const auto p = scene.Corners(scene.faces[f]);
    for (int i = 0; i < 2 * points_per_side; ++i) {
      const Side side = i % 2 ? Side::kBack : Side::kFront;
      float u = uniform(bits), v = uniform(bits);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      if (i % 7 == 0) v = 0;  // on an edge
      const Mesh::Location where = mesh.Locate(f, side, u, v);
      ASSERT_EQ(where.element == kNone, mesh.roots[2 * f + size_t(side)] == kNone);
      if (where.element == kNone) continue;
      Vec3 point = Vec3::Zero();
      for (int k = 0; k < 3; ++k) {
        ASSERT_GE(where.weight[k], 0);
        point += where.weight[k] * mesh.node_position[mesh.elements[where.element][k]];
      }
      // Midpoints and the sum round by a few 2^-24 of the scene's size each.
      ASSERT_LT((point - ((1 - u - v) * p[0] + u * p[1] + v * p[2])).norm(), 2e-6f * size);
    }
  }
}

template <typename T>
bool SameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// Equal in every bit, but for the numbers of cells (no one sees those; trees are compared).
inline void ExpectSameMesh(const Mesh& a, const Mesh& b) {
  EXPECT_TRUE(SameBits(a.node_position, b.node_position));
  EXPECT_TRUE(SameBits(a.node_normal, b.node_normal));
  EXPECT_TRUE(SameBits(a.node_sample_position, b.node_sample_position));
  EXPECT_TRUE(SameBits(a.node_sample_normal, b.node_sample_normal));
  EXPECT_EQ(a.node_patch, b.node_patch);
  EXPECT_EQ(a.element_patch, b.element_patch);
  EXPECT_EQ(a.elements, b.elements);
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (size_t i = 0; i < a.patches.size(); ++i) {
    const Mesh::Patch &p = a.patches[i], &q = b.patches[i];
    EXPECT_EQ(p.material, q.material);
    EXPECT_EQ(p.surface, q.surface);
    EXPECT_EQ(p.side, q.side);
    EXPECT_EQ(p.planar, q.planar);
    EXPECT_EQ(p.node_begin, q.node_begin);
    EXPECT_EQ(p.node_end, q.node_end);
    EXPECT_EQ(p.element_begin, q.element_begin);
    EXPECT_EQ(p.element_end, q.element_end);
  }
  ASSERT_EQ(a.roots.size(), b.roots.size());
  for (size_t i = 0; i < a.roots.size(); ++i) {
    ASSERT_EQ(a.roots[i] == kNone, b.roots[i] == kNone);
    if (a.roots[i] == kNone) continue;
    std::vector<std::pair<uint32_t, uint32_t>> open = {{a.roots[i], b.roots[i]}};
    while (!open.empty()) {
      const Mesh::Cell &p = a.cells[open.back().first], &q = b.cells[open.back().second];
      open.pop_back();
      ASSERT_EQ(p.child == kNone, q.child == kNone);
      ASSERT_EQ(p.element, q.element);
      if (p.child == kNone) continue;
      ASSERT_EQ(p.apex, q.apex);
      open.insert(open.end(), {{p.child, q.child}, {p.child + 1, q.child + 1}});
    }
  }
}

}  // namespace lobe::test
