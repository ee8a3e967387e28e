#include "scene/element_locator.h"

#include <algorithm>

#include <tbb/parallel_for.h>
#include <Eigen/Core>

namespace lobe {
namespace {

// Weights of a cell's corners as linear functions of the face's (u, v, 1), one per row.
using Weights = std::array<Eigen::Vector3d, 3>;

struct Open {
  uint32_t cell;
  int depth;
  Weights weights;
};

constexpr int kTogether = 16;  // hits that go down in step

}  // namespace

ElementLocator::ElementLocator(const Mesh& mesh)
    : roots_(mesh.roots),
      depths_(mesh.roots.size(), 0),
      splits_(mesh.cells.size() + 1),
      leaf_of_cell_(mesh.cells.size() + 1),
      leaves_(mesh.elements.size() + 1) {
  const uint32_t nowhere = uint32_t(mesh.cells.size());
  splits_[nowhere] = {0, 0, 0, nowhere};
  leaf_of_cell_[nowhere] = uint32_t(mesh.elements.size());
  leaves_.back() = {{}, {}, kNone};
  tbb::parallel_for(size_t(0), mesh.roots.size(), [&](size_t root) {
    if (mesh.roots[root] == kNone) {
      roots_[root] = nowhere;
      return;
    }
    Weights corners = {Eigen::Vector3d(-1, -1, 1), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)};
    if (Side(root % 2) == Side::kBack) std::swap(corners[1], corners[2]);
    int deepest = 0;
    std::vector<Open> open = {{mesh.roots[root], 0, corners}};
    while (!open.empty()) {
      const auto [at, depth, w] = open.back();
      open.pop_back();
      deepest = std::max(deepest, depth);
      const Mesh::Cell& cell = mesh.cells[at];
      if (cell.child == kNone) {
        splits_[at] = {0, 0, 0, at};
        leaf_of_cell_[at] = cell.element;
        leaves_[cell.element] = {{float(w[0][0]), float(w[0][1]), float(w[0][2])},
                                 {float(w[1][0]), float(w[1][1]), float(w[1][2])},
                                 cell.element};
        continue;
      }
      // As Mesh::Locate goes down: a p0 + b p1 + c p2 has weights (a, b - c, 2c) or (a, 2b, c - b).
      const Eigen::Vector3d &a = w[cell.apex], &b = w[(cell.apex + 1) % 3], &c = w[(cell.apex + 2) % 3];
      const Eigen::Vector3d side = b - c;
      splits_[at] = {float(side[0]), float(side[1]), float(side[2]), cell.child};
      open.push_back({cell.child + 1, depth + 1, {a, 2 * b, -side}});
      open.push_back({cell.child, depth + 1, {a, side, 2 * c}});
    }
    depths_[root] = uint32_t(deepest);
  });
}

const ElementLocator::Leaf& ElementLocator::FindLeaf(uint32_t face_side, float u, float v) const {
  uint32_t at = roots_[face_side];
  for (uint32_t level = depths_[face_side]; level > 0; --level) {
    const Split& s = splits_[at];
    if (s.child == at) break;
    at = s.child + uint32_t(s.u * u + s.v * v + s.constant < 0);
  }
  return leaves_[leaf_of_cell_[at]];
}

void ElementLocator::Locate(std::span<const RayHit> hits, std::span<Mesh::Location> where) const {
  for (size_t begin = 0; begin < hits.size(); begin += kTogether) {
    const int count = int(std::min<size_t>(kTogether, hits.size() - begin));
    uint32_t at[kTogether];
    float u[kTogether], v[kTogether];
    int depth = 0;
    for (int i = 0; i < count; ++i) {
      const RayHit& hit = hits[begin + i];
      const size_t root = 2 * size_t{hit.face} + size_t(hit.side);
      at[i] = hit.hit() ? roots_[root] : uint32_t(splits_.size() - 1);
      depth = std::max(depth, hit.hit() ? int(depths_[root]) : 0);
      u[i] = hit.u;
      v[i] = hit.v;
    }
    for (int level = 0; level < depth; ++level) {
      for (int i = 0; i < count; ++i) {
        const Split& s = splits_[at[i]];
        at[i] = s.child + uint32_t(s.u * u[i] + s.v * v[i] + s.constant < 0);
      }
    }
    for (int i = 0; i < count; ++i) {
      const Leaf& leaf = leaves_[leaf_of_cell_[at[i]]];
      float w0 = leaf.w0[0] * u[i] + leaf.w0[1] * v[i] + leaf.w0[2];
      float w1 = leaf.w1[0] * u[i] + leaf.w1[1] * v[i] + leaf.w1[2];
      float w2 = 1 - w0 - w1;
      // A hit on an edge may lie a rounding error outside.
      w0 = w0 > 0 ? w0 : 0;
      w1 = w1 > 0 ? w1 : 0;
      w2 = w2 > 0 ? w2 : 0;
      const float scale = 1 / (w0 + w1 + w2);
      where[begin + i] = {leaf.element, {w0 * scale, w1 * scale, w2 * scale}};
    }
  }
}

}  // namespace lobe
