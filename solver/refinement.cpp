#include "solver/refinement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {
namespace {

// Light beside contacts is not measured against less than this fraction of the scene's mean. (chosen)
constexpr double kDarkest = 0.05;

}  // namespace

Roughness::Roughness(const Mesh& mesh, const NodeLobes& light, const std::vector<double>& area,
                     const std::vector<bool>& sharp)
    : mesh_(mesh), light_(light), area_(area) {
  for (uint32_t p = 0; p < mesh.patches.size(); ++p) {
    // Nodes of a curved patch have frames of their own, in which coefficients do not compare; flux does.
    const auto& patch = mesh.patches[p];
    by_flux_.push_back(light.patch_degrees(p).diffuse() || !patch.planar ||
                       (!sharp.empty() && sharp[patch.material]));
  }
  double sum = 0, whole = 0;
  const double one = 1;
  for (uint32_t n = 0; n < mesh.node_count(); ++n) {
    if (area[n] == 0) continue;
    const double norm = Norm(&n, &one, 1);
    sum += area[n] * norm;
    whole += area[n];
  }
  mean_ = whole > 0 ? sum / whole : 0;
}

Roughness::Roughness(const Mesh& mesh, const NodeLobes& light, const std::vector<double>& area,
                     const std::vector<bool>& sharp, const std::vector<float>& near)
    : Roughness(mesh, light, area, sharp) {
  near_ = &near;
}

double Roughness::Relative(double difference, const uint32_t ends[2]) const {
  const double one = 1;
  const double here = 0.5 * (Norm(&ends[0], &one, 1) + Norm(&ends[1], &one, 1));
  if (near_) {
    const double near = std::min(1.0, double((*near_)[ends[0]]) + (*near_)[ends[1]]);
    const double scale = std::max(here, kDarkest * mean_);
    return scale > 0 ? near * difference / scale : 0;
  }
  const double scale = 0.5 * (here + mean_);
  return scale > 0 ? difference / scale : 0;
}

double Roughness::Norm(const uint32_t* nodes, const double* weights, int count) const {
  const PartDegrees& d = light_.degrees(nodes[0]);
  double sum = 0;
  if (by_flux_[mesh_.node_patch[nodes[0]]]) {
    Eigen::Array3d flux = Eigen::Array3d::Zero();
    for (int i = 0; i < count; ++i) flux += weights[i] * light_.Flux(nodes[i]).cast<double>();
    return std::sqrt((flux / std::numbers::pi).square().mean());
  }
  const int base = d.base_count(), gloss = d.gloss_count();
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < std::max(base, gloss); ++k) {
      double value = 0;
      for (int i = 0; i < count; ++i) {
        if (k < base) value += weights[i] * light_.base(nodes[i])[c * base + k];
        if (k < gloss) value += weights[i] * light_.gloss(nodes[i])[c * gloss + k];
      }
      sum += value * value;
    }
  }
  // Orthonormal over the hemisphere of 2 pi; three channels.
  return std::sqrt(sum / (3 * 2 * std::numbers::pi));
}

std::vector<float> Roughness::BetweenEnds(double error) const {
  std::vector<float> out(mesh_.element_count(), 0.0f);
  const double difference[2] = {1, -1};
  for (uint32_t e = 0; e < mesh_.element_count(); ++e) {
    double worst = 0;
    for (int k = 0; k < 3; ++k) {
      const uint32_t ends[2] = {mesh_.elements[e][k], mesh_.elements[e][(k + 1) % 3]};
      if (area_[ends[0]] == 0 || area_[ends[1]] == 0) continue;
      worst = std::max(worst, Relative(Norm(ends, difference, 2), ends));
    }
    if (worst > error) out[e] = float(worst);
  }
  return out;
}

std::vector<float> Roughness::AtMidpoints(const Refinement& refined, double error) const {
  std::vector<float> node_error(mesh_.node_count(), 0.0f);
  const double bend[3] = {1, -0.5, -0.5};
  for (const uint32_t n : refined.made) {
    const uint32_t nodes[3] = {n, refined.parents[n][0], refined.parents[n][1]};
    if (nodes[1] == nodes[2] || area_[nodes[0]] == 0 || area_[nodes[1]] == 0 || area_[nodes[2]] == 0)
      continue;
    node_error[n] = float(Relative(Norm(nodes, bend, 3), nodes + 1));
  }
  std::vector<float> out(mesh_.element_count(), 0.0f);
  for (uint32_t e = 0; e < mesh_.element_count(); ++e) {
    for (const uint32_t n : mesh_.elements[e]) out[e] = std::max(out[e], node_error[n]);
    if (!(out[e] > error)) out[e] = 0;
  }
  return out;
}

NodeLobes CarryOver(const NodeLobes& lobes, const Refinement& refined) {
  std::vector<PartDegrees> degrees;
  for (uint32_t p = 0; p < lobes.patch_count(); ++p) degrees.push_back(lobes.patch_degrees(p));
  NodeLobes out(refined.mesh, degrees);
  for (uint32_t n = 0; n < refined.node_of_old.size(); ++n) {
    const auto from = lobes.all(n);
    std::copy(from.begin(), from.end(), out.all(refined.node_of_old[n]).begin());
  }
  return out;
}

}  // namespace lobe
