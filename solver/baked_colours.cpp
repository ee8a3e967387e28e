#include "solver/baked_colours.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace lobe {
namespace {

// Chosen: leaves lamps and highlights to burn out, and the rest well exposed.
constexpr double kPercentile = 0.95;
constexpr float kPercentileColour = 0.8f;

Rgb EmissionOf(const Solution& solution, const Mesh::Patch& patch) {
  const Material& material = solution.scene.materials[patch.material];
  return patch.side == Side::kFront || material.double_sided ? material.emission : Rgb::Zero();
}

std::vector<Rgb> NodeRadiance(const Solution& solution) {
  const Mesh& mesh = solution.mesh;
  std::vector<Rgb> radiance(mesh.node_count());
  for (uint32_t node = 0; node < mesh.node_count(); ++node) {
    // Ringing may take a dim lobe's flux a little below zero.
    radiance[node] = EmissionOf(solution, mesh.patches[mesh.node_patch[node]]) +
                     solution.total.Flux(node).max(0.0f) / std::numbers::pi_v<float>;
  }
  return radiance;
}

void FillHidden(const Mesh& mesh, const std::vector<uint8_t>& hidden, std::vector<Rgb>* radiance) {
  std::vector<Rgb> sum(mesh.node_count(), Rgb::Zero());
  std::vector<int> count(mesh.node_count(), 0);
  for (const auto& element : mesh.elements) {
    for (const uint32_t to : element) {
      for (const uint32_t from : element) {
        if (!hidden[to] || hidden[from]) continue;
        sum[to] += (*radiance)[from];
        ++count[to];
      }
    }
  }
  for (size_t node = 0; node < sum.size(); ++node) {
    if (count[node] > 0) (*radiance)[node] = sum[node] / float(count[node]);
  }
}

float ExposureScale(const std::vector<Rgb>& radiance, const std::vector<double>& area) {
  std::vector<uint32_t> order(radiance.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return radiance[a].maxCoeff() < radiance[b].maxCoeff(); });
  const double wanted = kPercentile * std::accumulate(area.begin(), area.end(), 0.0);
  double so_far = 0, value = 0;
  for (const uint32_t node : order) {
    so_far += area[node];
    value = radiance[node].maxCoeff();
    if (so_far >= wanted && value > 0) break;  // mostly dark: the first that is not
  }
  return value > 0 && std::isfinite(value) ? float(kPercentileColour / value) : 1.0f;
}

}  // namespace

BakedColours BakeColours(const Solution& solution) {
  std::vector<Rgb> radiance = NodeRadiance(solution);
  FillHidden(solution.mesh, solution.hidden, &radiance);
  BakedColours out;
  out.exposure_scale = ExposureScale(radiance, NodeAreas(solution.mesh, solution.hidden));
  out.rgb.reserve(3 * radiance.size());
  for (const Rgb& value : radiance) {
    for (int c = 0; c < 3; ++c) out.rgb.push_back(std::clamp(value[c] * out.exposure_scale, 0.0f, 1.0f));
  }
  return out;
}

}  // namespace lobe
