#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace lobe {

/// Draws index i with chance weight[i] / sum of weights, in constant time: Walker's alias method as built by
/// Vose, "A Linear Algorithm for Generating Random Numbers with a Given Distribution", IEEE TSE 17(9), 1991.
class AliasTable {
 public:
  AliasTable() = default;
  /// Weights are finite, not negative, and one at least is positive.
  explicit AliasTable(const std::vector<double>& weights) : entries_(weights.size()) {
    const double mean = std::accumulate(weights.begin(), weights.end(), 0.0) / double(weights.size());
    std::vector<double> share(weights.size());
    std::vector<uint32_t> poor, rich;
    for (uint32_t i = 0; i < weights.size(); ++i) {
      share[i] = weights[i] / mean;
      (share[i] < 1 ? poor : rich).push_back(i);
      entries_[i] = {1, i};
    }
    while (!poor.empty() && !rich.empty()) {
      const uint32_t i = poor.back(), donor = rich.back();
      poor.pop_back();
      entries_[i] = {share[i], donor};
      share[donor] -= 1 - share[i];
      if (share[donor] < 1) {
        rich.pop_back();
        poor.push_back(donor);
      }
    }
  }

  /// `bits`: uniform, all 64.
  uint32_t Draw(uint64_t bits) const {
    // 53 bits serve both the place and the choice there, however many entries share them.
    const double u = double(bits >> 11) * 0x1p-53 * double(entries_.size());
    const uint32_t i = uint32_t(u);
    const Entry& e = entries_[i];
    return u - double(i) < e.own ? i : e.alias;
  }
  bool empty() const { return entries_.empty(); }

 private:
  struct Entry {
    double own;  ///< chance to stay
    uint32_t alias;
  };
  std::vector<Entry> entries_;
};

}  // namespace lobe
