#include "scene/mesh_edges.h"

#include <algorithm>

namespace lobe {

std::vector<MeshEdge> MeshEdges(const Mesh& mesh) {
  // Sides of elements, sorted into one bucket for each smaller end: faster than one sort or a hash table.
  struct ElementSide {
    uint32_t far_end, element;
    bool operator<(const ElementSide& other) const {
      return far_end != other.far_end ? far_end < other.far_end : element < other.element;
    }
  };
  const auto for_each_side = [&mesh](const auto& visit) {
    for (uint32_t e = 0; e < mesh.element_count(); ++e) {
      const std::array<uint32_t, 3>& corner = mesh.elements[e];
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(corner[k], corner[(k + 1) % 3]);
        visit(low, ElementSide{high, e});
      }
    }
  };
  std::vector<size_t> bucket_end(mesh.node_count() + 1, 0);
  for_each_side([&](uint32_t low, const ElementSide&) { ++bucket_end[low + 1]; });
  for (size_t n = 1; n < bucket_end.size(); ++n) bucket_end[n] += bucket_end[n - 1];
  std::vector<ElementSide> sides(bucket_end.back());
  // Filling moves each bucket's begin to its end, which is the next one's begin.
  for_each_side([&](uint32_t low, const ElementSide& side) { sides[bucket_end[low]++] = side; });

  std::vector<MeshEdge> edges;
  edges.reserve(sides.size() / 2 + mesh.patches.size());
  size_t begin = 0;
  for (uint32_t n = 0; n < mesh.node_count(); ++n) {
    const size_t end = bucket_end[n];
    std::sort(sides.begin() + ptrdiff_t(begin), sides.begin() + ptrdiff_t(end));
    while (begin < end) {
      const ElementSide& side = sides[begin++];
      MeshEdge edge{{n, side.far_end}, {side.element, kNone}};
      if (begin < end && sides[begin].far_end == side.far_end) edge.element[1] = sides[begin++].element;
      edges.push_back(edge);
    }
  }
  return edges;
}

}  // namespace lobe
