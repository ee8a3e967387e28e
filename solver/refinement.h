#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh.h"
#include "scene/refine.h"
#include "solver/node_lobes.h"

namespace lobe {

/// Where a mesh is too coarse for the light on it.
struct RefineOptions {
  /// Split where light in the middle of an edge is off the mean of its ends by more than this fraction of the
  /// brightness thereabouts (half that of the place, half the scene's mean); 0: keep the mesh uniform. Finer
  /// meshes cost nodes, about in inverse proportion. Default measured in docs/validation.md#refine.
  /// Beside contacts (solver/near_contacts.h) light reflected once counts too, and the fraction is 0.4 of
  /// this, of the place alone; docs/validation.md#contact-truth.
  double error = 0.10;
  /// Beside lines of contact, split also where light reflected once bends by more than this fraction of the
  /// brightness of the very place; 0: do not look. 0.04 brings light at contacts within 3 % of a path
  /// tracer's up to a millimetre off, for three to seven times the time (docs/validation.md#contact-truth).
  double contact_error = 0;
  /// Rounds of bisection: two halve the edges. 0 to 16. Beside contacts they are followed by as many more,
  /// and two.
  int rounds = 6;
  /// Stop refining beyond so many nodes.
  uint64_t max_nodes = 20'000'000;
};

/// Measures how far from linear light is on a mesh. All differences are rms over directions, over the
/// brightness thereabouts.
class Roughness {
 public:
  /// `light` on the nodes of `mesh`, `area` per node (0: leave the node out). Patches of `sharp` materials
  /// (per material) are compared by flux alone: what the eye sees of their gloss is traced, not read.
  Roughness(const Mesh& mesh, const NodeLobes& light, const std::vector<double>& area,
            const std::vector<bool>& sharp = {});
  /// With the eye on contacts: only what is `near` them (NearContacts) counts, in proportion, and against the
  /// brightness of the place alone: beside a contact it may be dark.
  Roughness(const Mesh& mesh, const NodeLobes& light, const std::vector<double>& area,
            const std::vector<bool>& sharp, const std::vector<float>& near);

  /// First guess, per element: the largest difference between ends of an edge, where above `error`.
  std::vector<float> BetweenEnds(double error) const;
  /// After `refined`, whose light this is: the largest error that interpolation would have made at one of the
  /// nodes it made, per element that has one, where above `error`. What is linear stops here.
  std::vector<float> AtMidpoints(const Refinement& refined, double error) const;

 private:
  // rms over directions and channels of sum_i weight_i L_i, nodes of one patch.
  double Norm(const uint32_t* nodes, const double* weights, int count) const;
  // Of a difference on the edge between `ends`, over the brightness there.
  double Relative(double difference, const uint32_t ends[2]) const;

  const Mesh& mesh_;
  const NodeLobes& light_;
  const std::vector<double>& area_;
  std::vector<bool> by_flux_;  // per patch
  const std::vector<float>* near_ = nullptr;
  double mean_ = 0;  // rms brightness of the scene
};

/// The same lobes on a refined mesh: old nodes keep theirs, new ones start from zero.
NodeLobes CarryOver(const NodeLobes& lobes, const Refinement& refined);

}  // namespace lobe
