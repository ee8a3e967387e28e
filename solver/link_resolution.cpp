#include "solver/link_resolution.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>

#include "sh/hemisphere_basis.h"

namespace lobe {
namespace {

// Links are a sample already: every so many-th tells as much as all. Odd, so that all sectors come up.
constexpr size_t kEvery = 7;

// Loops of all but the brightest metals decay with so many; more would blur them for nothing
// (docs/validation.md#link-resolution).
constexpr double kMostReadsPerCoefficient = 40;

constexpr double kMostAlbedo = 0.999;

// Of links that end in a patch: area of the receiver over its number of links.
struct Weights {
  double sum = 0, squares = 0;
};

// (l + 1) (l + 2) / 2 <= coefficients, and at least 0.
double HighestDegree(double coefficients) {
  return std::max(0.0, std::floor((std::sqrt(8 * coefficients + 1) - 3) / 2));
}

// Per patch that sends lobes, from the links of all receivers. One receiving patch after another, in order of
// its nodes: the same bits for any number of threads.
std::vector<Weights> FindWeights(const Mesh& mesh, const Links& links, const std::vector<bool>& directional,
                                 const std::vector<double>& node_area) {
  std::vector<std::vector<std::pair<uint32_t, Weights>>> by_receiver(mesh.patches.size());
  tbb::parallel_for(size_t(0), mesh.patches.size(), [&](size_t receiver) {
    std::vector<std::pair<uint32_t, Weights>>& ends = by_receiver[receiver];
    const auto add = [&](uint32_t node, double weight) {
      const uint32_t sender = mesh.node_patch[node];
      if (!directional[sender]) return;
      const auto at = std::lower_bound(ends.begin(), ends.end(), sender,
                                       [](const auto& end, uint32_t patch) { return end.first < patch; });
      Weights& w = (at != ends.end() && at->first == sender ? at : ends.insert(at, {sender, {}}))->second;
      w.sum += weight;
      w.squares += weight * weight;
    };
    for (uint32_t n = mesh.patches[receiver].node_begin; n < mesh.patches[receiver].node_end; ++n) {
      const auto targets = links.of(n);
      const double weight = node_area[n] / double(targets.size());
      if (!(weight > 0)) continue;
      for (size_t i = n % kEvery; i < targets.size(); i += kEvery) {
        if (Links::IsNode(targets[i])) {
          add(targets[i], weight);
        } else if (Links::IsChain(targets[i])) {
          for (const Links::Hop* hop = links.chain(targets[i]);; ++hop) {
            if (Links::IsNode(hop->node)) add(hop->node, weight * double(hop->Throughput().mean()));
            if (hop->last) break;
          }
        }
      }
    }
  });
  std::vector<Weights> weights(mesh.patches.size());
  for (const auto& ends : by_receiver) {
    for (const auto& [sender, w] : ends) {
      weights[sender].sum += w.sum;
      weights[sender].squares += w.squares;
    }
  }
  return weights;
}

}  // namespace

LinkResolution::LinkResolution(const Mesh& mesh, const Links& links,
                               const std::vector<MaterialLobes>& materials,
                               const std::vector<double>& node_area) {
  std::vector<bool> directional;
  for (const auto& p : mesh.patches) directional.push_back(!materials[p.material].diffuse());
  if (std::none_of(directional.begin(), directional.end(), [](bool d) { return d; })) return;

  const std::vector<Weights> weights = FindWeights(mesh, links, directional, node_area);
  constexpr int kHighest = HemisphereBasis<float>::kMaxDegree;
  resolved_.assign(mesh.node_count(), uint8_t{kHighest});
  for (uint32_t p = 0; p < mesh.patches.size(); ++p) {
    if (!(weights[p].sum > 0)) continue;  // nobody reads it
    const double a =
        std::min(kMostAlbedo, double(materials[mesh.patches[p].material].HemisphericalAlbedo().maxCoeff()));
    if (!(a > 0)) continue;
    const double reads_per_coefficient = std::min(kMostReadsPerCoefficient, std::pow(2 * a / (1 - a), 2));
    const double mean_weight = weights[p].squares / weights[p].sum;
    for (uint32_t n = mesh.patches[p].node_begin; n < mesh.patches[p].node_end; ++n) {
      const double reads = node_area[n] / mean_weight;
      resolved_[n] = uint8_t(std::min<double>(kHighest, HighestDegree(reads / reads_per_coefficient)));
    }
  }
}

std::vector<uint8_t> LinkResolution::Degrees(int step, int cap) const {
  std::vector<uint8_t> degrees;
  if (resolved_.empty() || (step <= 1 && cap >= HemisphereBasis<float>::kMaxDegree)) return degrees;
  degrees.assign(resolved_.size(), uint8_t(cap));
  if (step > 1) {
    for (size_t n = 0; n < degrees.size(); ++n) degrees[n] = std::min(degrees[n], resolved_[n]);
  }
  return degrees;
}

}  // namespace lobe
