#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "brdf/frame.h"
#include "brdf/incident_moments.h"
#include "brdf/material_lobes.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "sh/lobe_reader.h"
#include "solver/links.h"
#include "solver/node_lobes.h"
#include "solver/received.h"

namespace lobe {

/// Light that one sweep reads through the links: lobes of nodes, or (emission) what emitters send by way of
/// mirrors and nothing else carries.
class LinkField {
 public:
  /// Emission of emitters at the ends of chains.
  LinkField(const Scene& scene, const Mesh& mesh);
  /// Lobes of nodes, zero where a node sends nothing. Makes a copy fit for reading, of at most these degrees
  /// (per patch; empty: as they are), with the same flux.
  LinkField(const Scene& scene, const Mesh& mesh, const NodeLobes& lobes,
            const std::vector<int>& degrees = {});

  bool emission() const { return emission_; }
  /// True where all light of the field is the same in every direction: reading is one load.
  bool diffuse(uint32_t node) const { return radiance_[node][3] == 0; }
  const float* radiance(uint32_t node) const { return radiance_[node].data(); }
  /// Of a node that is not diffuse; may be negative. 0 below the node's horizon
  /// (docs/conventions.md#horizon).
  Rgb Read(uint32_t node, const Vec3& wo_world) const;
  /// Emitted by the surface of `node`.
  const Rgb& emitted(uint32_t node) const;

 private:
  size_t PackedAt(uint32_t node) const;

  const Scene& scene_;
  const Mesh& mesh_;
  bool emission_ = true;
  // Lobes as sh/lobe_reader.h wants them, base and gloss together; reader and place by patch and node.
  std::vector<const LobeReader*> reader_of_patch_;  // null: the same in every direction
  std::map<int, LobeReader> readers_;
  std::vector<size_t> packed_begin_;  // per patch
  std::vector<float> packed_;
  // Padded to 16 bytes; the fourth float is 0 for a diffuse node and 1 for one with a lobe to read.
  std::vector<std::array<float, 4>> radiance_;
};

/// Gathers a field at one node after another, through its links. One per thread; holds scratch.
class LinkReceiver {
 public:
  LinkReceiver(const Mesh& mesh, const Links& links, const std::vector<MaterialLobes>& materials);

  /// Adds the light that leaves `node` for what its links bring to `out` (layout of NodeLobes), and what a
  /// sheet lets through to `received.through`. `thinning` 1, 2, 4 or 8: uses every so many-th direction of
  /// each ring.
  Received Gather(uint32_t node, const LinkField& field, int thinning, float* out);

 private:
  void ReadRing(const LinkField& field, std::span<const uint32_t> ring_links, int ring, int first,
                int thinning, const LinkDirections& directions, const Frame& frame, Received& work);

  const Mesh& mesh_;
  const Links& links_;
  const std::vector<MaterialLobes>& materials_;
  DirectionsByPattern directions_;
  std::vector<float> ring_;  // three planes, one value a sector
  IncidentMoments moments_;
};

}  // namespace lobe
