#include "scene/line_chains.h"

#include <algorithm>
#include <set>
#include <utility>

#include "scene/weld.h"

namespace lobe {

namespace {

double DistanceToSegment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = b - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

class Chains {
 public:
  Chains(const std::vector<ContactLine>& lines, double snap, double tolerance) : tolerance_(tolerance) {
    Eigen::AlignedBox3f bounds;
    for (const ContactLine& line : lines) bounds.extend(line.a.cast<float>()).extend(line.b.cast<float>());
    Welder welder(bounds, snap, 1.0);
    const auto number = [&](const Vec3d& p) {
      const uint32_t v = welder.Add(p.cast<float>(), Vec3::UnitZ());
      if (v == point_.size()) {
        point_.push_back(p);
        neighbours_.emplace_back();
      }
      return v;
    };
    std::set<std::pair<uint32_t, uint32_t>> known;
    for (const ContactLine& line : lines) {
      const uint32_t a = number(line.a), b = number(line.b);
      if (a == b || !known.insert(std::minmax(a, b)).second) continue;
      neighbours_[a].push_back(b);
      neighbours_[b].push_back(a);
    }
  }

  std::vector<ContactLine> Run() {
    for (uint32_t v = 0; v < point_.size(); ++v) {
      if (neighbours_[v].size() == 2) continue;
      for (const uint32_t next : std::vector<uint32_t>(neighbours_[v])) Follow(v, next);
    }
    for (uint32_t v = 0; v < point_.size(); ++v) {  // closed loops are left
      if (!neighbours_[v].empty()) Follow(v, neighbours_[v][0]);
    }
    return std::move(out_);
  }

 private:
  // From an end, a branching, or anywhere on a loop, as far as there is one way only.
  void Follow(uint32_t start, uint32_t next) {
    if (std::find(neighbours_[start].begin(), neighbours_[start].end(), next) == neighbours_[start].end()) {
      return;  // came along it from the other end
    }
    chain_ = {start};
    uint32_t at = start;
    while (true) {
      const bool through = neighbours_[next].size() == 2 && next != start;
      const uint32_t after = through ? neighbours_[next][neighbours_[next][0] == at] : start;
      Remove(at, next);
      chain_.push_back(next);
      if (!through) break;
      at = next;
      next = after;
    }
    if (chain_.front() != chain_.back()) return Simplify(0, chain_.size() - 1);
    // The two farthest points of a loop stay, or it would shrink to nothing.
    const auto farther = [&](uint32_t a, uint32_t b) {
      return (point_[a] - point_[start]).squaredNorm() < (point_[b] - point_[start]).squaredNorm();
    };
    const size_t middle =
        static_cast<size_t>(std::max_element(chain_.begin(), chain_.end(), farther) - chain_.begin());
    Simplify(0, middle);
    Simplify(middle, chain_.size() - 1);
  }

  void Remove(uint32_t a, uint32_t b) {
    // The order of the rest stays: `Follow` counts on it.
    neighbours_[a].erase(std::find(neighbours_[a].begin(), neighbours_[a].end(), b));
    neighbours_[b].erase(std::find(neighbours_[b].begin(), neighbours_[b].end(), a));
  }

  void Simplify(size_t first, size_t last) {
    std::vector<std::pair<size_t, size_t>> stack = {{first, last}};
    while (!stack.empty()) {
      const auto [begin, end] = stack.back();
      stack.pop_back();
      const Vec3d &a = point_[chain_[begin]], &b = point_[chain_[end]];
      size_t farthest = begin;
      double distance = tolerance_;
      for (size_t i = begin + 1; i < end; ++i) {
        const double d = DistanceToSegment(point_[chain_[i]], a, b);
        if (d > distance) {
          distance = d;
          farthest = i;
        }
      }
      if (farthest == begin) {
        out_.push_back({a, b});
        continue;
      }
      stack.push_back({farthest, end});
      stack.push_back({begin, farthest});
    }
  }

  double tolerance_;
  std::vector<Vec3d> point_;
  std::vector<std::vector<uint32_t>> neighbours_;
  std::vector<uint32_t> chain_;
  std::vector<ContactLine> out_;
};

}  // namespace

std::vector<ContactLine> Straighten(const std::vector<ContactLine>& lines, double snap, double tolerance) {
  return Chains(lines, snap, tolerance).Run();
}

}  // namespace lobe
