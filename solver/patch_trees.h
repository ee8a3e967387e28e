#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace lobe {

/// The bisection trees of one patch as the file tells them.
struct PatchTrees {
  std::vector<uint32_t> faces;      ///< the roots'
  std::vector<uint8_t> bisections;  ///< preorder: 0 leaf, 1 + apex split
  std::vector<uint32_t> triangles;  ///< leaves in that order, corners counted from the patch's first node
};

/// Of all patches, by number. Throws std::logic_error if the trees of one do not cover its elements.
std::vector<PatchTrees> TreesByPatch(const Mesh& mesh);

}  // namespace lobe
