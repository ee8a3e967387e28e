#pragma once

#include <cstdint>
#include <vector>

#include "scene/box_tree.h"
#include "scene/edge_table.h"
#include "scene/scene.h"

namespace lobe {

/// Straight piece of a line on a face at which light may jump.
struct ContactLine {
  Vec3d a, b;
};

/// Lengths below which things are one, metres.
struct ContactReach {
  double rounding;  ///< of coordinates: what is nearer touches
  double snap;      ///< points nearer to each other become one; some roundings
  double distance;  ///< what is nearer is taken to touch; at least `snap`
};

/// For a scene of this size; `distance` as asked for, but at most a thousandth of the scene.
ContactReach ReachIn(const Scene& scene, double distance);

/// Finds where other faces of a scene meet a face. Const methods may run in many threads.
class ContactFinder {
 public:
  ContactFinder(const Scene& scene, const EdgeTable& edges, const ContactReach& reach);

  /// Lines on `face`, cut off at its border; those along its own edges included. `both_sides`: its back is
  /// seen too. Every line once, up to overlaps.
  std::vector<ContactLine> LinesOn(uint32_t face, bool both_sides) const;

 private:
  struct Target;
  bool IsOutline(const Target& target, uint32_t edge, double sign, bool touches) const;
  void AddCrossing(const Target& target, const Face& other, std::vector<ContactLine>* lines) const;
  void AddNearEdge(const Target& target, uint32_t edge, std::vector<ContactLine>* lines) const;

  const Scene& scene_;
  const EdgeTable& edges_;
  ContactReach reach_;
  BoxTree tree_;
};

}  // namespace lobe
