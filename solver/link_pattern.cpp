#include "solver/link_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/hemisphere_basis.h"
#include "solver/hash.h"

namespace lobe {

LinkPattern LinkPattern::For(int links, int l_max, int per_coefficient) {
  const double count = std::max<double>(links, l_max > 0 ? per_coefficient * CoefficientCount(l_max) : 0);
  LinkPattern pattern;
  const int sectors = std::max(int(std::lround(std::sqrt(3 * count) / kThinnest)),
                               (2 * std::max(l_max, 0) + kThinnest) / kThinnest);
  pattern.sectors = kThinnest * std::max(sectors, 1);
  pattern.rings = std::max(1, int(std::lround(count / pattern.sectors)));
  return pattern;
}

LinkDirections::LinkDirections(const LinkPattern& pattern) : pattern_(pattern) {
  for (int j = 0; j < pattern.sectors; ++j) {
    const double phi = 2 * std::numbers::pi * j / pattern.sectors;
    cos_.push_back(float(std::cos(phi)));
    sin_.push_back(float(std::sin(phi)));
  }
  for (auto* v : {&cos_theta_, &sin_theta_, &phi_, &cos_phi_, &sin_phi_}) v->resize(pattern.rings);
}

void LinkDirections::Start(uint32_t node, uint64_t seed) {
  const uint64_t key = Mix(Mix(seed, 0x11c5), node);
  const float step = 2 * std::numbers::pi_v<float> / float(pattern_.sectors);
  for (int r = 0; r < pattern_.rings; ++r) {
    RandomStream random(key + 2 * uint64_t(r));
    const float u = (float(r) + random.Next()) / float(pattern_.rings);  // sin^2 theta
    sin_theta_[r] = std::sqrt(u);
    cos_theta_[r] = std::sqrt(1 - u);
    phi_[r] = step * random.Next();
    cos_phi_[r] = std::cos(phi_[r]);
    sin_phi_[r] = std::sin(phi_[r]);
  }
}

void LinkDirections::World(const Frame& frame, float* x, float* y, float* z) const {
  for (int r = 0; r < pattern_.rings; ++r) {
    // A ring is centre + cosine of the sector times one radius + sine times the other.
    const Vec3 centre = cos_theta_[r] * frame.z;
    const Vec3 a = sin_theta_[r] * (cos_phi_[r] * frame.x + sin_phi_[r] * frame.y);
    const Vec3 b = sin_theta_[r] * (cos_phi_[r] * frame.y - sin_phi_[r] * frame.x);
    float* out[3] = {x, y, z};
    for (int axis = 0; axis < 3; ++axis) {
      float* to = out[axis] + size_t(r) * pattern_.sectors;
      for (int j = 0; j < pattern_.sectors; ++j) to[j] = centre[axis] + a[axis] * cos_[j] + b[axis] * sin_[j];
    }
  }
}

}  // namespace lobe
