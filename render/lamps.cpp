#include "render/lamps.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

namespace lobe {

Lamps::Lamps(std::vector<Face> faces) : faces_(std::move(faces)) {
  if (faces_.empty()) return;
  double total = 0;
  std::vector<double> power;
  for (const Face& f : faces_) {
    power.push_back(f.power);
    total += f.power;
  }
  by_power_ = AliasTable(power);
  for (const Face& f : faces_) per_area_.push_back(float(f.power / total / f.area));

  // The finest of three partitions that is not too fine.
  const auto octant = [](const Vec3& n) { return (n.x() < 0) + 2 * (n.y() < 0) + 4 * (n.z() < 0); };
  std::map<uint64_t, uint32_t> group_of_key;
  for (int partition = 0; partition < 3; ++partition) {
    group_of_key.clear();
    group_of_.clear();
    for (uint32_t i = 0; i < faces_.size(); ++i) {
      const uint64_t surface = faces_[i].surface;
      const uint64_t key = partition == 0   ? i
                           : partition == 1 ? 8 * surface + uint64_t(octant(faces_[i].normal))
                                            : surface;
      group_of_.push_back(group_of_key.emplace(key, uint32_t(group_of_key.size())).first->second);
    }
    if (group_of_key.size() <= kMostGroups) break;
  }
  if (group_of_key.size() > kMostGroups) return;
  groups_.resize(group_of_key.size());
  for (uint32_t i = 0; i < faces_.size(); ++i) groups_[group_of_[i]].lamps.push_back(i);
  for (Group& g : groups_) {
    std::vector<double> share;
    double sum = 0;
    for (const uint32_t i : g.lamps) {
      share.push_back(power[i]);
      sum += power[i];
    }
    g.draw = AliasTable(share);
    g.power = float(sum / total);
    const Face& first = faces_[g.lamps[0]];
    g.axis = Vec3::Zero();
    g.one_sided = true;
    for (const uint32_t i : g.lamps) {
      g.axis += float(power[i] / sum) * faces_[i].normal;
      g.one_sided &= faces_[i].emits[0] && !faces_[i].emits[1];
    }
    g.axis.normalize();
    float least = 1;
    for (const uint32_t i : g.lamps) least = std::min(least, g.axis.dot(faces_[i].normal));
    g.spread = least > 0 ? std::sqrt(std::max(1 - least * least, 0.0f)) : 1;
    if (g.lamps.size() == 1) {
      const auto& p = first.corners;
      g.probes = {Vec3((p[0] + p[1] + p[2]) / 3), p[0], p[1], p[2]};
      g.evaluated = 4;
      g.least_distance2 = first.area;
    } else {
      Eigen::AlignedBox3f box;
      for (const uint32_t i : g.lamps) {
        for (const Vec3& p : faces_[i].corners) box.extend(p);
      }
      g.probes.push_back(box.center());
      for (int k = 0; k < 8; ++k) g.probes.push_back(box.corner(Eigen::AlignedBox3f::CornerType(k)));
      g.evaluated = 1;
      g.least_distance2 = 0.25f * box.diagonal().squaredNorm();
    }
  }
}

Lamps::Choice Lamps::ChooseFrom(const Vec3& position, const Frame& frame, const Vec3& wo_local,
                                const ReflectanceSampler& sampler) const {
  // A part of the chance by power: lobes may be narrower than lamps, and the brightest probe misses them.
  constexpr float kByPower = 0.1f;
  Choice choice;
  if (groups_.size() < 2) return choice;
  float expected[kMostGroups], sum = 0;
  for (size_t i = 0; i < groups_.size(); ++i) {
    const Group& g = groups_[i];
    float most = 0;
    // All corners of its hull below the horizon: it brings nothing for sure.
    bool seen = sampler.transmits();
    for (size_t k = 0; k < g.probes.size() && (k < g.evaluated || !seen); ++k) {
      const Vec3 way = g.probes[k] - position;
      seen |= frame.z.dot(way) > 0;
      const float distance2 = way.squaredNorm();
      if (k >= g.evaluated || !(distance2 > 0)) continue;
      const float distance = std::sqrt(distance2), towards = -g.axis.dot(way) / distance;
      // The cosine at the lamp, of the normal that looks here most.
      const float facing = std::min(g.one_sided ? towards + g.spread : std::abs(towards) + g.spread, 1.0f);
      if (facing <= 0) continue;
      const Vec3 wi = frame.ToLocal(way / distance);
      most = std::max(most, sampler.Evaluate(wo_local, wi).f.mean() * std::abs(wi.z()) * facing /
                                std::max(distance2, g.least_distance2));
    }
    expected[i] = seen ? g.power * most : -1;
    sum += std::max(expected[i], 0.0f);
  }
  float all = 0;
  for (size_t i = 0; i < groups_.size(); ++i) {
    float& chance = choice.over_power[i];
    chance = 0;
    if (expected[i] >= 0) {
      chance = sum > 0 ? kByPower * groups_[i].power + (1 - kByPower) * expected[i] / sum : groups_[i].power;
    }
    all += chance;
  }
  if (!(all > 0)) return choice;  // none brings anything: it does not matter which is drawn
  choice.count = uint32_t(groups_.size());
  float upto = 0;
  for (size_t i = 0; i < groups_.size(); ++i) {
    upto += choice.over_power[i] / all;
    choice.upto[i] = upto;
    choice.over_power[i] /= all * groups_[i].power;
  }
  // Rounding must not leave room after the last group that has a chance.
  for (size_t i = groups_.size(); i-- > 0;) {
    choice.upto[i] = 1;
    if (choice.over_power[i] > 0) break;
  }
  return choice;
}

uint32_t Lamps::Draw(uint64_t bits, const Choice* choice) const {
  if (!choice || choice->count == 0) return by_power_.Draw(bits);
  const double u = double(bits >> 11) * 0x1p-53;
  const auto begin = choice->upto.begin(), end = begin + choice->count;
  const size_t i = std::min<size_t>(std::upper_bound(begin, end, float(u)) - begin, choice->count - 1);
  const Group& g = groups_[i];
  if (g.lamps.size() == 1) return g.lamps[0];
  // What is left of the number is uniform again.
  const double below = i > 0 ? choice->upto[i - 1] : 0.0, width = double(choice->upto[i]) - below;
  const double left = std::clamp((u - below) / width, 0.0, 1 - 0x1p-53);
  return g.lamps[g.draw.Draw(uint64_t(left * 0x1p53) << 11)];
}

}  // namespace lobe
