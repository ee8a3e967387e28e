#include "scene/weld.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lobe {

namespace {

constexpr uint32_t kEnd = 0xffffffffu;

uint64_t Key(const std::array<int64_t, 3>& cell) {
  // 21 bits each, as cells are counted from the corner of the bounds; wrapping only costs time.
  constexpr uint64_t kMask = (1u << 21) - 1;
  return (cell[0] & kMask) | (cell[1] & kMask) << 21 | (cell[2] & kMask) << 42;
}

}  // namespace

Welder::Welder(const Eigen::AlignedBox3f& bounds, double distance, double angle)
    : origin_(bounds.min().cast<double>()),
      distance_(distance),
      // Much larger than the reach, so that most corners look into one cell, and small enough that few
      // other corners live there.
      cell_(std::max(16 * distance, 1e-30)),
      cos_angle_(std::cos(angle)) {}

uint32_t Welder::Add(const Vec3& position, const Vec3& normal) {
  const Vec3d p = position.cast<double>() - origin_;
  std::array<int64_t, 3> low, high;
  for (int i = 0; i < 3; ++i) {
    low[i] = static_cast<int64_t>(std::floor((p[i] - distance_) / cell_));
    high[i] = static_cast<int64_t>(std::floor((p[i] + distance_) / cell_));
  }
  uint32_t best = kEnd;  // the first to come over all cells in reach
  for (int64_t x = low[0]; x <= high[0]; ++x) {
    for (int64_t y = low[1]; y <= high[1]; ++y) {
      for (int64_t z = low[2]; z <= high[2]; ++z) {
        const auto found = first_in_cell_.find(Key({x, y, z}));
        for (uint32_t i = found == first_in_cell_.end() ? kEnd : found->second; i != kEnd; i = next_[i]) {
          if (i < best && (positions_[i] - position).cast<double>().cwiseAbs().maxCoeff() <= distance_ &&
              // Equal normals may have a product a rounding error below 1.
              (normals_[i] == normal ||
               normals_[i].cast<double>().dot(normal.cast<double>()) >= cos_angle_)) {
            best = i;
          }
        }
      }
    }
  }
  if (best != kEnd) return best;

  const uint32_t number = AddAlone(position, normal);
  std::array<int64_t, 3> home;
  for (int i = 0; i < 3; ++i) home[i] = static_cast<int64_t>(std::floor(p[i] / cell_));
  const auto [slot, is_new] = first_in_cell_.try_emplace(Key(home), number);
  if (!is_new) {
    next_[number] = slot->second;
    slot->second = number;
  }
  return number;
}

uint32_t Welder::AddAlone(const Vec3& position, const Vec3& normal) {
  positions_.push_back(position);
  normals_.push_back(normal);
  next_.push_back(kEnd);
  return static_cast<uint32_t>(positions_.size() - 1);
}

}  // namespace lobe
