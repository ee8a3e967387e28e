#include "scene/box_tree.h"

#include <algorithm>

namespace lobe {

BoxTree::BoxTree(std::vector<Item> items) : items_(std::move(items)) {
  if (items_.empty()) return;
  nodes_.reserve(items_.size());
  nodes_.emplace_back();
  Split(0, 0, static_cast<uint32_t>(items_.size()));
}

void BoxTree::Split(uint32_t node, uint32_t begin, uint32_t end) {
  constexpr uint32_t kLeaf = 4;
  Eigen::AlignedBox3f box, centres;
  for (uint32_t i = begin; i < end; ++i) {
    box.extend(items_[i].box);
    centres.extend(items_[i].box.center());
  }
  nodes_[node] = {box, begin, end - begin};
  if (end - begin <= kLeaf) return;

  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const uint32_t middle = begin + (end - begin) / 2;
  const auto centre = [axis](const Item& i) { return i.box.min()[axis] + i.box.max()[axis]; };
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                   [&](const Item& a, const Item& b) {
                     return centre(a) != centre(b) ? centre(a) < centre(b) : a.number < b.number;
                   });
  const uint32_t children = static_cast<uint32_t>(nodes_.size());
  nodes_[node].first = children;
  nodes_[node].count = 0;
  nodes_.resize(children + 2);
  Split(children, begin, middle);
  Split(children + 1, middle, end);
}

}  // namespace lobe
