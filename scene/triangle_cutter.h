#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "sh/vector.h"

namespace lobe {

/// Cuts one triangle along lines: a constrained Delaunay triangulation, which keeps pieces fat and adds no
/// points but the lines' ends and crossings. (Binary space partition would lead every line on to the border,
/// and over it into the neighbours.)
///
/// Lines are recovered by swapping diagonals (Sloan, Computers & Structures 47(3), 1993), and diagonals are
/// swapped while that opens the smallest angle, which is Delaunay's choice (Sibson, Computer J. 21, 1978).
/// It only ever grows, so rounding cannot make it run in circles. Extra points are those of Ungor
/// (Computational Geometry 42(2), 2009): Ruppert's circumcentres, drawn in to where the thin triangle is just
/// fat enough.
class TriangleCutter {
 public:
  struct Piece {
    std::array<uint32_t, 3> vertex;  ///< wound as the triangle
    uint32_t lines;                  ///< bit k: corner k to k + 1 lies on a line
  };
  /// A place on the triangle's border where a line wants a vertex and there is none.
  struct Request {
    int edge;
    double t;  ///< 0..1 from corner `edge` to the next
  };

  /// Points nearer to each other, or to an edge, than `snap` become one. Corners are vertices 0, 1, 2.
  TriangleCutter(const std::array<Vec3, 3>& corners, double snap);

  /// Vertices on edge k, in order from corner k to k + 1, clear of each other; `on_line`: one more than
  /// points, whether the parts between them lie on a line. Before any line; each edge once.
  void CutBorder(int k, const std::vector<Vec3>& points, const std::vector<uint8_t>& on_line);
  /// Ends are on the triangle, to within snap. False: it could not be cut along all of the line, for want
  /// of a vertex on the border (see requests()).
  bool CutAlong(const Vec3d& a, const Vec3d& b);

  /// Adds vertices inside while that opens angles below `least_angle` (radians, at most 0.35): short lines
  /// far from the border would leave long thin triangles. After all lines; lines and border stay as they are.
  void Fatten(double least_angle);

  const std::vector<Request>& requests() const { return requests_; }
  /// Points rounded to single precision, which is what all cuts were computed with.
  const std::vector<Vec3>& vertices() const { return vertices_; }
  /// Vertices from border_begin(k) up to border_end(k) are those of CutBorder(k, ...).
  uint32_t border_begin(int k) const { return border_[k].first; }
  uint32_t border_end(int k) const { return border_[k].second; }
  /// Of a vertex, by the triangle's corners.
  Vec3d Weights(uint32_t vertex) const;
  std::vector<Piece> Pieces() const;

 private:
  using Point = Eigen::Vector2d;
  static constexpr int kOutside = -1;
  struct Triangle {
    std::array<int, 3> v, next;  // next[k]: across the edge from v[k] to v[k + 1]
    std::array<bool, 3> line;
    int Find(int vertex) const { return v[0] == vertex ? 0 : v[1] == vertex ? 1 : v[2] == vertex ? 2 : -1; }
  };
  struct Edge {
    int triangle = kOutside, k = 0;
  };

  Point Flat(const Vec3d& p) const;
  int AddVertex(const Vec3& p);
  int AddPoint(const Vec3d& p);  // number, or kOutside after a request
  void SplitTriangle(int t, int vertex);
  void SplitEdge(Edge e, int vertex);
  void Replace(int t, const Triangle& triangle);
  void Legalize(std::vector<std::pair<int, int>> edges);
  bool Swap(Edge e, bool only_better);
  Edge FindEdge(int a, int b) const;
  template <typename Visit>
  void Around(int vertex, const Visit& visit) const;
  void Mark(Edge e);
  bool Connect(int a, int b);
  int VertexOn(int a, int b) const;
  bool CrossedEdges(int a, int b, std::vector<std::pair<int, int>>* edges) const;
  double Side(int a, int b, int c) const;  // twice the area, positive if counter-clockwise
  double Fatness(int a, int b, int c) const;
  bool AddInside(int t, double least_angle);

  double snap_;
  Vec3d origin_, x_, y_;
  std::vector<Vec3> vertices_;
  std::vector<Point> point_;
  std::vector<int> some_triangle_;  // by vertex
  std::vector<Triangle> triangles_;
  std::vector<Request> requests_;
  std::array<std::pair<uint32_t, uint32_t>, 3> border_ = {};
};

}  // namespace lobe
