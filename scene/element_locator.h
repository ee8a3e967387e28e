#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/mesh.h"
#include "scene/ray_tracer.h"

namespace lobe {

/// Mesh::Locate for very many hits: the same answer but for rounding on the edges of elements, at a tenth of
/// the cost. Every split of a bisection tree is kept as one linear function over the face's barycentrics,
/// every element as two; and many hits go down in step, so that their loads and sums overlap.
/// 40 bytes a cell. The mesh must not change meanwhile.
class ElementLocator {
 public:
  explicit ElementLocator(const Mesh& mesh);

  /// What was not hit has no element.
  void Locate(std::span<const RayHit> hits, std::span<Mesh::Location> where) const;
  Mesh::Location Locate(const RayHit& hit) const {
    Mesh::Location where;
    Locate({&hit, 1}, {&where, 1});
    return where;
  }

  /// Weights of an element's nodes as functions of the face's barycentrics.
  struct Leaf {
    std::array<float, 3> w0, w1;  ///< weights of the first two nodes: factors of u, v and a constant
    uint32_t element;             ///< kNone: that side has no nodes
  };
  /// `face_side`: 2 * face + side.
  const Leaf& FindLeaf(uint32_t face_side, float u, float v) const;

 private:
  struct Split {
    float u, v, constant;  ///< below 0: second child
    uint32_t child;        ///< of a leaf: itself, so that going on stays
  };
  std::vector<uint32_t> roots_;   // as Mesh::roots; where a side has no nodes, a leaf without element
  std::vector<uint32_t> depths_;  // of the roots' trees
  std::vector<Split> splits_;
  std::vector<uint32_t> leaf_of_cell_;
  std::vector<Leaf> leaves_;
};

}  // namespace lobe
