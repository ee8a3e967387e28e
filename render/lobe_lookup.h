#pragma once

#include "scene/element_locator.h"
#include "solver/solution.h"

namespace lobe {

/// Reads a solution's lobes where rays meet its surfaces. Values are unclamped: a lobe cut off at l_max rings
/// below zero. Keeps references to the solution. Const methods may run in many threads.
class LobeLookup {
 public:
  explicit LobeLookup(const Solution& solution) : solution_(solution), locator_(solution.mesh) {}

  Mesh::Location Locate(const RayHit& hit) const { return locator_.Locate(hit); }
  const ElementLocator& locator() const { return locator_; }

  /// All reflected light at a place, towards `wo`. `basis`: scratch of kMaxBasisSize floats.
  Rgb Total(const Mesh::Location& where, const Vec3& wo, float* basis) const {
    return Read(solution_.total, LobePart::kBoth, where, wo, basis);
  }
  /// Of it, what comes straight from emitters.
  Rgb Direct(const Mesh::Location& where, const Vec3& wo, float* basis) const {
    return Read(solution_.direct, LobePart::kBoth, where, wo, basis);
  }
  /// Reflected under the coat alone; of it straight from emitters.
  Rgb Base(const Mesh::Location& where, const Vec3& wo, float* basis) const {
    return Read(solution_.total, LobePart::kBase, where, wo, basis);
  }
  Rgb DirectBase(const Mesh::Location& where, const Vec3& wo, float* basis) const {
    return Read(solution_.direct, LobePart::kBase, where, wo, basis);
  }

 private:
  Rgb Read(const NodeLobes& lobes, LobePart part, const Mesh::Location& where, const Vec3& wo,
           float* basis) const;

  const Solution& solution_;
  ElementLocator locator_;
};

}  // namespace lobe
