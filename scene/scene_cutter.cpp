#include "scene/scene_cutter.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "scene/line_chains.h"
#include "scene/mesh.h"

namespace lobe {

namespace {

/// Faces that meet in an edge at less than 60 degrees between their shading normals may be one smooth surface
/// to the tessellation, whatever its crease angle; beyond, no node is shared anyhow. (chosen)
constexpr float kSmooth = 0.5f;

/// Cuts leave angles below this only where others force them, radians. (chosen: bisection, which comes after,
/// keeps half of it, and Delaunay refinement is sure to end up to 0.36)
constexpr double kLeastAngle = 0.3;

}  // namespace

SceneCutter::SceneCutter(Scene scene, const ContactReach& reach, size_t max_lines)
    : scene_(std::move(scene)), reach_(reach), max_lines_(max_lines), edges_(scene_) {
  for (uint32_t f = 0; f < scene_.faces.size(); ++f) {
    if (!edges_.usable(f)) continue;
    std::vector<uint32_t> sheet;
    for (const EdgeTable::Use& use : edges_.uses(edges_.edge(f, 0))) {
      if (edges_.SharedPlaces(scene_.faces[f], scene_.faces[use.face]) == 3) sheet.push_back(use.face);
    }
    if (sheet[0] == f) sheets_.push_back(std::move(sheet));
  }
}

bool SceneCutter::Cut(std::vector<std::vector<ContactLine>> lines) {
  lines_ = std::move(lines);
  for (size_t i = 0; i < sheets_.size(); ++i) Prepare(i);
  CutSheets();
  return !cut_.empty();
}

/// Is the face, over its edge k, smoothly joined to another of its surface?
bool SceneCutter::IsSmooth(uint32_t f, int k) const {
  const Face& face = scene_.faces[f];
  for (const EdgeTable::Use& use : edges_.uses(edges_.edge(f, k))) {
    const Face& other = scene_.faces[use.face];
    if (use.face == f || other.surface != face.surface || other.material != face.material) continue;
    bool smooth = true;
    for (int end = 0; end < 2; ++end) {
      const int i = (k + end) % 3;
      int j = use.k;
      if (Place(use.face, j) != Place(f, i)) j = (j + 1) % 3;
      smooth &= scene_.normals[face.vertex[i]].dot(scene_.normals[other.vertex[j]]) > kSmooth;
    }
    if (smooth) return true;
  }
  return false;
}

double SceneCutter::AlongEdge(uint32_t edge, const Vec3d& p) const {
  const Vec3d a = At(edges_.ends(edge)[0]), along = At(edges_.ends(edge)[1]) - a;
  return std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
}

/// Sorts a sheet's lines into those along its edges and those through its inside, and tells its edges.
void SceneCutter::Prepare(size_t i) {
  if (lines_[i].empty()) return;
  const uint32_t f = sheets_[i][0];
  const std::array<Vec3d, 3> c = {At(Place(f, 0)), At(Place(f, 1)), At(Place(f, 2))};
  const Vec3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
  std::array<Vec3d, 3> inward;
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    inward[k] = normal.cross(c[(k + 1) % 3] - c[k]).normalized();
    longest = std::max(longest, (c[(k + 1) % 3] - c[k]).norm());
  }
  std::vector<ContactLine> inside;
  for (ContactLine line : lines_[i]) {
    bool dropped = false;
    for (int k = 0; k < 3 && !dropped; ++k) {
      const double at_a = inward[k].dot(line.a - c[k]), at_b = inward[k].dot(line.b - c[k]);
      if (std::max(at_a, at_b) <= reach_.snap) {
        // Edges of neighbours that only leave from the same vertex are near for a short way, too.
        const double length = (line.a - line.b).norm();
        const bool parallel = std::abs(at_a - at_b) <= std::max(0.5 * reach_.rounding, 0.002 * length);
        if (parallel && IsSmooth(f, k)) MarkEdge(edges_.edge(f, k), line);
        dropped = true;
      } else if (at_a < 0 || at_b < 0) {
        // Exactly at the border, so that the neighbour's line goes on from there.
        const Vec3d crossing = line.a + (line.b - line.a) * (at_a / (at_a - at_b));
        (at_a < 0 ? line.a : line.b) = crossing;
      }
    }
    if (!dropped && (line.a - line.b).norm() > reach_.snap) inside.push_back(line);
  }
  double tolerance = reach_.snap / 4;
  inside = Straighten(inside, reach_.snap / 2, tolerance);
  while (inside.size() > max_lines_ && tolerance < 0.005 * longest) {
    inside = Straighten(inside, reach_.snap / 2, tolerance *= 2);
  }
  if (inside.size() > max_lines_) {
    ++crowded_;
    std::stable_sort(inside.begin(), inside.end(), [](const ContactLine& a, const ContactLine& b) {
      return (a.a - a.b).squaredNorm() > (b.a - b.b).squaredNorm();
    });
    inside.resize(max_lines_);
  }
  for (const ContactLine& line : inside) {
    for (const Vec3d& p : {line.a, line.b}) {
      for (int k = 0; k < 3; ++k) {
        if (inward[k].dot(p - c[k]) <= reach_.snap) {
          edge_cuts_[edges_.edge(f, k)].wanted.push_back(AlongEdge(edges_.edge(f, k), p));
        }
      }
    }
  }
  lines_[i] = std::move(inside);
  line_count_ += lines_[i].size();
}

void SceneCutter::MarkEdge(uint32_t edge, const ContactLine& line) {
  const auto [begin, end] = std::minmax({AlongEdge(edge, line.a), AlongEdge(edge, line.b)});
  const double length = (At(edges_.ends(edge)[0]) - At(edges_.ends(edge)[1])).norm();
  if ((end - begin) * length <= 4 * reach_.snap) return;
  EdgeCut& cut = edge_cuts_[edge];
  cut.marked.push_back({begin, end});
  cut.wanted.insert(cut.wanted.end(), {begin, end});
}

/// Chooses an edge's vertices, clear of each other and of its ends.
void SceneCutter::Settle(uint32_t edge, EdgeCut* cut) const {
  const Vec3d a = At(edges_.ends(edge)[0]), along = At(edges_.ends(edge)[1]) - a;
  const double clear = reach_.snap / along.norm();
  std::sort(cut->wanted.begin(), cut->wanted.end());
  std::vector<double> places = {0};
  for (const double t : cut->wanted) {
    if (t - places.back() > clear && t < 1 - clear) places.push_back(t);
  }
  places.push_back(1);
  cut->points.clear();
  cut->on_line.clear();
  for (size_t i = 1; i < places.size(); ++i) {
    const double middle = 0.5 * (places[i - 1] + places[i]);
    cut->on_line.push_back(std::any_of(cut->marked.begin(), cut->marked.end(), [&](const auto& part) {
      return part.first <= middle && middle <= part.second;
    }));
    if (i + 1 < places.size()) cut->points.push_back((a + places[i] * along).cast<float>());
  }
}

/// Cuts, and again where a cut asked for a vertex on the border, until neighbours agree.
void SceneCutter::CutSheets() {
  // Every round but the first is for a few faces; the last takes what there is.
  constexpr int kRounds = 6;
  std::vector<size_t> sheet_of(scene_.faces.size(), kNone);
  for (size_t i = 0; i < sheets_.size(); ++i) sheet_of[sheets_[i][0]] = i;
  std::vector<uint32_t> changed;
  for (const auto& [edge, cut] : edge_cuts_) changed.push_back(edge);
  std::vector<size_t> todo;
  for (size_t i = 0; i < sheets_.size(); ++i) {
    if (!lines_[i].empty()) todo.push_back(i);
  }
  for (int round = 0; round < kRounds; ++round) {
    for (const uint32_t edge : changed) {
      Settle(edge, &edge_cuts_[edge]);
      for (const EdgeTable::Use& use : edges_.uses(edge)) {
        if (sheet_of[use.face] != kNone) todo.push_back(sheet_of[use.face]);
      }
    }
    std::sort(todo.begin(), todo.end());
    todo.erase(std::unique(todo.begin(), todo.end()), todo.end());
    for (const size_t i : todo) cut_.try_emplace(i);
    tbb::parallel_for(size_t{0}, todo.size(), [&](size_t i) { cut_.at(todo[i]).emplace(CutSheet(todo[i])); });
    changed.clear();
    for (const size_t i : todo) {
      const uint32_t f = sheets_[i][0];
      for (const TriangleCutter::Request& request : cut_.at(i)->requests()) {
        const uint32_t edge = edges_.edge(f, request.edge);
        const double t = Place(f, request.edge) == edges_.ends(edge)[0] ? request.t : 1 - request.t;
        edge_cuts_[edge].wanted.push_back(t);
        changed.push_back(edge);
      }
    }
    todo.clear();
    if (changed.empty()) break;
  }
}

TriangleCutter SceneCutter::CutSheet(size_t i) const {
  const uint32_t f = sheets_[i][0];
  TriangleCutter cutter(scene_.Corners(scene_.faces[f]), reach_.snap);
  for (int k = 0; k < 3; ++k) {
    const uint32_t edge = edges_.edge(f, k);
    const bool was_line = scene_.faces[f].contact >> k & 1;  // of a scene that has been cut before
    const auto found = edge_cuts_.find(edge);
    if (found == edge_cuts_.end()) {
      cutter.CutBorder(k, {}, {was_line});
      continue;
    }
    std::vector<Vec3> points = found->second.points;
    std::vector<uint8_t> on_line = found->second.on_line;
    if (Place(f, k) != edges_.ends(edge)[0]) {
      std::reverse(points.begin(), points.end());
      std::reverse(on_line.begin(), on_line.end());
    }
    if (was_line || !IsSmooth(f, k)) on_line.assign(on_line.size(), was_line);
    cutter.CutBorder(k, points, on_line);
  }
  // Longest first: they meet the fewest others.
  std::vector<ContactLine> lines = lines_[i];
  std::stable_sort(lines.begin(), lines.end(), [](const ContactLine& a, const ContactLine& b) {
    return (a.a - a.b).squaredNorm() > (b.a - b.b).squaredNorm();
  });
  for (const ContactLine& line : lines) cutter.CutAlong(line.a, line.b);
  if (cutter.vertices().size() > 3) cutter.Fatten(kLeastAngle);
  return cutter;
}

/// Puts the pieces of every cut face in its place.
void SceneCutter::Rebuild() {
  std::map<uint32_t, size_t> sheet_of;
  for (const auto& [i, cutter] : cut_) {
    for (const uint32_t f : sheets_[i]) sheet_of[f] = i;
  }
  std::vector<Face> faces;
  faces.reserve(scene_.faces.size() + 4 * sheet_of.size());
  auto next = sheet_of.begin();
  for (uint32_t f = 0; f < scene_.faces.size(); ++f) {
    if (next == sheet_of.end() || next->first != f) {
      faces.push_back(scene_.faces[f]);
      origins_.push_back(f);
      continue;
    }
    AppendPieces(f, sheets_[next->second][0], *cut_.at(next->second), &faces);
    origins_.resize(faces.size(), f);
    ++next;
  }
  scene_.faces = std::move(faces);
}

void SceneCutter::AppendPieces(uint32_t f, uint32_t first, const TriangleCutter& cutter,
                               std::vector<Face>* faces) {
  const Face face = scene_.faces[f];
  // Corner of this face where the first of its sheet has corner k.
  std::array<int, 3> corner{};
  for (int k = 0; k < 3; ++k) {
    while (Place(f, corner[k]) != Place(first, k)) ++corner[k];
  }
  const bool turned = (corner[0] + 1) % 3 != corner[1];
  std::vector<uint32_t> vertex;
  for (uint32_t v = 0; v < cutter.vertices().size(); ++v) {
    if (v < 3) {
      vertex.push_back(face.vertex[corner[v]]);
    } else {
      const Vec3d w = cutter.Weights(v);
      Vec3d normal = Vec3d::Zero();
      int on = 0, opposite = 0;
      for (int k = 0; k < 3; ++k) {
        normal += w[k] * scene_.normals[face.vertex[corner[k]]].cast<double>();
        if (v < cutter.border_end(k) && v >= cutter.border_begin(k)) on = 1, opposite = (k + 2) % 3;
      }
      if (!(normal.norm() > 1e-6)) normal = scene_.GeometricNormal(face).cast<double>();
      const Vec3& p = cutter.vertices()[v];
      const auto add = [&] {
        scene_.positions.push_back(p);
        scene_.normals.push_back(normal.normalized().cast<float>());
        return static_cast<uint32_t>(scene_.positions.size() - 1);
      };
      if (!on) {
        vertex.push_back(add());
        continue;
      }
      // Faces that shared the edge's vertices share the new one.
      const auto ends =
          std::minmax(face.vertex[corner[(opposite + 1) % 3]], face.vertex[corner[(opposite + 2) % 3]]);
      const auto key = std::tuple(ends.first, ends.second, p.x(), p.y(), p.z());
      auto found = shared_.find(key);
      if (found == shared_.end()) found = shared_.emplace(key, add()).first;
      vertex.push_back(found->second);
    }
  }
  for (const TriangleCutter::Piece& piece : cutter.Pieces()) {
    Face part = face;
    part.contact = piece.lines;
    for (int k = 0; k < 3; ++k) part.vertex[k] = vertex[piece.vertex[k]];
    if (turned) {
      std::swap(part.vertex[1], part.vertex[2]);
      part.contact = (piece.lines & 2) | (piece.lines & 1) << 2 | piece.lines >> 2;
    }
    faces->push_back(part);
  }
}

}  // namespace lobe
