#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/mesh.h"
#include "scene/scene.h"

namespace lobe {

/// Faces with the same three corners, as modelling programs write them for sheets seen from both sides.
/// A ray meets all of them at once, so one has to stand for all.
struct RepeatedFaces {
  struct Twin {
    uint32_t face = kNone;               ///< kNone: it has none
    std::array<uint8_t, 3> corner = {};  ///< where the twin's corners are in this face
  };
  std::vector<uint32_t> kept;  ///< faces to trace, ascending: of equal ones the first
  std::vector<Twin> twins;     ///< by face: of a kept one the first that winds the other way. Empty if all
                            ///< faces are kept. A translucent sheet or a pane modelled twice has none: it is
                            ///< one sheet, and light that goes through the first has to come out of it
};

/// O(n log n) in the number of faces.
RepeatedFaces FindRepeatedFaces(const Scene& scene);

}  // namespace lobe
