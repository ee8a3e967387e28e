#include "solver/coarse_transport.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>
#include <Eigen/LU>

namespace lobe {
namespace {

constexpr uint32_t kBlockOfNodes = 1024;

// What leaves a cluster beyond this many times what it has gathered is not believed.
constexpr double kMostAhead = 100;

// Mean albedo over cos-weighted incidence, midpoints of equal strata of sin^2 theta.
template <typename Albedo>
Rgb HemisphericalMean(const Albedo& albedo) {
  constexpr int kSteps = 32;
  Rgb sum = Rgb::Zero();
  for (int i = 0; i < kSteps; ++i) sum += albedo(std::sqrt(1 - (float(i) + 0.5f) / kSteps));
  return sum / float(kSteps);
}

}  // namespace

CoarseTransport::CoarseTransport(const Mesh& mesh, const Links& links,
                                 const std::vector<MaterialLobes>& materials,
                                 const std::vector<double>& node_area, const std::vector<uint32_t>& opposite)
    : mesh_(mesh), cluster_(mesh.patches.size()) {
  const size_t patches = mesh.patches.size();
  std::vector<double> patch_area(patches, 0.0);
  for (size_t n = 0; n < mesh.node_count(); ++n) patch_area[mesh.node_patch[n]] += node_area[n];
  std::vector<uint32_t> order(patches);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return patch_area[a] > patch_area[b]; });
  for (size_t i = 0; i < patches; ++i) cluster_[order[i]] = uint32_t(std::min<size_t>(i, kClusters - 1));
  clusters_ = int(std::min<size_t>(patches, kClusters));

  area_.assign(clusters_, 0.0);
  other_side_.assign(clusters_, -1);
  for (int c = 0; c < 3; ++c) albedo_[c] = through_[c] = Eigen::VectorXd::Zero(clusters_);
  for (size_t p = 0; p < patches; ++p) {
    const MaterialLobes& material = materials[mesh.patches[p].material];
    const Rgb albedo = HemisphericalMean([&](float cosine) { return material.Albedo(cosine); });
    area_[cluster_[p]] += patch_area[p];
    for (int c = 0; c < 3; ++c) albedo_[c][cluster_[p]] += double(albedo[c]) * patch_area[p];
  }
  for (int k = 0; k < clusters_; ++k) {
    for (int c = 0; c < 3; ++c) albedo_[c][k] /= std::max(area_[k], 1e-30);
  }
  // A sheet's other side, where both are clusters of their own.
  for (size_t p = 0; p < patches && !opposite.empty(); ++p) {
    const MaterialLobes& material = materials[mesh.patches[p].material];
    if (mesh.patches[p].node_begin == mesh.patches[p].node_end) continue;
    const uint32_t other = opposite[mesh.patches[p].node_begin];
    if (!material.transmits() || other == kNone) continue;
    const int k = int(cluster_[p]), from = int(cluster_[mesh.node_patch[other]]);
    if (k == kClusters - 1 || from == kClusters - 1) continue;
    other_side_[k] = from;
    const Rgb albedo = HemisphericalMean([&](float cosine) { return material.TransmissionAlbedo(cosine); });
    for (int c = 0; c < 3; ++c) through_[c][k] = albedo[c];
  }

  // Blocks of nodes of one patch each, summed in order: the same bits for any number of threads.
  struct Block {
    uint32_t patch, begin, end;
  };
  std::vector<Block> blocks;
  for (uint32_t p = 0; p < patches; ++p) {
    for (uint32_t n = mesh.patches[p].node_begin; n < mesh.patches[p].node_end; n += kBlockOfNodes) {
      blocks.push_back({p, n, std::min(n + kBlockOfNodes, mesh.patches[p].node_end)});
    }
  }
  form_factor_ = Eigen::MatrixXd::Zero(clusters_, clusters_);
  // Rows of 2 KB: a batch at a time, since there may be a block for every small patch.
  constexpr size_t kBatch = 1024;
  std::vector<Eigen::VectorXd> rows(kBatch);
  for (size_t begin = 0; begin < blocks.size(); begin += kBatch) {
    const size_t end = std::min(blocks.size(), begin + kBatch);
    tbb::parallel_for(begin, end, [&](size_t b) {
      Eigen::VectorXd& row = rows[b - begin] = Eigen::VectorXd::Zero(clusters_);
      for (uint32_t n = blocks[b].begin; n < blocks[b].end; ++n) {
        const auto targets = links.of(n);
        const double weight = node_area[n] / double(targets.size());
        for (const uint32_t link : targets) {
          if (Links::IsNode(link)) {
            row[cluster_[mesh.node_patch[link]]] += weight;
          } else if (Links::IsChain(link)) {
            for (const Links::Hop* hop = links.chain(link);; ++hop) {
              if (Links::IsNode(hop->node)) {
                row[cluster_[mesh.node_patch[hop->node]]] += weight * double(hop->Throughput().sum()) / 3;
              }
              if (hop->last) break;
            }
          }
        }
      }
    });
    for (size_t b = begin; b < end; ++b)
      form_factor_.row(cluster_[blocks[b].patch]) += rows[b - begin].transpose();
  }
  for (int k = 0; k < clusters_; ++k) form_factor_.row(k) /= std::max(area_[k], 1e-30);
}

// A cluster is one brightness. Where it reaches around a wall, into a bright and a dim half of a room, or
// holds its light where it leaves at once (the rim of a narrow gap), it seems to send far more to some
// clusters than it does. How much truly came to each is known: all that was gathered but the direct light.
// Rows that would have brought many times as much are scaled to that.
void CoarseTransport::CorrectRows(const Eigen::VectorXd& shot, const Eigen::VectorXd& came,
                                  double most_overrated, Eigen::MatrixXd* system) const {
  const Eigen::VectorXd predicted = shot - *system * shot;
  for (int k = 0; k < clusters_; ++k) {
    if (!(predicted[k] > most_overrated * came[k])) continue;
    system->row(k) *= std::max(0.0, came[k]) / predicted[k];
    system->row(k)[k] += 1 - std::max(0.0, came[k]) / predicted[k];
  }
}

std::vector<std::array<float, 3>> CoarseTransport::Ahead(const NodeLobes& total, const NodeLobes& direct,
                                                         const NodeLobes& unshot,
                                                         const std::vector<double>& node_area,
                                                         double most_overrated) const {
  Eigen::MatrixXd gathered = Eigen::MatrixXd::Zero(clusters_, 3), straight = gathered, waiting = gathered;
  std::vector<std::array<Rgb, 3>> flux(mesh_.node_count());
  tbb::parallel_for(uint32_t(0), uint32_t(mesh_.node_count()), [&](uint32_t n) {
    flux[n] = {total.Flux(n), direct.Flux(n), unshot.Flux(n)};
  });
  for (uint32_t n = 0; n < mesh_.node_count(); ++n) {
    if (node_area[n] == 0) continue;
    const int k = int(cluster_[mesh_.node_patch[n]]);
    gathered.row(k) += (flux[n][0].cast<double>() * node_area[n]).matrix().transpose();
    straight.row(k) += (flux[n][1].cast<double>() * node_area[n]).matrix().transpose();
    waiting.row(k) += (flux[n][2].cast<double>() * node_area[n]).matrix().transpose();
  }
  std::vector<std::array<float, 3>> ahead(mesh_.patches.size(), {0, 0, 0});
  for (int c = 0; c < 3; ++c) {
    // Radiosity x = waiting + albedo F x, in watts per square metre; x is all that will ever be shot.
    const auto per_area = [&](const Eigen::VectorXd& power) {
      Eigen::VectorXd out(clusters_);
      for (int k = 0; k < clusters_; ++k) out[k] = power[k] / std::max(area_[k], 1e-30);
      return out;
    };
    const Eigen::VectorXd radiosity = per_area(waiting.col(c));
    Eigen::MatrixXd system =
        Eigen::MatrixXd::Identity(clusters_, clusters_) - albedo_[c].asDiagonal() * form_factor_;
    for (int k = 0; k < clusters_; ++k) {
      if (other_side_[k] >= 0) system.row(k) -= through_[c][k] * form_factor_.row(other_side_[k]);
    }
    CorrectRows(per_area(gathered.col(c) - waiting.col(c)), per_area(gathered.col(c) - straight.col(c)),
                most_overrated, &system);
    const Eigen::VectorXd x = system.partialPivLu().solve(radiosity);
    if (!x.allFinite()) continue;
    for (size_t p = 0; p < ahead.size(); ++p) {
      const int k = int(cluster_[p]);
      if (!(gathered(k, c) > 0)) continue;
      const double share = (x[k] - radiosity[k]) * area_[k] / gathered(k, c);
      if (std::abs(share) < kMostAhead) ahead[p][c] = float(share);
    }
  }
  return ahead;
}

}  // namespace lobe
