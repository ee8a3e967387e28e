#include "solver/unsettled.h"

#include <cstdint>

#include <tbb/parallel_for.h>

namespace lobe {

double UnsettledArea(const NodeLobes& total, const NodeLobes& unshot, const std::vector<double>& area,
                     double fraction) {
  enum : uint8_t { kDark, kSettled, kUnsettled };
  std::vector<uint8_t> state(area.size(), kDark);
  tbb::parallel_for(size_t(0), area.size(), [&](size_t n) {
    const double all = total.Flux(uint32_t(n)).cast<double>().abs().sum();
    if (area[n] == 0 || all == 0) return;
    const double left = unshot.Flux(uint32_t(n)).cast<double>().abs().sum();
    state[n] = left > fraction * all ? kUnsettled : kSettled;
  });
  // In node order: sums do not depend on threads.
  double reflects = 0, unsettled = 0;
  for (size_t n = 0; n < area.size(); ++n) {
    if (state[n] != kDark) reflects += area[n];
    if (state[n] == kUnsettled) unsettled += area[n];
  }
  return reflects > 0 ? unsettled / reflects : 0;
}

}  // namespace lobe
