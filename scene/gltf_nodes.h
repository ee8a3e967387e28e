#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "scene/gltf_file.h"
#include "scene/gltf_json.h"
#include "sh/vector.h"

namespace lobe {

/// A node of the default scene, placed in the world.
struct GltfNode {
  std::string name;  ///< its own, or "node 3"
  Eigen::Affine3d to_world;
  int mesh = -1, camera = -1;  ///< -1: none
};

inline GltfJson Document(const GltfFile& file) { return GltfJson(file.path(), file.json()); }

/// All nodes of the default scene (`scene`, or scene 0; of a file without scenes every root), parents before
/// children, in the order of the file. Throws InputError if a node is missing or is reached twice (a cycle,
/// or two parents), or its transform is not an affine one.
std::vector<GltfNode> ReadNodes(const GltfFile& file, std::vector<std::string>* warnings);

}  // namespace lobe
