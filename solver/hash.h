#pragma once

#include <cstdint>

namespace lobe {

/// Counter-based random numbers: a value is a function of what it is for (seed, node, step, index), never of
/// the order in which threads ask. Mixing function: Steele et al., "Fast Splittable Pseudorandom Number
/// Generators" (SplitMix64), OOPSLA 2014.
inline uint64_t Mix(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}
inline uint64_t Mix(uint64_t a, uint64_t b) { return Mix(a ^ Mix(b)); }

/// A stream of uniform numbers in [0, 1) that starts at a key.
class RandomStream {
 public:
  explicit RandomStream(uint64_t key) : state_(key) {}
  uint64_t NextBits() { return Mix(state_++); }
  float Next() { return float(NextBits() >> 40) * 0x1p-24f; }

 private:
  uint64_t state_;
};

}  // namespace lobe
