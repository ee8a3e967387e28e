#include "solver/node_lobes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include "brdf/frame.h"
#include "sh/lobe.h"
#include "sh/simd.h"

namespace lobe {

NodeLobes::NodeLobes(const Mesh& mesh, const std::vector<PartDegrees>& patch_degrees)
    : patch_degrees_(patch_degrees), node_patch_(mesh.node_patch) {
  size_t size = 0;
  int max_degree = 0;
  for (size_t p = 0; p < mesh.patches.size(); ++p) {
    const auto& patch = mesh.patches[p];
    patch_begin_.push_back(patch.node_begin);
    patch_offset_.push_back(size);
    patch_stride_.push_back(size_t(3) * patch_degrees[p].count());
    size += patch_stride_.back() * (patch.node_end - patch.node_begin);
    max_degree = std::max(max_degree, patch_degrees[p].max_degree());
  }
  values_.assign(size, 0.0f);
  zonal_flux_.resize(max_degree + 1);
  bases_.resize(max_degree + 1);
  for (const auto& degrees : patch_degrees) {
    for (const int l_max : {degrees.base, degrees.gloss}) {
      if (l_max < 0 || bases_[l_max]) continue;
      bases_[l_max] = std::make_shared<HemisphereBasis<float>>(l_max);
      const Eigen::VectorXd weights = FluxWeights(l_max);
      for (int l = 0; l <= l_max; l += 2)
        zonal_flux_[l_max].push_back(float(weights[CoefficientIndex(l, 0)]));
    }
  }
}

std::span<float> NodeLobes::patch_values(uint32_t patch) {
  const size_t end = patch + 1 < patch_offset_.size() ? patch_offset_[patch + 1] : values_.size();
  return {values_.data() + patch_offset_[patch], end - patch_offset_[patch]};
}

std::span<const float> NodeLobes::patch_values(uint32_t patch) const {
  return const_cast<NodeLobes*>(this)->patch_values(patch);
}

void NodeLobes::SetZero() { std::fill(values_.begin(), values_.end(), 0.0f); }

void NodeLobes::AddScaled(const NodeLobes& other, const std::vector<std::array<float, 3>>& share) {
  tbb::parallel_for(uint32_t(0), uint32_t(node_count()), [&](uint32_t n) {
    const auto& s = share[node_patch_[n]];
    SubtractScaled(n, other, {-s[0], -s[1], -s[2]});
  });
}

void NodeLobes::SubtractScaled(uint32_t node, const NodeLobes& other, const std::array<float, 3>& share) {
  const PartDegrees& d = degrees(node);
  float* to = base(node);
  const float* from = other.base(node);
  for (const int count : {d.base_count(), d.gloss_count()}) {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < count; ++k) *to++ -= share[c] * *from++;
    }
  }
}

Rgb NodeLobes::Flux(uint32_t node) const {
  const PartDegrees& d = degrees(node);
  Rgb flux = Rgb::Zero();
  const auto add = [&](const float* coefficients, int l_max, int count) {
    if (l_max < 0) return;
    const auto& weights = zonal_flux_[l_max];
    for (int c = 0; c < 3; ++c) {
      float sum = 0;
      for (size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i] * coefficients[c * count + CoefficientIndex(2 * int(i), 0)];
      }
      flux[c] += sum;
    }
  };
  add(base(node), d.base, d.base_count());
  add(gloss(node), d.gloss, d.gloss_count());
  return flux;
}

Rgb NodeLobes::Radiance(uint32_t node, const Vec3& wo_local, float* basis, LobePart part) const {
  const PartDegrees& d = degrees(node);
  const int degree = part == LobePart::kBoth ? d.max_degree() : d.base;
  if (degree < 0) return Rgb::Zero();
  if (d.diffuse()) {
    const float* v = base(node);
    return Rgb(v[0], v[1], v[2]) * (1.0f / std::sqrt(2.0f * std::numbers::pi_v<float>));
  }
  const Vec3 wo = BendToHorizon(wo_local);
  bases_[degree]->Evaluate(wo.x(), wo.y(), wo.z(), basis);
  return RadianceFromBasis(node, basis, part);
}

Rgb NodeLobes::RadianceFromBasis(uint32_t node, const float* basis, LobePart part) const {
  const PartDegrees& d = degrees(node);
  Rgb out = Rgb::Zero();
  const float *b = base(node), *g = gloss(node);
  const int base_count = d.base_count(), gloss_count = d.gloss_count();
  const bool with_gloss = gloss_count > 0 && part != LobePart::kBase;
  for (int c = 0; c < 3; ++c) {
    if (base_count > 0) out[c] += Dot(b + c * base_count, basis, base_count);
    if (with_gloss) out[c] += Dot(g + c * gloss_count, basis, gloss_count);
  }
  return out;
}

}  // namespace lobe
