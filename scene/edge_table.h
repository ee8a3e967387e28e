#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace lobe {

/// Which faces meet at which edge, by position: files repeat a vertex for each of its normals. Places and
/// edges are numbered; faces without area have none and share nothing.
class EdgeTable {
 public:
  struct Use {
    uint32_t face;
    uint8_t k;  ///< the edge runs from corner k to k + 1
  };

  explicit EdgeTable(const Scene& scene);

  bool usable(uint32_t face) const { return usable_[face] != 0; }
  uint32_t place(uint32_t vertex) const { return place_[vertex]; }  ///< equal for equal positions
  uint32_t edge(uint32_t face, int k) const { return edge_[3 * size_t{face} + k]; }
  size_t edge_count() const { return ends_.size(); }
  /// Places; the lower number first.
  const std::array<uint32_t, 2>& ends(uint32_t edge) const { return ends_[edge]; }
  const Vec3& position(uint32_t place) const { return position_[place]; }
  /// Faces ascending.
  std::span<const Use> uses(uint32_t edge) const {
    return {uses_.data() + first_use_[edge], first_use_[edge + 1] - first_use_[edge]};
  }

  /// How many places two faces have in common. 3: they repeat each other, whichever way they wind.
  int SharedPlaces(const Face& a, const Face& b) const;

 private:
  std::vector<uint8_t> usable_;
  std::vector<uint32_t> place_;  // by vertex
  std::vector<Vec3> position_;
  std::vector<uint32_t> edge_;  // by 3 * face + k
  std::vector<std::array<uint32_t, 2>> ends_;
  std::vector<size_t> first_use_;
  std::vector<Use> uses_;
};

}  // namespace lobe
