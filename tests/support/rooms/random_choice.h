#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "solver/hash.h"

namespace lobe::test {

/// Choices that follow from a seed alone, on every machine.
class RandomChoice {
 public:
  explicit RandomChoice(uint64_t seed) : numbers_(Mix(seed, 0x700d)) {}

  float Between(float a, float b) { return a + (b - a) * numbers_.Next(); }
  /// Spread evenly over orders of magnitude.
  float LogBetween(float a, float b) { return a * std::pow(b / a, numbers_.Next()); }
  /// a..b, both included.
  int Whole(int a, int b) { return a + static_cast<int>(numbers_.Next() * static_cast<float>(b - a + 1)); }
  bool Chance(float p) { return numbers_.Next() < p; }
  template <typename T, size_t n>
  const T& Of(const T (&choices)[n]) {
    return choices[Whole(0, static_cast<int>(n) - 1)];
  }

 private:
  RandomStream numbers_;
};

}  // namespace lobe::test
