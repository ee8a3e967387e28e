#include "scene/triangle_cutter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace lobe {

namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

TriangleCutter::TriangleCutter(const std::array<Vec3, 3>& corners, double snap)
    : snap_(snap), origin_(corners[0].cast<double>()) {
  const Vec3d a = corners[1].cast<double>() - origin_, b = corners[2].cast<double>() - origin_;
  x_ = a.normalized();
  y_ = a.cross(b).normalized().cross(x_);
  for (const Vec3& p : corners) AddVertex(p);
  triangles_.push_back({{0, 1, 2}, {kOutside, kOutside, kOutside}, {false, false, false}});
  some_triangle_ = {0, 0, 0};
}

TriangleCutter::Point TriangleCutter::Flat(const Vec3d& p) const {
  return {x_.dot(p - origin_), y_.dot(p - origin_)};
}

int TriangleCutter::AddVertex(const Vec3& p) {
  vertices_.push_back(p);
  point_.push_back(Flat(p.cast<double>()));
  some_triangle_.push_back(0);
  return static_cast<int>(vertices_.size() - 1);
}

double TriangleCutter::Side(int a, int b, int c) const {
  return Cross(point_[b] - point_[a], point_[c] - point_[a]);
}

/// Sine of the smallest angle; negative for a triangle turned over.
double TriangleCutter::Fatness(int a, int b, int c) const {
  const double ab = (point_[b] - point_[a]).norm(), bc = (point_[c] - point_[b]).norm();
  const double ca = (point_[a] - point_[c]).norm();
  return Side(a, b, c) / (ab * bc * ca) * std::min({ab, bc, ca});
}

template <typename Visit>
void TriangleCutter::Around(int vertex, const Visit& visit) const {
  // Counter-clockwise until it comes back or meets the border, then clockwise from the start.
  const int start = some_triangle_[vertex];
  int t = start;
  do {
    const int k = triangles_[t].Find(vertex);
    if (visit(t, k)) return;
    t = triangles_[t].next[(k + 2) % 3];
  } while (t != kOutside && t != start);
  if (t == start) return;
  t = triangles_[start].next[triangles_[start].Find(vertex)];
  while (t != kOutside) {
    const int k = triangles_[t].Find(vertex);
    if (visit(t, k)) return;
    t = triangles_[t].next[k];
  }
}

TriangleCutter::Edge TriangleCutter::FindEdge(int a, int b) const {
  Edge found;
  Around(a, [&](int t, int k) {
    if (triangles_[t].v[(k + 1) % 3] == b) {
      found = {t, k};
    } else if (triangles_[t].v[(k + 2) % 3] == b) {
      found = {t, (k + 2) % 3};
    }
    return found.triangle != kOutside;
  });
  return found;
}

/// Puts a triangle where there was another, and tells its neighbours.
void TriangleCutter::Replace(int t, const Triangle& triangle) {
  triangles_[t] = triangle;
  for (int k = 0; k < 3; ++k) {
    some_triangle_[triangle.v[k]] = t;
    if (triangle.next[k] == kOutside) continue;
    Triangle& other = triangles_[triangle.next[k]];
    for (int j = 0; j < 3; ++j) {
      if (other.v[j] == triangle.v[(k + 1) % 3] && other.v[(j + 1) % 3] == triangle.v[k]) other.next[j] = t;
    }
  }
}

void TriangleCutter::SplitTriangle(int t, int vertex) {
  const Triangle old = triangles_[t];
  const int second = static_cast<int>(triangles_.size()), third = second + 1;
  triangles_.resize(triangles_.size() + 2);
  const std::array<int, 3> part = {t, second, third};
  // All three exist before any is told of another.
  for (int k = 0; k < 3; ++k) {
    triangles_[part[k]] = {{old.v[k], old.v[(k + 1) % 3], vertex},
                           {old.next[k], part[(k + 1) % 3], part[(k + 2) % 3]},
                           {old.line[k], false, false}};
  }
  for (const int p : part) Replace(p, Triangle(triangles_[p]));
  Legalize({{old.v[0], old.v[1]}, {old.v[1], old.v[2]}, {old.v[2], old.v[0]}});
}

void TriangleCutter::SplitEdge(Edge e, int vertex) {
  // (a, b, c) becomes (a, m, c) and (m, b, c); across, (b, a, d) becomes (m, a, d) and (b, m, d).
  const int t = e.triangle, u = triangles_[t].next[e.k];
  const Triangle left = triangles_[t];
  const int a = left.v[e.k], b = left.v[(e.k + 1) % 3], c = left.v[(e.k + 2) % 3];
  const bool line = left.line[e.k];
  const int t2 = static_cast<int>(triangles_.size()), u2 = u == kOutside ? kOutside : t2 + 1;
  triangles_.resize(triangles_.size() + (u == kOutside ? 1 : 2));
  std::vector<std::pair<int, Triangle>> parts = {
      {t, {{a, vertex, c}, {u, t2, left.next[(e.k + 2) % 3]}, {line, false, left.line[(e.k + 2) % 3]}}},
      {t2, {{vertex, b, c}, {u2, left.next[(e.k + 1) % 3], t}, {line, left.line[(e.k + 1) % 3], false}}}};
  std::vector<std::pair<int, int>> doubtful = {{b, c}, {c, a}};
  if (u != kOutside) {
    const Triangle right = triangles_[u];
    const int k = right.Find(b);
    const int d = right.v[(k + 2) % 3];
    parts.push_back(
        {u, {{vertex, a, d}, {t, right.next[(k + 1) % 3], u2}, {line, right.line[(k + 1) % 3], false}}});
    parts.push_back(
        {u2, {{b, vertex, d}, {t2, u, right.next[(k + 2) % 3]}, {line, false, right.line[(k + 2) % 3]}}});
    doubtful.push_back({a, d});
    doubtful.push_back({d, b});
  }
  for (const auto& [number, triangle] : parts) triangles_[number] = triangle;
  for (const auto& [number, triangle] : parts) Replace(number, triangle);
  Legalize(std::move(doubtful));
}

/// Turns the diagonal of the two triangles at an edge, if they form a strictly convex quadrangle.
bool TriangleCutter::Swap(Edge e, bool only_better) {
  const int t = e.triangle, u = triangles_[t].next[e.k];
  if (u == kOutside || triangles_[t].line[e.k]) return false;
  const Triangle left = triangles_[t], right = triangles_[u];
  const int i = e.k, j = right.Find(left.v[(i + 1) % 3]);
  const int a = left.v[i], b = left.v[(i + 1) % 3], c = left.v[(i + 2) % 3], d = right.v[(j + 2) % 3];
  const double after = std::min(Fatness(a, d, c), Fatness(d, b, c));
  if (!(after > 1e-12)) return false;
  if (only_better) {
    const double before = std::min(Fatness(a, b, c), Fatness(b, a, d));
    if (!(after > before + 1e-9 * std::abs(before))) return false;
  }
  const Triangle first = {{a, d, c},
                          {right.next[(j + 1) % 3], u, left.next[(i + 2) % 3]},
                          {right.line[(j + 1) % 3], false, left.line[(i + 2) % 3]}};
  const Triangle second = {{d, b, c},
                           {right.next[(j + 2) % 3], left.next[(i + 1) % 3], t},
                           {right.line[(j + 2) % 3], left.line[(i + 1) % 3], false}};
  triangles_[t] = first;
  triangles_[u] = second;
  Replace(t, first);
  Replace(u, second);
  return true;
}

void TriangleCutter::Legalize(std::vector<std::pair<int, int>> edges) {
  while (!edges.empty()) {
    const auto [a, b] = edges.back();
    edges.pop_back();
    const Edge e = FindEdge(a, b);
    if (e.triangle == kOutside || !Swap(e, /*only_better=*/true)) continue;
    // The four sides of the quadrangle may want it now.
    const int u = triangles_[e.triangle].next[1];
    const Triangle& left = triangles_[e.triangle];
    const Triangle& right = triangles_[u];
    edges.insert(
        edges.end(),
        {{left.v[0], left.v[1]}, {left.v[2], left.v[0]}, {right.v[0], right.v[1]}, {right.v[1], right.v[2]}});
  }
}

void TriangleCutter::CutBorder(int k, const std::vector<Vec3>& points, const std::vector<uint8_t>& on_line) {
  const int end = (k + 1) % 3;
  int from = k;
  border_[k].first = static_cast<uint32_t>(vertices_.size());
  for (size_t i = 0; i <= points.size(); ++i) {
    const Edge rest = FindEdge(from, end);
    if (on_line[i]) triangles_[rest.triangle].line[rest.k] = true;
    if (i == points.size()) break;
    const int vertex = AddVertex(points[i]);
    const bool line = on_line[i];
    SplitEdge(rest, vertex);
    const Edge remaining = FindEdge(vertex, end);
    if (line) triangles_[remaining.triangle].line[remaining.k] = false;
    from = vertex;
  }
  border_[k].second = static_cast<uint32_t>(vertices_.size());
}

int TriangleCutter::AddPoint(const Vec3d& exact) {
  const Vec3 rounded = exact.cast<float>();
  const Point p = Flat(rounded.cast<double>());
  int nearest = 0;
  for (int v = 1; v < static_cast<int>(point_.size()); ++v) {
    if ((point_[v] - p).squaredNorm() < (point_[nearest] - p).squaredNorm()) nearest = v;
  }
  if ((point_[nearest] - p).norm() <= snap_) return nearest;

  Edge closest;  // of the triangle it lies in
  double most_inside = -std::numeric_limits<double>::infinity();
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    const Triangle& triangle = triangles_[t];
    double inside = std::numeric_limits<double>::infinity();
    int side = 0;
    for (int k = 0; k < 3; ++k) {
      const Point &a = point_[triangle.v[k]], &b = point_[triangle.v[(k + 1) % 3]];
      const double distance = Cross(b - a, p - a) / (b - a).norm();
      if (distance < inside) {
        inside = distance;
        side = k;
      }
    }
    if (inside > most_inside) {
      most_inside = inside;
      closest = {t, side};
    }
  }
  const Triangle& home = triangles_[closest.triangle];
  if (most_inside > snap_) {
    const int vertex = AddVertex(rounded);
    SplitTriangle(closest.triangle, vertex);
    return vertex;
  }
  if (home.next[closest.k] != kOutside) {
    const int vertex = AddVertex(rounded);
    SplitEdge(closest, vertex);
    return vertex;
  }
  // On the border, where neighbours must know of it: which of the three edges is it?
  Request request{0, 0};
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Point a = point_[k], b = point_[(k + 1) % 3];
    const double distance = std::abs(Cross(b - a, p - a)) / (b - a).norm();
    if (distance < best) {
      best = distance;
      request = {k, std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0)};
    }
  }
  // One that became another vertex of the border when those were sorted out is met there.
  if ((point_[nearest] - p).norm() <= 4 * snap_) return nearest;
  requests_.push_back(request);
  return kOutside;
}

bool TriangleCutter::CutAlong(const Vec3d& a, const Vec3d& b) {
  const int from = AddPoint(a), to = AddPoint(b);
  return from != kOutside && to != kOutside && Connect(from, to);
}

/// The vertex nearest to a within snap of the line to b, and between them.
int TriangleCutter::VertexOn(int a, int b) const {
  const Point along = point_[b] - point_[a];
  const double length = along.norm();
  int found = kOutside;
  double first = length;
  for (int v = 0; v < static_cast<int>(point_.size()); ++v) {
    if (v == a || v == b) continue;
    const Point p = point_[v] - point_[a];
    const double t = p.dot(along) / length;
    if (t > 0 && t < first && std::abs(Cross(along, p)) <= snap_ * length) {
      first = t;
      found = v;
    }
  }
  return found;
}

/// Edges strictly crossed on the way from a to b, in order. False: rounding has led astray.
bool TriangleCutter::CrossedEdges(int a, int b, std::vector<std::pair<int, int>>* edges) const {
  edges->clear();
  Edge e;
  Around(a, [&](int t, int k) {
    const int right = triangles_[t].v[(k + 1) % 3], left = triangles_[t].v[(k + 2) % 3];
    // Between the two, and ahead.
    if (Side(a, right, b) > 0 && Side(a, left, b) < 0) e = {t, (k + 1) % 3};
    return e.triangle != kOutside;
  });
  while (e.triangle != kOutside) {
    if (edges->size() > triangles_.size()) return false;
    const Triangle& from = triangles_[e.triangle];
    const int right = from.v[e.k], left = from.v[(e.k + 1) % 3];
    edges->push_back({right, left});
    const int u = from.next[e.k];
    if (u == kOutside) return false;
    const int j = triangles_[u].Find(left), apex = triangles_[u].v[(j + 2) % 3];
    if (apex == b) return true;
    // u is (left, right, apex).
    e = {u, Side(a, b, apex) > 0 ? (j + 1) % 3 : (j + 2) % 3};
  }
  return false;
}

/// On both sides. Border edges are left to CutBorder, as the neighbours must agree.
void TriangleCutter::Mark(Edge e) {
  Triangle& triangle = triangles_[e.triangle];
  if (triangle.next[e.k] == kOutside) return;
  Triangle& other = triangles_[triangle.next[e.k]];
  triangle.line[e.k] = other.line[other.Find(triangle.v[(e.k + 1) % 3])] = true;
}

bool TriangleCutter::Connect(int from, int to) {
  std::vector<std::pair<int, int>> stack = {{from, to}}, crossed, turned;
  // Every step marks an edge, or ends in shorter lines; a count keeps what rounding may do in bounds.
  int steps = 1000 + 100 * static_cast<int>(triangles_.size());
  while (!stack.empty()) {
    if (--steps < 0) return false;
    const auto [a, b] = stack.back();
    stack.pop_back();
    if (a == b) continue;
    if (const Edge e = FindEdge(a, b); e.triangle != kOutside) {
      Mark(e);
      continue;
    }
    if (const int v = VertexOn(a, b); v != kOutside) {
      stack.push_back({v, b});
      stack.push_back({a, v});
      continue;
    }
    if (!CrossedEdges(a, b, &crossed)) return false;
    // Meets an earlier line first? Then both get a vertex there.
    const auto line = std::find_if(crossed.begin(), crossed.end(), [&](const std::pair<int, int>& edge) {
      const Edge e = FindEdge(edge.first, edge.second);
      return triangles_[e.triangle].line[e.k];
    });
    const auto split = [&](const std::pair<int, int>& edge) {
      const double at_first = std::abs(Side(a, b, edge.first)), at_second = std::abs(Side(a, b, edge.second));
      const Vec3d p = vertices_[edge.first].cast<double>(), q = vertices_[edge.second].cast<double>();
      const int vertex = AddVertex((p + (q - p) * (at_first / (at_first + at_second))).cast<float>());
      SplitEdge(FindEdge(edge.first, edge.second), vertex);
      stack.push_back({vertex, b});
      stack.push_back({a, vertex});
    };
    if (line != crossed.end()) {
      split(*line);
      continue;
    }
    turned.clear();
    bool stuck = false;
    size_t refused = 0;
    while (!crossed.empty() && !stuck) {
      const auto edge = crossed.front();
      crossed.erase(crossed.begin());
      const Edge e = FindEdge(edge.first, edge.second);
      const int c = triangles_[e.triangle].v[(e.k + 2) % 3];
      if (!Swap(e, /*only_better=*/false)) {
        crossed.push_back(edge);
        stuck = ++refused > crossed.size();
        continue;
      }
      refused = 0;
      const Triangle& one = triangles_[e.triangle];  // (a, d, c) after the swap
      const int d = one.v[1];
      const bool ends_here = c == a || c == b || d == a || d == b;
      if (!ends_here && (Side(a, b, c) > 0) != (Side(a, b, d) > 0)) {
        crossed.push_back({c, d});
        if (--steps < 0) return false;
      } else {
        turned.push_back({c, d});
      }
    }
    if (stuck) {
      // Not met in practice; a vertex of its own always helps.
      split(crossed.front());
      continue;
    }
    const Edge e = FindEdge(a, b);
    if (e.triangle == kOutside) return false;
    Mark(e);  // before the others are looked at, lest it be turned again
    Legalize(turned);
  }
  return true;
}

void TriangleCutter::Fatten(double least_angle) {
  struct Thin {
    double fatness;
    std::array<int, 3> v;
    bool operator<(const Thin& other) const {  // for a queue that gives the thinnest first
      return fatness != other.fatness ? fatness > other.fatness : v > other.v;
    }
  };
  std::priority_queue<Thin> queue;
  const double least = std::sin(least_angle);
  const auto enqueue = [&](const Triangle& t) {
    const double fatness = Fatness(t.v[0], t.v[1], t.v[2]);
    if (fatness < least) queue.push({fatness, t.v});
  };
  for (const Triangle& t : triangles_) enqueue(t);
  // Each point opens the thinnest triangle and leaves edges no shorter than those about it, so there is an
  // end; where lines meet at small angles the count makes one.
  const size_t most = 64 + 8 * vertices_.size();
  while (!queue.empty() && vertices_.size() < most) {
    const Thin thin = queue.top();
    queue.pop();
    const Edge e = FindEdge(thin.v[0], thin.v[1]);
    if (e.triangle == kOutside) continue;
    int t = e.triangle;
    if (triangles_[t].Find(thin.v[2]) < 0) t = triangles_[t].next[e.k];
    if (t == kOutside || triangles_[t].Find(thin.v[2]) < 0) continue;  // gone
    if (!AddInside(t, least_angle)) continue;
    // Every triangle the new vertex has changed is at it.
    Around(static_cast<int>(vertices_.size() - 1), [&](int changed, int) {
      enqueue(triangles_[changed]);
      return false;
    });
  }
}

/// A vertex that makes triangle t fatter, if it can be seen from there and is clear of lines and border.
bool TriangleCutter::AddInside(int t, double least_angle) {
  const Triangle& thin = triangles_[t];
  int k = 0;  // shortest edge
  const auto length = [&](int i) { return (point_[thin.v[(i + 1) % 3]] - point_[thin.v[i]]).norm(); };
  for (int i = 1; i < 3; ++i) {
    if (length(i) < length(k)) k = i;
  }
  const Point a = point_[thin.v[k]], b = point_[thin.v[(k + 1) % 3]], c = point_[thin.v[(k + 2) % 3]];
  // The circumcentre is on the bisector of a-b at height h, where |p - a| = |p - c|.
  const Point middle = 0.5 * (a + b), along = (b - a) / (b - a).norm(), up(-along.y(), along.x());
  const Point apex = c - middle;
  const double x = apex.dot(along), y = apex.dot(up), half = 0.5 * (b - a).norm();
  if (!(y > 0)) return false;
  const double circumcentre = (x * x + y * y - half * half) / (2 * y);
  const Point p = middle + up * std::min(circumcentre, half / std::tan(0.5 * least_angle));

  // Walks there from the middle of the thin one; lines are walls.
  Point from = Point::Zero();
  for (int i = 0; i < 3; ++i) from += point_[triangles_[t].v[i]] / 3;
  int home = t, came_from = kOutside;
  for (size_t steps = 0;; ++steps) {
    if (steps > triangles_.size()) return false;
    const Triangle& here = triangles_[home];
    int leave = -1;
    for (int i = 0; i < 3 && leave < 0; ++i) {
      const Point &q = point_[here.v[i]], &r = point_[here.v[(i + 1) % 3]];
      if (here.next[i] == came_from && came_from != kOutside) continue;
      const bool beyond = Cross(r - q, p - q) < 0;
      // Through this edge, not one whose straight continuation is passed.
      if (beyond && Cross(p - from, q - from) <= 0 && Cross(p - from, r - from) >= 0) leave = i;
    }
    if (leave < 0) break;
    if (here.line[leave] || here.next[leave] == kOutside) return false;
    came_from = home;
    home = here.next[leave];
  }
  const Triangle& here = triangles_[home];
  for (int i = 0; i < 3; ++i) {
    const Point q = point_[here.v[i]] - p, r = point_[here.v[(i + 1) % 3]] - p;
    if (q.norm() <= 4 * snap_) return false;
    const double distance = Cross(q, r) / (r - q).norm();
    // In sight of a line or the border at more than a right angle, it would squeeze thin triangles there.
    const bool fixed = here.line[i] || here.next[i] == kOutside;
    if (distance <= 4 * snap_ || (fixed && q.dot(r) < 0)) return false;
  }
  const Vec3d exact = origin_ + p.x() * x_ + p.y() * y_;
  SplitTriangle(home, AddVertex(exact.cast<float>()));
  return true;
}

Vec3d TriangleCutter::Weights(uint32_t vertex) const {
  const int v = static_cast<int>(vertex);
  const double whole = Side(0, 1, 2);
  Vec3d weights(Side(1, 2, v) / whole, Side(2, 0, v) / whole, Side(0, 1, v) / whole);
  weights = weights.cwiseMax(0.0);
  return weights / weights.sum();
}

std::vector<TriangleCutter::Piece> TriangleCutter::Pieces() const {
  std::vector<Piece> pieces;
  for (const Triangle& t : triangles_) {
    Piece piece{{}, 0};
    for (int k = 0; k < 3; ++k) {
      piece.vertex[k] = static_cast<uint32_t>(t.v[k]);
      if (t.line[k]) piece.lines |= 1u << k;
    }
    pieces.push_back(piece);
  }
  return pieces;
}

}  // namespace lobe
