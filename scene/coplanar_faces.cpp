#include "scene/coplanar_faces.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/flat_triangle.h"
#include "scene/mesh.h"

namespace lobe {

namespace {

/// A few steps of a coordinate.
constexpr double kRoundings = 4.0 / (1 << 23);

double Tolerance(const Eigen::AlignedBox3f& a, const Eigen::AlignedBox3f& b) {
  const auto farthest = [](const Eigen::AlignedBox3f& box) {
    return double(std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()));
  };
  const double size_a = a.sizes().maxCoeff(), size_b = b.sizes().maxCoeff();
  const double own = kRoundings * farthest(size_a < size_b ? a : b);
  return std::min(kRoundings * std::max(farthest(a), farthest(b)),
                  std::max(own, 1e-3 * std::min(size_a, size_b)));
}

Eigen::AlignedBox3f BoxOf(const std::array<Vec3, 3>& p) {
  Eigen::AlignedBox3f box(p[0]);
  box.extend(p[1]).extend(p[2]);
  return box;
}

/// Does an edge of `a` keep `b` out?
bool Separates(const FlatTriangle& a, const FlatTriangle& b, double tolerance) {
  for (int k = 0; k < 3; ++k) {
    const double most =
        std::max({a.Inside(k, b.corner[0]), a.Inside(k, b.corner[1]), a.Inside(k, b.corner[2])});
    if (most <= tolerance) return true;
  }
  return false;
}

/// Do they share an area wider than roundings, and are they nowhere farther apart there?
bool Overlap(const FlatTriangle& a, const FlatTriangle& b, double tolerance) {
  const double width = 4 * tolerance;  // neighbours whose edges were rounded apart overlap by less
  if (Separates(a, b, width) || Separates(b, a, width)) return false;
  // The wider one's plane is known better.
  const FlatTriangle &wide = a.lowest > b.lowest ? a : b, &other = a.lowest > b.lowest ? b : a;
  const auto [polygon, count] = wide.PartOver(other.corner, 0);
  Vec3d cross = Vec3d::Zero();
  double longest = 0;
  for (int i = 0; i < count; ++i) {
    if (std::abs(wide.Height(polygon[i])) > tolerance) return false;
    for (int j = 0; j < i; ++j) longest = std::max(longest, (polygon[i] - polygon[j]).norm());
    if (i > 1) cross += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return cross.norm() > 2 * width * longest;
}

bool SameCorners(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  for (const Vec3& p : a) {
    if (p != b[0] && p != b[1] && p != b[2]) return false;
  }
  return true;
}

/// Do they only share an edge, and lie on either side of it? Most pairs in one plane do.
bool AreNeighbours(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  int shared = 0, own_a = -1, own_b = 3;  // corners that the other has not
  for (int i = 0; i < 3; ++i) {
    const int j = a[i] == b[0] ? 0 : a[i] == b[1] ? 1 : a[i] == b[2] ? 2 : -1;
    if (j < 0) {
      own_a = i;
    } else {
      ++shared;
      own_b -= j;
    }
  }
  if (shared != 2) return false;
  const Vec3 &from = a[(own_a + 1) % 3], along = a[(own_a + 2) % 3] - from;
  return along.cross(a[own_a] - from).dot(along.cross(b[own_b] - from)) < 0;
}

/// Faces sorted by normal and offset, each wherever its roundings may take it.
class Slabs {
 public:
  explicit Slabs(const Scene& scene) {
    const Eigen::AlignedBox3f bounds = scene.Bounds();
    origin_ = bounds.min();
    per_metre_ = kBins / std::max(bounds.diagonal().norm(), 1e-30f);
    entries_.reserve(scene.faces.size() + scene.faces.size() / 2);
    for (uint32_t f = 0; f < scene.faces.size(); ++f) Add(f, scene.Corners(scene.faces[f]));
    std::sort(entries_.begin(), entries_.end());
  }

  /// Calls `visit(faces)` for each slab that holds several.
  template <typename Visit>
  void ForEach(const Visit& visit) const {
    std::vector<uint32_t> faces;
    for (size_t begin = 0, end = 0; begin < entries_.size(); begin = end) {
      while (end < entries_.size() && entries_[end] >> kFaceBits == entries_[begin] >> kFaceBits) ++end;
      if (end - begin < 2) continue;
      faces.clear();
      for (size_t i = begin; i < end; ++i) faces.push_back(uint32_t(entries_[i] & kFaceMask));
      visit(faces);
    }
  }

 private:
  // Normals by the side of a cube they point to and 65 x 65 cells on it, so that the axes are in the middle
  // of one; offsets in bins of about a four-thousandth of the scene. (chosen: few unlike faces meet, and few
  // faces are in several slabs)
  static constexpr int kCells = 32, kBins = 4096;
  static constexpr int kFaceBits = 32;
  static constexpr uint64_t kFaceMask = (uint64_t{1} << kFaceBits) - 1;

  void Add(uint32_t face, const std::array<Vec3, 3>& p) {
    const Vec3 a = p[1] - p[0], b = p[2] - p[0];
    const Vec3 normal = a.cross(b);
    const float longest = std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()});
    float farthest = 0;
    for (const Vec3& q : p) farthest = std::max(farthest, q.cwiseAbs().maxCoeff());
    // By how much roundings turn the normal: as they move the corner over the longest edge.
    const float height = normal.norm() / std::sqrt(longest);
    const float turn = 1e-5f + 2 * float(kRoundings) * farthest / height;
    if (!(turn < 0.1f)) return;
    const float largest = normal.cwiseAbs().maxCoeff();
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(normal[axis]) < largest * (1 - 2 * turn)) continue;
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const float s = kCells * normal[u] / normal[axis], t = kCells * normal[v] / normal[axis];
      const float reach = 2 * turn * kCells;
      for (int i = Cell(s - reach); i <= Cell(s + reach); ++i) {
        for (int j = Cell(t - reach); j <= Cell(t + reach); ++j) {
          const auto offset = [&](const Vec3& at) {
            const Vec3 q = at - origin_;
            return q[axis] + (float(i) * q[u] + float(j) * q[v]) / kCells;
          };
          const auto [low, high] = std::minmax({offset(p[0]), offset(p[1]), offset(p[2])});
          // A float's roundings of an offset are far below a hundredth of a bin.
          const int last = Bin(high * per_metre_ + 0.01f);
          for (int bin = Bin(low * per_metre_ - 0.01f); bin <= last; ++bin) {
            const uint64_t cell = (uint64_t(axis) * 128 + uint64_t(i + 64)) * 128 + uint64_t(j + 64);
            entries_.push_back((cell << 16 | uint64_t(bin + 4 * kBins)) << kFaceBits | face);
          }
        }
      }
    }
  }
  static int Cell(float x) { return int(std::floor(x + 0.5f)); }
  static int Bin(float x) { return int(std::floor(x)); }

  Vec3 origin_;
  float per_metre_;
  std::vector<uint64_t> entries_;  // the slab, and below it the face
};

/// Sweeps the faces of one slab along an axis.
class Sweep {
 public:
  Sweep(const Scene& scene, CoplanarFaces* found) : scene_(scene), found_(*found) {
    const Eigen::AlignedBox3f bounds = scene.Bounds();
    slack_ =
        float(kRoundings) * std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
  }

  void Run(const std::vector<uint32_t>& faces) {
    items_.clear();
    Eigen::AlignedBox3f bounds;
    for (const uint32_t f : faces) {
      items_.push_back({BoxOf(scene_.Corners(scene_.faces[f])), f});
      bounds.extend(items_.back().box);
    }
    int axis = 0;
    bounds.sizes().maxCoeff(&axis);
    std::sort(items_.begin(), items_.end(), [axis](const Item& a, const Item& b) {
      const float at_a = a.box.min()[axis], at_b = b.box.min()[axis];
      return at_a != at_b ? at_a < at_b : a.face < b.face;
    });
    active_.clear();
    for (const Item& item : items_) {
      const float at = item.box.min()[axis];
      std::erase_if(active_, [&](const Item& other) { return other.box.max()[axis] < at; });
      near_.clear();
      for (const Item& other : active_) {
        // Boxes in one plane may miss each other by roundings, across it.
        const Vec3 gap = (item.box.min() - other.box.max()).cwiseMax(other.box.min() - item.box.max());
        if (gap.maxCoeff() <= slack_) near_.push_back(other);
      }
      if (!Repeats(item)) active_.push_back(item);
    }
  }

 private:
  struct Item {
    Eigen::AlignedBox3f box;
    uint32_t face;
  };

  /// Compares a face with those near it. True: it is the same as one of them.
  bool Repeats(const Item& item) {
    if (near_.empty()) return false;
    const auto corners = scene_.Corners(scene_.faces[item.face]);
    for (const Item& other : near_) {
      if (other.box.min() != item.box.min() || other.box.max() != item.box.max()) continue;
      if (!SameCorners(corners, scene_.Corners(scene_.faces[other.face]))) continue;
      if (found_.first.empty()) {
        found_.first.resize(scene_.faces.size());
        std::iota(found_.first.begin(), found_.first.end(), 0u);
      }
      const auto [before, after] = std::minmax(item.face, other.face);
      found_.first[after] = std::min(found_.first[after], before);
      return true;
    }
    for (const Item& other : near_) {
      const auto other_corners = scene_.Corners(scene_.faces[other.face]);
      if (AreNeighbours(corners, other_corners)) continue;
      if (Overlap(FlatTriangle(corners), FlatTriangle(other_corners), Tolerance(item.box, other.box))) {
        found_.overlaps.push_back({item.face, other.face});
      }
    }
    return false;
  }

  const Scene& scene_;
  CoplanarFaces& found_;
  float slack_;
  std::vector<Item> items_, active_, near_;
};

}  // namespace

CoplanarFaces FindCoplanarFaces(const Scene& scene) {
  CoplanarFaces found;
  Sweep sweep(scene, &found);
  Slabs(scene).ForEach([&](const std::vector<uint32_t>& faces) { sweep.Run(faces); });
  // Slabs may have found different parts of what repeats.
  for (uint32_t& first : found.first) first = found.first[first];
  for (auto& [a, b] : found.overlaps) {
    if (!found.first.empty()) a = found.first[a], b = found.first[b];
    if (a > b) std::swap(a, b);
  }
  std::sort(found.overlaps.begin(), found.overlaps.end());
  found.overlaps.erase(std::unique(found.overlaps.begin(), found.overlaps.end()), found.overlaps.end());
  return found;
}

double CoplanarTolerance(const Scene& scene, const Face& a, const Face& b) {
  return Tolerance(BoxOf(scene.Corners(a)), BoxOf(scene.Corners(b)));
}

}  // namespace lobe
