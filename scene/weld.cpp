#include "scene/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

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

std::vector<bool> PartAtContacts(const std::vector<uint32_t>& contact, Welder* welder,
                                 std::vector<std::array<uint32_t, 3>>* triangles) {
  if (std::all_of(contact.begin(), contact.end(), [](uint32_t bits) { return bits == 0; })) return {};
  std::vector<std::array<uint32_t, 3>>& corners = *triangles;
  std::vector<bool> on_line(welder->positions().size());
  for (size_t i = 0; i < corners.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (contact[i] >> k & 1) on_line[corners[i][k]] = on_line[corners[i][(k + 1) % 3]] = true;
    }
  }
  // Corner 3 i + k of triangle i; joined over every edge that is not a line.
  std::vector<uint32_t> parent(3 * corners.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find = [&parent](uint32_t c) {
    while (parent[c] != c) c = parent[c] = parent[parent[c]];
    return c;
  };
  const auto join = [&](uint32_t a, uint32_t b) {
    a = find(a);
    b = find(b);
    parent[std::max(a, b)] = std::min(a, b);
  };
  std::map<std::pair<uint32_t, uint32_t>, std::pair<uint32_t, uint32_t>> first;  // corners at an edge's ends
  for (uint32_t i = 0; i < corners.size(); ++i) {
    for (uint32_t k = 0; k < 3; ++k) {
      uint32_t a = k, b = (k + 1) % 3;
      if (contact[i] >> k & 1 || !(on_line[corners[i][a]] || on_line[corners[i][b]])) continue;
      if (corners[i][a] > corners[i][b]) std::swap(a, b);
      const auto [other, is_new] =
          first.try_emplace({corners[i][a], corners[i][b]}, std::pair(3 * i + a, 3 * i + b));
      if (is_new) continue;
      join(3 * i + a, other->second.first);
      join(3 * i + b, other->second.second);
    }
  }
  std::vector<uint32_t> number(parent.size(), kEnd);  // by root
  std::vector<bool> taken(welder->positions().size());
  for (uint32_t c = 0; c < parent.size(); ++c) {
    uint32_t& corner = corners[c / 3][c % 3];
    if (!on_line[corner]) continue;
    uint32_t& own = number[find(c)];
    if (own == kEnd) {
      const Vec3 position = welder->positions()[corner], normal = welder->normals()[corner];
      own = taken[corner] ? welder->AddAlone(position, normal) : corner;
      taken[corner] = true;
    }
    corner = own;
  }

  // A foot of eight corners has 225 degrees outside each, one of sixteen 203: round enough. (chosen)
  constexpr double kWide = 3.7;
  std::vector<double> angle(welder->positions().size());
  on_line.resize(angle.size(), true);  // the new numbers
  for (const std::array<uint32_t, 3>& triangle : corners) {
    for (int k = 0; k < 3; ++k) {
      if (!on_line[triangle[k]]) continue;
      const auto to = [&](int i) {
        return Vec3d(
            (welder->positions()[triangle[i % 3]] - welder->positions()[triangle[k]]).cast<double>());
      };
      const Vec3d a = to(k + 1), b = to(k + 2);
      angle[triangle[k]] += std::atan2(a.cross(b).norm(), a.dot(b));
    }
  }
  std::vector<bool> wide(angle.size());
  for (size_t v = 0; v < angle.size(); ++v) wide[v] = angle[v] > kWide;
  return wide;
}

}  // namespace lobe
