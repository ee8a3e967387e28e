#include "bench/peak_arithmetic.h"

#include <algorithm>

#include "bench/timing.h"
#include "sh/lanes.h"
#include "sh/simd.h"

namespace lobe {
namespace {

// All chains stay in registers: six of two registers each with eight numbers a register, twelve of one with
// sixteen. Which is the better is found by trying.
template <int kChains>
LOBE_INLINE float Chains(long steps, float factor, float term) {
  FloatLanes x[kChains];
  for (int i = 0; i < kChains; ++i) x[i] = FloatLanes{} + (1.0f + float(i));
  const FloatLanes a = FloatLanes{} + factor, b = FloatLanes{} + term;
  for (long step = 0; step < steps; ++step) {
#pragma GCC unroll 16
    for (int i = 0; i < kChains; ++i) x[i] = x[i] * a + b;
  }
  float sum = 0;
  for (int i = 0; i < kChains; ++i) {
    for (int lane = 0; lane < kLanes; ++lane) sum += x[i][lane];
  }
  return sum;
}

LOBE_SIMD_CLONES float SixChains(long steps, float factor, float term) {
  return Chains<6>(steps, factor, term);
}
LOBE_SIMD_CLONES float TwelveChains(long steps, float factor, float term) {
  return Chains<12>(steps, factor, term);
}

}  // namespace

double PeakMultiplyAdds() {
  constexpr long kSteps = 100000;
  volatile float factor = 0.999f, term = 0.001f, unused;
  double best = 0;
  for (int run = 0; run < 6; ++run) {
    const double start = CpuSeconds();
    unused = SixChains(kSteps, factor, term);
    const double between = CpuSeconds();
    unused = TwelveChains(kSteps, factor, term);
    const double end = CpuSeconds();
    best =
        std::max({best, 6.0 * kLanes * kSteps / (between - start), 12.0 * kLanes * kSteps / (end - between)});
  }
  static_cast<void>(unused);
  return best;
}

}  // namespace lobe
