#pragma once

#include <vector>

#include <Eigen/Core>

#include "scene/mesh.h"
#include "solver/links.h"
#include "solver/node_lobes.h"

namespace lobe {

/// Power of reflected light that left nodes, and what of it reaches no node, by each node's own links. Watts.
struct Losses {
  Eigen::Array3d sent = Eigen::Array3d::Zero(), escaped = Eigen::Array3d::Zero(),
                 blocked = Eigen::Array3d::Zero(), in_glass = Eigen::Array3d::Zero(),
                 below_facets = Eigen::Array3d::Zero();
};

/// Of all that has been shot, total - unshot. `node_area` is 0 for hidden nodes.
Losses FindLosses(const Mesh& mesh, const Links& links, const NodeLobes& total, const NodeLobes& unshot,
                  const std::vector<double>& node_area);

}  // namespace lobe
