#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "brdf/material_lobes.h"
#include "brdf/rgb.h"
#include "scene/mesh.h"
#include "sh/hemisphere_basis.h"

namespace lobe {

/// Degrees of the two parts a node of one patch stores; -1: part absent.
struct PartDegrees {
  int base = 0, gloss = -1;
  int base_count() const { return base < 0 ? 0 : (base + 1) * (base + 2) / 2; }
  int gloss_count() const { return gloss < 0 ? 0 : (gloss + 1) * (gloss + 2) / 2; }
  int count() const { return base_count() + gloss_count(); }  ///< coefficients per channel
  int max_degree() const { return base > gloss ? base : gloss; }
  bool diffuse() const { return base <= 0 && gloss < 0; }
  bool operator==(const PartDegrees&) const = default;
};

/// What of a coated material is read.
enum class LobePart { kBoth, kBase };

/// A field of lobes, one per node: reflected radiance leaving in every direction, in each node's own
/// frame. A node's floats: base, channel by channel (c * base_count + k), then gloss likewise. A diffuse
/// node is 3 floats. One allocation for all.
class NodeLobes {
 public:
  NodeLobes() = default;
  /// All zero. `patch_degrees[p]` for the nodes of mesh.patches[p].
  NodeLobes(const Mesh& mesh, const std::vector<PartDegrees>& patch_degrees);

  const PartDegrees& degrees(uint32_t node) const { return patch_degrees_[node_patch_[node]]; }
  float* base(uint32_t node) { return values_.data() + offset(node); }
  const float* base(uint32_t node) const { return values_.data() + offset(node); }
  float* gloss(uint32_t node) { return base(node) + 3 * degrees(node).base_count(); }
  const float* gloss(uint32_t node) const { return base(node) + 3 * degrees(node).base_count(); }
  std::span<float> all(uint32_t node) { return {base(node), size_t(3) * degrees(node).count()}; }
  std::span<const float> all(uint32_t node) const { return {base(node), size_t(3) * degrees(node).count()}; }
  std::span<const float> patch_values(uint32_t patch) const;  ///< node after node
  std::span<float> patch_values(uint32_t patch);

  size_t node_count() const { return node_patch_.size(); }
  size_t patch_count() const { return patch_degrees_.size(); }
  const PartDegrees& patch_degrees(uint32_t p) const { return patch_degrees_[p]; }
  /// Of any patch; 0 without any.
  int max_degree() const { return bases_.empty() ? 0 : int(bases_.size()) - 1; }
  size_t bytes() const { return values_.size() * sizeof(float); }

  void SetZero();
  /// this += share of `other`, share per patch and channel. Same layout.
  void AddScaled(const NodeLobes& other, const std::vector<std::array<float, 3>>& share);
  /// The same for one node, subtracted.
  void SubtractScaled(uint32_t node, const NodeLobes& other, const std::array<float, 3>& share);

  /// Integral of L cos over the hemisphere (W m^-2), base and gloss together.
  Rgb Flux(uint32_t node) const;

  /// Radiance leaving `node` towards `wo_local` (bent to the horizon), base and gloss together or one of
  /// them; may be negative where a cut-off lobe rings. `basis` is scratch of at least
  /// CoefficientCount(max_degree).
  Rgb Radiance(uint32_t node, const Vec3& wo_local, float* basis, LobePart part = LobePart::kBoth) const;
  /// The same for a basis already evaluated in this node's frame, for this part or both.
  Rgb RadianceFromBasis(uint32_t node, const float* basis, LobePart part = LobePart::kBoth) const;

 private:
  size_t offset(uint32_t node) const {
    const uint32_t p = node_patch_[node];
    return patch_offset_[p] + size_t(node - patch_begin_[p]) * patch_stride_[p];
  }
  std::vector<PartDegrees> patch_degrees_;
  std::vector<size_t> patch_offset_, patch_stride_;
  std::vector<uint32_t> patch_begin_;
  std::vector<uint32_t> node_patch_;
  // By degree: flux of H_l0 for l = 0, 2, …; no other basis function has any.
  std::vector<std::vector<float>> zonal_flux_;
  // By degree used, for Radiance().
  std::vector<std::shared_ptr<const HemisphereBasis<float>>> bases_;
  std::vector<float> values_;
};

}  // namespace lobe
