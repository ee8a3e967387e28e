#include "scene/bisection.h"

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

class Bisector {
 public:
  Bisector(std::vector<Vec3> positions, std::vector<Vec3> normals, float max_edge) : max_edge_(max_edge) {
    out_.position = std::move(positions);
    out_.normal = std::move(normals);
    omerr().disable();  // it reports refused triangles, which we expect
    for (size_t i = 0; i < out_.position.size(); ++i) mesh_.new_vertex();
  }

  void Add(std::array<uint32_t, 3> corner) {
    const auto handle = [](uint32_t v) { return VertexHandle(static_cast<int>(v)); };
    FaceHandle face = mesh_.add_face(handle(corner[0]), handle(corner[1]), handle(corner[2]));
    if (!face.is_valid()) {
      for (uint32_t& v : corner) v = AddVertex(Vec3(out_.position[v]), Vec3(out_.normal[v]));
      face = mesh_.add_face(handle(corner[0]), handle(corner[1]), handle(corner[2]));
    }
    leaf_.push_back(static_cast<uint32_t>(out_.cells.size()));
    out_.cells.push_back({corner});
  }

  Bisection Run() {
    for (const EdgeHandle edge : mesh_.edges()) Enqueue(edge);
    while (!queue_.empty()) {
      const EdgeHandle edge(queue_.top().edge);
      queue_.pop();
      Split(edge);
    }
    out_.border.assign(out_.position.size(), 0);
    for (const EdgeHandle edge : mesh_.edges()) {
      if (!mesh_.is_boundary(edge)) continue;
      const HalfedgeHandle h = mesh_.halfedge_handle(edge, 0);
      out_.border[mesh_.from_vertex_handle(h).idx()] = out_.border[mesh_.to_vertex_handle(h).idx()] = 1;
    }
    return std::move(out_);
  }

 private:
  uint32_t AddVertex(const Vec3& position, const Vec3& normal) {
    out_.position.push_back(position);
    out_.normal.push_back(normal);
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
    const uint32_t middle =
        AddVertex((out_.position[a] + out_.position[b]) * 0.5f, (out_.normal[a] + out_.normal[b]) * 0.5f);
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

  double max_edge_;
  TriMesh mesh_;
  std::vector<uint32_t> leaf_;  // cell of each OpenMesh face
  std::priority_queue<LongEdge> queue_;
  Bisection out_;
};

}  // namespace

Bisection BisectLongEdges(const std::vector<std::array<uint32_t, 3>>& triangles, std::vector<Vec3> positions,
                          std::vector<Vec3> normals, float max_edge) {
  Bisector bisector(std::move(positions), std::move(normals), max_edge);
  for (const auto& triangle : triangles) bisector.Add(triangle);
  return bisector.Run();
}

}  // namespace lobe
