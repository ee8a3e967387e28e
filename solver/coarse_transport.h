#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "brdf/material_lobes.h"
#include "scene/mesh.h"
#include "solver/links.h"
#include "solver/node_lobes.h"

namespace lobe {

/// The scene as a few hundred diffuse clusters, each one brightness: solved at once, it tells how much more
/// light every cluster will send before all is settled, so that a sweep can send it ahead ("overshooting":
/// Feda and Purgathofer, EGWR 1992; Xu and Fussell, EGWR 1994. The cluster system is aggregation of algebraic
/// multigrid). It only ever suggests what to shoot: the solver takes the surplus back from what is still
/// unshot, so the fixed point is that of plain sweeps whatever is suggested.
class CoarseTransport {
 public:
  /// Patches are clusters, the largest kClusters - 1; the others share the last.
  static constexpr int kClusters = 256;

  /// Form factors between clusters counted from `links`; albedos averaged over the hemisphere, and over a
  /// sheet's other side (`opposite`: per node, kNone or empty where there is none).
  CoarseTransport(const Mesh& mesh, const Links& links, const std::vector<MaterialLobes>& materials,
                  const std::vector<double>& node_area, const std::vector<uint32_t>& opposite);

  /// Per patch and channel: the share of what a patch has gathered so far (`total`) that is worth shooting
  /// ahead, beside all of `unshot`. Zero where nothing sensible can be said. `direct`: what of `total` has
  /// come by no cluster. A cluster that should have gathered more than `most_overrated` times what came is
  /// taken to gather as much less from now on.
  std::vector<std::array<float, 3>> Ahead(const NodeLobes& total, const NodeLobes& direct,
                                          const NodeLobes& unshot, const std::vector<double>& node_area,
                                          double most_overrated) const;

 private:
  void CorrectRows(const Eigen::VectorXd& shot, const Eigen::VectorXd& came, double most_overrated,
                   Eigen::MatrixXd* system) const;

  const Mesh& mesh_;
  std::vector<uint32_t> cluster_;  // per patch
  int clusters_ = 0;
  Eigen::MatrixXd form_factor_;            // row: receiver
  std::array<Eigen::VectorXd, 3> albedo_;  // per channel
  std::array<Eigen::VectorXd, 3> through_;
  std::vector<int> other_side_;  // cluster
  std::vector<double> area_;
};

}  // namespace lobe
