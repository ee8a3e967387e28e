#pragma once

#include <random>

#include "sh/vector.h"

namespace lobe::test {

/// Directions spread evenly over the sphere, and numbers; the same for the same seed.
class RandomDirections {
 public:
  explicit RandomDirections(uint32_t seed) : bits_(seed) {}

  Vec3 Direction() { return Vec3(normal_(bits_), normal_(bits_), normal_(bits_)).normalized(); }
  /// Within 90 degrees of `n`.
  Vec3 Above(const Vec3& n) {
    const Vec3 w = Direction();
    return w.dot(n) > 0 ? w : Vec3(-w);
  }
  float Between(float a, float b) { return std::uniform_real_distribution<float>(a, b)(bits_); }

 private:
  std::mt19937 bits_;
  std::normal_distribution<float> normal_;
};

}  // namespace lobe::test
