#include "scene/contact_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scene/flat_triangle.h"

namespace lobe {

namespace {

/// A face whose slope against another is less runs along it; more leads away from it. (chosen: 7 degrees)
constexpr double kFlat = 0.125;

std::vector<BoxTree::Item> Boxes(const Scene& scene, const EdgeTable& edges) {
  std::vector<BoxTree::Item> items;
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    if (!edges.usable(f)) continue;
    Eigen::AlignedBox3f box;
    for (const Vec3& p : scene.Corners(scene.faces[f])) box.extend(p);
    items.push_back({box, f});
  }
  return items;
}

}  // namespace

ContactReach ReachIn(const Scene& scene, double distance) {
  const Eigen::AlignedBox3f bounds = scene.Bounds();
  const double size = bounds.diagonal().cast<double>().norm();
  const double farthest = std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
  ContactReach reach;
  // Transforms and modelling programs leave a few roundings.
  reach.rounding = 4 * std::ldexp(farthest, -23);
  // Clear of what the tessellation welds (scene/tessellate.cpp), too.
  reach.snap = std::max(4 * reach.rounding, 2e-6 * size);
  reach.distance = std::max(std::min(distance, 1e-3 * size), 2 * reach.rounding);
  return reach;
}

struct ContactFinder::Target : FlatTriangle {
  uint32_t number;
  const Face& face;
  bool both_sides;
  double distance = 0;
};

ContactFinder::ContactFinder(const Scene& scene, const EdgeTable& edges, const ContactReach& reach)
    : scene_(scene), edges_(edges), reach_(reach), tree_(Boxes(scene, edges)) {}

std::vector<ContactLine> ContactFinder::LinesOn(uint32_t number, bool both_sides) const {
  const Face& face = scene_.faces[number];
  std::array<Vec3d, 3> c;
  for (int k = 0; k < 3; ++k) c[k] = edges_.position(edges_.place(face.vertex[k])).cast<double>();
  Target target{FlatTriangle(c), number, face, both_sides};
  // Too thin for a cut inside to be anything but rounding.
  if (target.lowest < 8 * reach_.snap) return {};
  // What a small face is a part of is resolved by the mesh already.
  target.distance = std::min(reach_.distance, std::max(target.longest / 4, reach_.rounding));

  Eigen::AlignedBox3f box;
  for (const Vec3d& p : c) box.extend(p.cast<float>());
  const Vec3 margin = Vec3::Constant(static_cast<float>(target.distance + reach_.snap));
  box.min() -= margin;
  box.max() += margin;

  std::vector<ContactLine> lines;
  std::vector<uint32_t> near;  // edges
  const double below = both_sides ? target.distance : reach_.rounding;
  tree_.Find(box, target.normal.cast<float>(), static_cast<float>(target.normal.dot(c[0])), margin.x(),
             [&](uint32_t other_number) {
               if (other_number == number) return;
               const Face& other = scene_.faces[other_number];
               std::array<double, 3> height;
               for (int k = 0; k < 3; ++k) {
                 height[k] = target.Height(scene_.positions[other.vertex[k]].cast<double>());
               }
               const auto [low, high] = std::minmax({height[0], height[1], height[2]});
               if (low > target.distance || high < -below) return;
               // Beyond the edge they share two faces can only meet by folding back flat onto each other.
               if (edges_.SharedPlaces(face, other) >= 2) return;
               if (low < -reach_.rounding && high > reach_.rounding) AddCrossing(target, other, &lines);
               for (int k = 0; k < 3; ++k) {
                 const double h0 = height[k], h1 = height[(k + 1) % 3];
                 if (std::min(h0, h1) <= target.distance && std::max(h0, h1) >= -below) {
                   near.push_back(edges_.edge(other_number, k));
                 }
               }
             });
  for (int k = 0; k < 3; ++k) {
    const uint32_t own = edges_.edge(number, k);
    if (edges_.uses(own).size() > 2) near.push_back(own);
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  for (const uint32_t edge : near) AddNearEdge(target, edge, &lines);
  return lines;
}

void ContactFinder::AddCrossing(const Target& target, const Face& other,
                                std::vector<ContactLine>* lines) const {
  // What of the other face is over or under the target. Heights are asked for there only: far outside,
  // the target's plane is known badly.
  std::array<Vec3d, 3> corners;
  for (int k = 0; k < 3; ++k) corners[k] = scene_.positions[other.vertex[k]].cast<double>();
  const auto [polygon, count] = target.PartOver(corners, reach_.snap);
  if (count < 2) return;
  std::array<double, 8> height;
  for (int i = 0; i < count; ++i) height[i] = target.Height(polygon[i]);
  const auto [low, high] = std::minmax_element(height.begin(), height.begin() + count);
  if (*low >= -reach_.rounding || *high <= reach_.rounding) return;
  std::array<Vec3d, 2> end;
  int ends = 0;
  for (int i = 0; i < count && ends < 2; ++i) {
    const int j = (i + 1) % count;
    if ((height[i] < 0) == (height[j] < 0)) continue;
    end[ends++] = polygon[i] + (polygon[j] - polygon[i]) * (height[i] / (height[i] - height[j]));
  }
  if (ends == 2 && (end[0] - end[1]).norm() > reach_.snap) lines->push_back({end[0], end[1]});
}

void ContactFinder::AddNearEdge(const Target& target, uint32_t edge, std::vector<ContactLine>* lines) const {
  const auto& ends = edges_.ends(edge);
  const Vec3d a = edges_.position(ends[0]).cast<double>(), b = edges_.position(ends[1]).cast<double>();
  double begin = 0, end = 1;
  if (!target.ClipSegment(a, b, reach_.snap, &begin, &end)) return;
  for (const double sign : {1.0, -1.0}) {
    if (sign < 0 && !target.both_sides) break;
    // Heights are taken over the target, as in AddCrossing.
    double t0 = begin, t1 = end;
    const double at_a = sign * target.Height(a), at_b = sign * target.Height(b);
    if (!ClipToRange(-reach_.rounding, target.distance, at_a, at_b, &t0, &t1)) continue;
    const Vec3d p = a + t0 * (b - a), q = a + t1 * (b - a);
    const double hp = target.Height(p), hq = target.Height(q);
    const Vec3d foot_p = p - hp * target.normal, foot_q = q - hq * target.normal;
    const double length = (foot_p - foot_q).norm();
    if (length <= reach_.snap) continue;
    // An edge that comes down steeply is near at its end only.
    const bool whole = t0 <= begin && t1 >= end;
    if (!whole && std::abs(hp - hq) > kFlat * length) continue;
    const bool touches = std::max(std::abs(hp), std::abs(hq)) <= reach_.rounding;
    if (!IsOutline(target, edge, sign, touches)) continue;
    // Vertices that touch keep their very coordinates.
    lines->push_back(
        {std::abs(hp) <= reach_.rounding ? p : foot_p, std::abs(hq) <= reach_.rounding ? q : foot_q});
    return;
  }
}

/// Does what hangs on the edge begin to cover the target there? Seen from the target's side `sign`, the faces
/// at the edge lead away (rise), run along (flat), or go down through the target or around something solid
/// (sink).
bool ContactFinder::IsOutline(const Target& target, uint32_t edge, double sign, bool touches) const {
  const Vec3d a = edges_.position(edges_.ends(edge)[0]).cast<double>();
  const Vec3d along = (edges_.position(edges_.ends(edge)[1]).cast<double>() - a).normalized();
  const Vec3d left = target.normal.cross(along);
  int rising = 0, sinking = 0, flat_left = 0, flat_right = 0;
  for (const EdgeTable::Use& use : edges_.uses(edge)) {
    const Face& face = scene_.faces[use.face];
    Vec3d away = scene_.positions[face.vertex[(use.k + 2) % 3]].cast<double>() - a;
    away = (away - away.dot(along) * along).normalized();
    const double slope = sign * away.dot(target.normal);
    if (slope > kFlat) {
      ++rising;
    } else if (slope < -kFlat) {
      ++sinking;
    } else {
      ++(away.dot(left) > 0 ? flat_left : flat_right);
    }
  }
  if (sinking > 0) return touches && rising > 0;
  if (rising > 0) return true;
  return (flat_left == 0) != (flat_right == 0);
}

}  // namespace lobe
