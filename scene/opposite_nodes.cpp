#include "scene/opposite_nodes.h"

#include <utility>

namespace lobe {

std::vector<uint32_t> OppositeNodes(const Mesh& mesh, const Scene& scene) {
  std::vector<uint32_t> opposite(mesh.node_count(), kNone);
  std::vector<std::pair<uint32_t, uint32_t>> pending;  // a front's cell and the back's
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    const uint32_t front_root = mesh.roots[2 * f], back_root = mesh.roots[2 * f + 1];
    if (front_root == kNone || back_root == kNone || !scene.material(scene.faces[f]).transmits()) continue;
    pending.emplace_back(front_root, back_root);
    while (!pending.empty()) {
      const auto [front_cell, back_cell] = pending.back();
      pending.pop_back();
      const Mesh::Cell &front = mesh.cells[front_cell], &back = mesh.cells[back_cell];
      // Corner k of one is corner (3 - k) % 3 of the other, and so the halves of a cut change places.
      if (front.child == kNone && back.child == kNone) {
        const auto &a = mesh.elements[front.element], &b = mesh.elements[back.element];
        for (int k = 0; k < 3; ++k) {
          opposite[a[k]] = b[(3 - k) % 3];
          opposite[b[(3 - k) % 3]] = a[k];
        }
      } else if (front.child != kNone && back.child != kNone && (front.apex + back.apex) % 3 == 0) {
        pending.emplace_back(front.child, back.child + 1);
        pending.emplace_back(front.child + 1, back.child);
      }
    }
  }
  // A mesh from elsewhere may join nodes on one side that are apart on the other.
  std::vector<uint32_t> mutual(opposite.size(), kNone);
  for (uint32_t n = 0; n < opposite.size(); ++n) {
    if (opposite[n] != kNone && opposite[opposite[n]] == n) mutual[n] = opposite[n];
  }
  return mutual;
}

}  // namespace lobe
