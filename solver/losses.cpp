#include "solver/losses.h"

#include <numbers>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace lobe {

Losses FindLosses(const Mesh& mesh, const Links& links, const NodeLobes& total, const NodeLobes& unshot,
                  const std::vector<double>& node_area) {
  struct Scratch {
    std::vector<float> basis = std::vector<float>(kMaxBasisSize);
    DirectionsByPattern directions;
  };
  tbb::enumerable_thread_specific<Scratch> scratches;
  std::vector<Losses> of_node(mesh.node_count());
  tbb::parallel_for(uint32_t(0), uint32_t(mesh.node_count()), [&](uint32_t n) {
    if (node_area[n] == 0) return;
    Scratch& scratch = scratches.local();
    Losses& losses = of_node[n];
    losses.sent = (total.Flux(n) - unshot.Flux(n)).cast<double>() * node_area[n];
    const LinkPattern& pattern = links.pattern(mesh.node_patch[n]);
    const auto targets = links.of(n);
    LinkDirections* directions = nullptr;
    const double weight = std::numbers::pi / double(targets.size()) * node_area[n];
    const bool diffuse = total.degrees(n).diffuse();
    for (size_t i = 0; i < targets.size(); ++i) {
      if (Links::IsNode(targets[i])) continue;
      Rgb escaped = Rgb::Zero(), blocked = Rgb::Zero(), in_glass = Rgb::Zero(), below = Rgb::Zero();
      if (Links::IsChain(targets[i])) {
        for (const Links::Hop* hop = links.chain(targets[i]);; ++hop) {
          const Rgb throughput = hop->Throughput();
          if (hop->node == Links::kEscaped) escaped += throughput;
          if (hop->node == Links::kAbsorbed) in_glass += throughput;
          if (hop->end && (hop->node == Links::kBlocked || hop->cut)) blocked += throughput;
          if (hop->last) break;
        }
        if ((escaped + blocked + in_glass <= 0).all()) continue;
      } else {
        (targets[i] == Links::kEscaped ? escaped
         : targets[i] == Links::kBelow ? below
                                       : blocked) = Rgb::Constant(1);
      }
      Vec3 wo = Vec3::UnitZ();
      if (!diffuse) {
        if (!directions) {
          directions = &scratch.directions.Of(pattern);
          directions->Start(n, links.seed());
        }
        wo = directions->Local(int(i) / pattern.sectors, int(i) % pattern.sectors);
      }
      const Eigen::Array3d power =
          (total.Radiance(n, wo, scratch.basis.data()) - unshot.Radiance(n, wo, scratch.basis.data()))
              .cast<double>() *
          weight;
      losses.escaped += power * escaped.cast<double>();
      losses.blocked += power * blocked.cast<double>();
      losses.in_glass += power * in_glass.cast<double>();
      losses.below_facets += power * below.cast<double>();
    }
  });
  Losses out;
  for (const Losses& l : of_node) {
    out.sent += l.sent;
    out.escaped += l.escaped;
    out.blocked += l.blocked;
    out.in_glass += l.in_glass;
    out.below_facets += l.below_facets;
  }
  return out;
}

}  // namespace lobe
