#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "sh/vector.h"

namespace lobe {

/// Finds boxes that meet a flat region of space. (Embree's trees answer rays only.)
class BoxTree {
 public:
  struct Item {
    Eigen::AlignedBox3f box;
    uint32_t number;
  };

  /// O(n log n).
  explicit BoxTree(std::vector<Item> items);

  /// Calls `visit(number)` for items whose boxes meet both `region` and the slab within `reach` of the plane
  /// of points x with normal.dot(x) = offset. Always in the same order.
  template <typename Visit>
  void Find(const Eigen::AlignedBox3f& region, const Vec3& normal, float offset, float reach,
            const Visit& visit) const {
    if (nodes_.empty()) return;
    const Vec3 absolute = normal.cwiseAbs();
    const auto meets = [&](const Eigen::AlignedBox3f& box) {
      if (!box.intersects(region)) return false;
      const Vec3 centre = (box.min() + box.max()) * 0.5f, half = (box.max() - box.min()) * 0.5f;
      return std::abs(normal.dot(centre) - offset) <= absolute.dot(half) + reach;
    };
    uint32_t stack[64];  // halving: never deeper than the bits of a count
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!meets(node.box)) continue;
      if (node.count > 0) {
        for (uint32_t i = node.first; i < node.first + node.count; ++i) {
          if (meets(items_[i].box)) visit(items_[i].number);
        }
        continue;
      }
      stack[depth++] = node.first;
      stack[depth++] = node.first + 1;
    }
  }

 private:
  struct Node {
    Eigen::AlignedBox3f box;
    uint32_t first;  // item of a leaf, else node of the first of two children
    uint32_t count;  // 0: not a leaf
  };
  void Split(uint32_t node, uint32_t begin, uint32_t end);

  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

}  // namespace lobe
