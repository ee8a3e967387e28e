#pragma once

#include <array>
#include <cstdint>

#include "solver/hash.h"

namespace lobe {

/// Points of Sobol's two-dimensional (0, 2)-sequence, Owen-scrambled: every aligned run of 2^k of them has
/// one point in every elementary interval of area 2^-k, and each point alone is uniform. Means over them
/// converge faster than over random points. Sequences of different seeds are independent, in their order too,
/// so that several serve as the dimensions of one point. Burley, "Practical Hash-based Owen Scrambling",
/// JCGT 9(4), 2020.
class SobolPoints {
 public:
  explicit SobolPoints(uint64_t seed)
      : order_seed_(uint32_t(Mix(seed))), x_seed_(uint32_t(seed)), y_seed_(uint32_t(seed >> 32)) {}

  /// Point `index`, both in [0, 1).
  std::array<float, 2> At(uint32_t index) const {
    const auto [x, y] = BitsAt(index);
    return {float(x >> 8) * 0x1p-24f, float(y >> 8) * 0x1p-24f};
  }
  /// The same as fixed point numbers, 32 bits after the point.
  std::array<uint32_t, 2> BitsAt(uint32_t index) const {
    // Scrambling works on reversed bits, in which the first dimension, van der Corput's, is the index itself.
    // Scrambling the index first shuffles aligned runs of 2^k.
    index = Reverse(Scramble(Reverse(index), order_seed_));
    return {Reverse(Scramble(index, x_seed_)), Reverse(Scramble(Reverse(SecondDimension(index)), y_seed_))};
  }

 private:
  static uint32_t Reverse(uint32_t v) {
    v = (v >> 16) | (v << 16);
    v = ((v & 0xff00ff00u) >> 8) | ((v & 0x00ff00ffu) << 8);
    v = ((v & 0xf0f0f0f0u) >> 4) | ((v & 0x0f0f0f0fu) << 4);
    v = ((v & 0xccccccccu) >> 2) | ((v & 0x33333333u) << 2);
    return ((v & 0xaaaaaaaau) >> 1) | ((v & 0x55555555u) << 1);
  }
  // Direction numbers of the polynomial x + 1: each is the one before, xor itself shifted by one.
  static uint32_t SecondDimension(uint32_t index) {
    uint32_t out = 0;
    for (uint32_t v = 1u << 31; index != 0; index >>= 1, v ^= v >> 1) {
      if (index & 1) out ^= v;
    }
    return out;
  }
  // Flips every bit by a hash of those below it (of reversed numbers: those before it in value): Laine and
  // Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011, with Burley's constants.
  static uint32_t Scramble(uint32_t v, uint32_t seed) {
    v += seed;
    v ^= v * 0x6c50b47cu;
    v ^= v * 0xb82f1e52u;
    v ^= v * 0xc7afe638u;
    v ^= v * 0x8d22f6e6u;
    return v;
  }

  uint32_t order_seed_, x_seed_, y_seed_;
};

}  // namespace lobe
