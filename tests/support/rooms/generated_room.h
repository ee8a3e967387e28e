#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "scene/scene.h"

namespace lobe::test {

/// A furnished room such as users model, drawn by a seed: any size, any opaque reflectance, flat and smooth
/// shading, everyday facet counts. Closed walls, lamps inside, one camera "view" that sees a good part of it
/// and stands in nothing.
struct GeneratedRoom {
  uint64_t seed;
  Scene scene;
  float size;         ///< longest side, metres, 0.05 to 500
  double sharp_area;  ///< share of the surfaces whose gloss is of roughness < 0.3, mirrors and panes too
  bool solid_glass;
  bool lamps_seen_directly;
  std::set<std::string> features;  ///< words to break tables down by

  explicit GeneratedRoom(uint64_t seed);
};

}  // namespace lobe::test
