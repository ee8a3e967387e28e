#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace lobe {

/// Faces that lie in one plane, to rounding, and share some of its area. Rays cannot tell them apart.
struct CoplanarFaces {
  /// By face: the first face with the same three corners, in any order. Empty: no face repeats another.
  std::vector<uint32_t> first;
  /// Pairs that overlap without being the same, ascending; of faces with the same corners the first stands
  /// for all.
  std::vector<std::array<uint32_t, 2>> overlaps;

  bool none() const { return first.empty() && overlaps.empty(); }
};

/// Sorts faces into thin slabs of almost one normal and sweeps each, so that scenes without such faces cost
/// little: O(n log n) for faces of like size in any number of planes, and what the pairs cost.
CoplanarFaces FindCoplanarFaces(const Scene& scene);

/// Distance below which points of these two faces are at one place, metres: a few roundings of the farther
/// one's coordinates, but no more than a thousandth of the smaller one, as for rays (RayTracer::Lift).
double CoplanarTolerance(const Scene& scene, const Face& a, const Face& b);

}  // namespace lobe
