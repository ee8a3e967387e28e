#include "scene/bisection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <stdexcept>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

namespace lobe {

namespace {

using TriMesh = OpenMesh::TriMesh_ArrayKernelT<>;
using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

struct LongEdge {
  double length;
  int edge;
  bool operator<(const LongEdge& other) const {
    return length != other.length ? length < other.length : edge > other.edge;
  }
};

/// A total order of edges by geometry: equal only where ends coincide, and there by number.
struct EdgeRank {
  double squared_length;
  std::array<float, 6> ends;  // the greater position first
  int edge;
  bool operator<(const EdgeRank& other) const {
    if (squared_length != other.squared_length) return squared_length < other.squared_length;
    return ends != other.ends ? ends < other.ends : edge < other.edge;
  }
};

class Bisector {
 public:
  Bisector(std::vector<Vec3> positions, std::vector<Vec3> normals, float max_edge) : max_edge_(max_edge) {
    out_.position = std::move(positions);
    out_.normal = std::move(normals);
    omerr().disable();  // it reports refused triangles, which we expect
    for (uint32_t v = 0; v < out_.position.size(); ++v) {
      mesh_.new_vertex();
      out_.ends.push_back({v, v});
    }
  }

  void Add(std::array<uint32_t, 3> corner) {
    const auto handle = [](uint32_t v) { return VertexHandle(static_cast<int>(v)); };
    FaceHandle face;
    if (corner[0] != corner[1] && corner[1] != corner[2] && corner[2] != corner[0]) {
      face = mesh_.add_face(handle(corner[0]), handle(corner[1]), handle(corner[2]));
    }
    if (!face.is_valid()) {
      for (uint32_t& v : corner) v = AddVertex({v, v});
      face = mesh_.add_face(handle(corner[0]), handle(corner[1]), handle(corner[2]));
    }
    leaf_.push_back(static_cast<uint32_t>(out_.cells.size()));
    out_.cells.push_back({corner});
  }

  Bisection Run(const std::function<void()>& poll) {
    for (const EdgeHandle edge : mesh_.edges()) Enqueue(edge);
    for (uint32_t i = 1; !queue_.empty(); ++i) {
      if (poll && i % 16384 == 0) poll();
      const EdgeHandle edge(queue_.top().edge);
      queue_.pop();
      Split(edge);
    }
    return std::move(out_);
  }

  RequestedBisection Grant(const std::vector<BisectionRequest>& requests, size_t max_vertices) {
    RequestedBisection result;
    for (const BisectionRequest& request : requests) {
      const size_t vertices = out_.position.size(), cells = out_.cells.size();
      bool all_cut = true;
      for (const uint32_t triangle : request) {
        if (triangle != kNoTriangle && !CutTriangle(triangle)) all_cut = false;
      }
      if (out_.position.size() > max_vertices && out_.position.size() > vertices) {
        Forget(vertices, cells);
        break;
      }
      ++result.granted;
      if (!all_cut) ++result.too_small;
    }
    result.bisection = std::move(out_);
    return result;
  }

 private:
  uint32_t AddVertex(std::array<uint32_t, 2> ends) {
    const auto& [a, b] = ends;
    out_.position.push_back((out_.position[a] + out_.position[b]) * 0.5f);
    out_.normal.push_back((out_.normal[a] + out_.normal[b]) * 0.5f);
    out_.ends.push_back(ends);
    return static_cast<uint32_t>(mesh_.new_vertex().idx());
  }

  void Enqueue(EdgeHandle edge) {
    const HalfedgeHandle h = mesh_.halfedge_handle(edge, 0);
    const Vec3& a = out_.position[mesh_.from_vertex_handle(h).idx()];
    const Vec3& b = out_.position[mesh_.to_vertex_handle(h).idx()];
    const double length = (a.cast<double>() - b.cast<double>()).norm();
    if (length > max_edge_) queue_.push({length, edge.idx()});
  }

  void Split(EdgeHandle edge) {
    constexpr size_t kMostFaces = size_t{1} << 29;  // halfedges are numbered by int
    if (mesh_.n_faces() >= kMostFaces) throw std::length_error("more than 2^29 triangles in one surface");

    // Of each triangle (p0, p1, p2) at the edge p1-p2, the halfedges into and out of p0 stay, whatever
    // OpenMesh does with the faces between them.
    struct Cut {
      HalfedgeHandle out_of_apex, into_apex;
      uint32_t cell;
    };
    std::array<Cut, 2> cuts;
    int count = 0;
    for (int i = 0; i < 2; ++i) {
      const HalfedgeHandle h = mesh_.halfedge_handle(edge, i);
      const FaceHandle face = mesh_.face_handle(h);
      if (face.is_valid()) {
        cuts[count++] = {mesh_.prev_halfedge_handle(h), mesh_.next_halfedge_handle(h), leaf_[face.idx()]};
      }
    }
    const HalfedgeHandle h = mesh_.halfedge_handle(edge, 0);
    const uint32_t a = static_cast<uint32_t>(mesh_.from_vertex_handle(h).idx());
    const uint32_t b = static_cast<uint32_t>(mesh_.to_vertex_handle(h).idx());
    const uint32_t middle = AddVertex({a, b});
    mesh_.split_edge(edge, VertexHandle(static_cast<int>(middle)));
    leaf_.resize(mesh_.n_faces());

    for (int i = 0; i < count; ++i) {
      const Cut& cut = cuts[i];
      const uint32_t apex = static_cast<uint32_t>(mesh_.to_vertex_handle(cut.into_apex).idx());
      const uint32_t child = static_cast<uint32_t>(out_.cells.size());
      Bisection::Cell& cell = out_.cells[cut.cell];
      while (cell.corner[cell.apex] != apex) ++cell.apex;
      cell.child = child;
      const uint32_t p1 = cell.corner[(cell.apex + 1) % 3], p2 = cell.corner[(cell.apex + 2) % 3];
      out_.cells.push_back({{apex, p1, middle}});
      out_.cells.push_back({{apex, middle, p2}});
      leaf_[mesh_.face_handle(cut.out_of_apex).idx()] = child;
      leaf_[mesh_.face_handle(cut.into_apex).idx()] = child + 1;

      const HalfedgeHandle half1 = mesh_.next_halfedge_handle(cut.out_of_apex);  // p1 to the middle
      const HalfedgeHandle half2 = mesh_.prev_halfedge_handle(cut.into_apex);    // the middle to p2
      Enqueue(mesh_.edge_handle(mesh_.next_halfedge_handle(half1)));             // the cut itself
      if (i == 0) {
        Enqueue(mesh_.edge_handle(half1));
        Enqueue(mesh_.edge_handle(half2));
      }
    }
  }

  /// Walks the propagation path from an uncut triangle to the edge that is the longest of both its
  /// triangles, cuts it, and comes back step by step. Ranks grow along the path, so it ends. False if an edge
  /// in the way is too short.
  bool CutTriangle(uint32_t triangle) {
    if (out_.cells[triangle].child != kNoTriangle) return true;
    path_.assign(1, FaceHandle(static_cast<int>(triangle)));
    while (!path_.empty()) {
      const HalfedgeHandle longest = LongestSide(path_.back());
      const EdgeHandle edge = mesh_.edge_handle(longest);
      const FaceHandle other = mesh_.opposite_face_handle(longest);
      if (other.is_valid() && mesh_.edge_handle(LongestSide(other)) != edge) {
        path_.push_back(other);
        continue;
      }
      if (IsTooShort(edge)) return false;
      Split(edge);
      path_.pop_back();
    }
    return true;
  }

  HalfedgeHandle LongestSide(FaceHandle face) const {
    const HalfedgeHandle first = mesh_.halfedge_handle(face);
    HalfedgeHandle longest = first;
    EdgeRank most = Rank(first);
    for (HalfedgeHandle h = mesh_.next_halfedge_handle(first); h != first;
         h = mesh_.next_halfedge_handle(h)) {
      const EdgeRank rank = Rank(h);
      if (most < rank) {
        most = rank;
        longest = h;
      }
    }
    return longest;
  }

  EdgeRank Rank(HalfedgeHandle h) const {
    const Vec3& p = out_.position[mesh_.from_vertex_handle(h).idx()];
    const Vec3& q = out_.position[mesh_.to_vertex_handle(h).idx()];
    const bool swap = std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
    const Vec3 &a = swap ? q : p, &b = swap ? p : q;
    return {(a.cast<double>() - b.cast<double>()).squaredNorm(),
            {a.x(), a.y(), a.z(), b.x(), b.y(), b.z()},
            mesh_.edge_handle(h).idx()};
  }

  bool IsTooShort(EdgeHandle edge) const {
    constexpr double kSteps = 64;  // chosen: halves differ from their ends, with digits to spare
    const EdgeRank rank = Rank(mesh_.halfedge_handle(edge, 0));
    double farthest = 0;
    for (const float x : rank.ends) farthest = std::max(farthest, std::abs(double{x}));
    const double shortest = kSteps * std::numeric_limits<float>::epsilon() * farthest;
    return !(rank.squared_length > shortest * shortest);
  }

  /// Goes back to when there were so many vertices and cells. OpenMesh's state is left behind.
  void Forget(size_t vertices, size_t cells) {
    out_.position.resize(vertices);
    out_.normal.resize(vertices);
    out_.ends.resize(vertices);
    out_.cells.resize(cells);
    for (Bisection::Cell& cell : out_.cells) {
      if (cell.child != kNoTriangle && cell.child >= cells) cell = {cell.corner};
    }
  }

  double max_edge_;
  TriMesh mesh_;
  std::vector<FaceHandle> path_;
  std::vector<uint32_t> leaf_;  // cell of each OpenMesh face
  std::priority_queue<LongEdge> queue_;
  Bisection out_;
};

}  // namespace

Bisection BisectLongEdges(const std::vector<std::array<uint32_t, 3>>& triangles, std::vector<Vec3> positions,
                          std::vector<Vec3> normals, float max_edge, const std::function<void()>& poll) {
  Bisector bisector(std::move(positions), std::move(normals), max_edge);
  for (const auto& triangle : triangles) bisector.Add(triangle);
  return bisector.Run(poll);
}

RequestedBisection BisectRequested(const std::vector<std::array<uint32_t, 3>>& triangles,
                                   std::vector<Vec3> positions, std::vector<Vec3> normals,
                                   const std::vector<BisectionRequest>& requests, size_t max_vertices) {
  constexpr float kAnyLength = std::numeric_limits<float>::infinity();
  Bisector bisector(std::move(positions), std::move(normals), kAnyLength);
  for (const auto& triangle : triangles) bisector.Add(triangle);
  return bisector.Grant(requests, max_vertices);
}

}  // namespace lobe
