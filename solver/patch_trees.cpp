#include "solver/patch_trees.h"

#include <algorithm>
#include <stdexcept>

namespace lobe {
namespace {

uint32_t FirstElement(const Mesh& mesh, uint32_t cell) {
  while (mesh.cells[cell].child != kNone) cell = mesh.cells[cell].child;
  return mesh.cells[cell].element;
}

void AppendTree(const Mesh& mesh, uint32_t root, uint32_t node_begin, PatchTrees* trees) {
  std::vector<uint32_t> open = {root};
  while (!open.empty()) {
    const Mesh::Cell& cell = mesh.cells[open.back()];
    open.pop_back();
    if (cell.child == kNone) {
      trees->bisections.push_back(0);
      for (const uint32_t node : mesh.elements[cell.element]) trees->triangles.push_back(node - node_begin);
    } else {
      trees->bisections.push_back(uint8_t(1 + cell.apex));
      open.push_back(cell.child + 1);
      open.push_back(cell.child);
    }
  }
}

}  // namespace

std::vector<PatchTrees> TreesByPatch(const Mesh& mesh) {
  struct Root {
    uint32_t face, cell, element;
  };
  std::vector<std::vector<Root>> roots(mesh.patches.size());
  for (size_t i = 0; i < mesh.roots.size(); ++i) {
    if (mesh.roots[i] == kNone) continue;
    const uint32_t element = FirstElement(mesh, mesh.roots[i]);
    roots[mesh.element_patch[element]].push_back({uint32_t(i / 2), mesh.roots[i], element});
  }
  std::vector<PatchTrees> out(mesh.patches.size());
  for (size_t p = 0; p < mesh.patches.size(); ++p) {
    // In the elements' own order, so that reading numbers them as they were.
    std::sort(roots[p].begin(), roots[p].end(),
              [](const Root& a, const Root& b) { return a.element < b.element; });
    const Mesh::Patch& patch = mesh.patches[p];
    for (const Root& root : roots[p]) {
      out[p].faces.push_back(root.face);
      AppendTree(mesh, root.cell, patch.node_begin, &out[p]);
    }
    if (out[p].triangles.size() != 3 * size_t(patch.element_end - patch.element_begin)) {
      throw std::logic_error("the bisection trees of a patch do not cover its elements");
    }
  }
  return out;
}

}  // namespace lobe
