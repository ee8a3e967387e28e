#include "scene/tessellate.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "scene/bisection.h"
#include "scene/input_error.h"
#include "scene/sample_points.h"
#include "scene/weld.h"

namespace lobe {

namespace {

/// Vertices of one surface closer than this, as a fraction of its size, are one; in any case if a few
/// roundings of its coordinates apart. (chosen: some ten times the rounding of single-precision coordinates)
/// The size is the surface's own: on a plane a million metres wide a teapot keeps its vertices.
constexpr double kWeldFraction = 1e-6;
constexpr double kWeldRoundings = 2;

double WeldDistance(const Scene& scene, const std::vector<std::array<uint32_t, 3>>& corners) {
  Eigen::AlignedBox3f bounds;
  for (const auto& triangle : corners) {
    for (const uint32_t v : triangle) bounds.extend(scene.positions[v]);
  }
  const float farthest = std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
  return std::max(kWeldFraction * double(bounds.diagonal().norm()),
                  kWeldRoundings * std::ldexp(double(farthest), -23));
}

/// Midpoints round; an edge that is too long by this fraction is not cut once more.
constexpr float kEdgeSlack = 1e-5f;

struct FaceSide {
  uint32_t face;
  Side side;
};

/// Everything that may be welded: one surface, material and side, faces in order.
using Group = std::vector<FaceSide>;

std::vector<Group> MakeGroups(const Scene& scene, const std::vector<bool>& sides) {
  std::vector<FaceSide> wanted;
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    // A face of no area has no side; the readers drop them, scenes made in code may not.
    if (!scene.GeometricNormal(scene.faces[f]).allFinite() || scene.Area(scene.faces[f]) == 0) continue;
    for (const Side side : {Side::kFront, Side::kBack}) {
      const Material& material = scene.material(scene.faces[f]);
      bool want = sides.empty() ? side == Side::kFront || material.double_sided
                                : sides[2 * size_t{f} + static_cast<size_t>(side)];
      // Light that goes through needs nodes to arrive at.
      if (!want && material.transmits())
        want = sides.empty() || sides[2 * size_t{f}] || sides[2 * size_t{f} + 1];
      if (want) wanted.push_back({f, side});
    }
  }
  const auto key = [&scene](const FaceSide& s) {
    return std::tuple(scene.faces[s.face].surface, scene.faces[s.face].material, s.side);
  };
  std::stable_sort(wanted.begin(), wanted.end(),
                   [&](const FaceSide& a, const FaceSide& b) { return key(a) < key(b); });
  std::vector<Group> groups;
  for (const FaceSide& s : wanted) {
    if (groups.empty() || key(groups.back().front()) != key(s)) groups.emplace_back();
    groups.back().push_back(s);
  }
  return groups;
}

/// About how many elements a triangle needs: at least its longest edge over max_edge, and its area over
/// that of a right isosceles triangle with such a hypotenuse, the shape bisection tends to.
double EstimateElements(const std::array<Vec3, 3>& p, double area, double max_edge) {
  double longest = 0;
  for (int i = 0; i < 3; ++i) longest = std::max<double>(longest, (p[i] - p[(i + 1) % 3]).norm());
  return std::max({1.0, longest / max_edge, 4 * area / (max_edge * max_edge)});
}

void CheckSize(const Scene& scene, const Eigen::AlignedBox3f& bounds, const std::vector<Group>& groups,
               float max_edge) {
  double elements = 0;
  for (const Group& group : groups) {
    for (const FaceSide& s : group) {
      const Face& face = scene.faces[s.face];
      elements += EstimateElements(scene.Corners(face), scene.Area(face), max_edge);
    }
  }
  std::ostringstream edge, count;
  edge << max_edge;
  count.precision(2);
  count << elements;
  if (elements > std::ldexp(1.0, 31)) {
    throw InputError(scene.path + ": edges of at most " + edge.str() + " m would make about " + count.str() +
                     " elements, expected at most 2^31; choose longer edges");
  }
  // Asked here because a system that lends more memory than it has would end the program without a word.
  constexpr double kBytesPerElement = 200;  // measured: 235 in all for a diffuse scene, lobes come on top
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  if (memory > 0 && kBytesPerElement * elements > memory) {
    std::ostringstream need, have;
    need << std::ceil(kBytesPerElement * elements * 1e-9);
    have << std::floor(memory * 1e-9);
    throw InputError(scene.path + ": edges of at most " + edge.str() + " m would make about " + count.str() +
                     " elements, which need at least " + need.str() + " GB of memory, expected at most the " +
                     have.str() + " GB of this machine; choose longer edges");
  }
  const float farthest = std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
  // Midpoints must differ from their ends, with digits to spare.
  if (!groups.empty() && max_edge < 64 * std::ldexp(farthest, -23)) {
    throw InputError(scene.path + ": edges of at most " + edge.str() +
                     " m are finer than coordinates of the scene's extent can express; choose longer edges");
  }
}

/// The same triangles seen from behind: corners 1 and 2 change places, and so do the two halves of a cut.
void Flip(Bisection* bisection) {
  for (Vec3& n : bisection->normal) n = -n;
  for (Bisection::Cell& cell : bisection->cells) {
    std::swap(cell.corner[1], cell.corner[2]);
    cell.apex = static_cast<uint8_t>((3 - cell.apex) % 3);
    if (cell.child != kNone) std::swap(bisection->cells[cell.child], bisection->cells[cell.child + 1]);
  }
}

/// Backs are bisected as fronts and then flipped, so that a face is cut alike on both sides.
/// `wide`: see PartAtContacts; by vertex, shorter than those.
Bisection BisectGroup(const Scene& scene, const Eigen::AlignedBox3f& bounds, const Group& group,
                      const TessellateOptions& options, const std::function<void()>& poll,
                      std::vector<bool>* wide) {
  std::vector<std::array<uint32_t, 3>> triangles;
  for (const FaceSide& s : group) triangles.push_back(scene.faces[s.face].vertex);
  Welder welder(bounds, WeldDistance(scene, triangles), options.crease_angle);
  triangles.clear();
  std::vector<uint32_t> contact;
  triangles.reserve(group.size());
  for (const FaceSide& s : group) {
    const Face& face = scene.faces[s.face];
    std::array<Vec3, 3> position = scene.Corners(face), normal;
    for (int k = 0; k < 3; ++k) normal[k] = scene.CornerNormal(face, k);
    std::array<uint32_t, 3> corner;
    for (int k = 0; k < 3; ++k) corner[k] = welder.Add(position[k], normal[k]);
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) {
      // Smaller than the welding distance.
      for (int k = 0; k < 3; ++k) corner[k] = welder.AddAlone(position[k], normal[k]);
    }
    triangles.push_back(corner);
    contact.push_back(face.contact);
  }
  *wide = PartAtContacts(contact, &welder, &triangles);
  Bisection bisection = BisectLongEdges(triangles, welder.positions(), welder.normals(),
                                        options.max_edge * (1 + kEdgeSlack), poll);
  if (group.front().side == Side::kBack) Flip(&bisection);
  return bisection;
}

/// Roots of a group, by connected piece, in order of their first.
std::vector<std::vector<uint32_t>> ConnectedPieces(const Bisection& bisection, size_t root_count) {
  std::vector<uint32_t> parent;
  for (uint32_t v = 0; v < bisection.position.size(); ++v) parent.push_back(v);
  const auto find = [&parent](uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (size_t i = 0; i < root_count; ++i) {
    const auto& corner = bisection.cells[i].corner;
    for (int k = 1; k < 3; ++k) parent[find(corner[k])] = find(corner[0]);
  }
  std::vector<std::vector<uint32_t>> pieces;
  std::vector<uint32_t> piece_of(bisection.position.size(), kNone);
  for (uint32_t i = 0; i < root_count; ++i) {
    uint32_t& piece = piece_of[find(bisection.cells[i].corner[0])];
    if (piece == kNone) {
      piece = static_cast<uint32_t>(pieces.size());
      pieces.emplace_back();
    }
    pieces[piece].push_back(i);
  }
  return pieces;
}

/// Writes one bisected group after another into a mesh: trees in preorder, elements in the order of leaves,
/// nodes in the order elements meet them.
class Layout {
 public:
  explicit Layout(Mesh* mesh) : mesh_(*mesh) {}

  void Append(const Scene& scene, const Group& group, const Bisection& bisection, std::vector<bool> wide) {
    node_of_vertex_.assign(bisection.position.size(), kNone);
    wide_ = std::move(wide);
    wide_.resize(bisection.position.size());
    for (const std::vector<uint32_t>& piece : ConnectedPieces(bisection, group.size())) {
      Mesh::Patch patch;
      const Face& face = scene.faces[group[piece[0]].face];
      patch.material = face.material;
      patch.surface = face.surface;
      patch.side = group[piece[0]].side;
      patch.node_begin = static_cast<uint32_t>(mesh_.node_count());
      patch.element_begin = static_cast<uint32_t>(mesh_.element_count());
      for (uint32_t root : piece) {
        const FaceSide& s = group[root];
        mesh_.roots[2 * size_t{s.face} + static_cast<size_t>(s.side)] = AppendTree(bisection, root);
      }
      patch.node_end = static_cast<uint32_t>(mesh_.node_count());
      patch.element_end = static_cast<uint32_t>(mesh_.element_count());
      const uint32_t index = static_cast<uint32_t>(mesh_.patches.size());
      mesh_.node_patch.resize(patch.node_end, index);
      mesh_.element_patch.resize(patch.element_end, index);
      FinishNormals(&patch);
      mesh_.patches.push_back(patch);
    }
  }

 private:
  uint32_t AppendTree(const Bisection& bisection, uint32_t bisection_root) {
    struct Pending {
      uint32_t from, to;
    };
    const uint32_t root = static_cast<uint32_t>(mesh_.cells.size());
    mesh_.cells.emplace_back();
    std::vector<Pending> stack = {{bisection_root, root}};
    while (!stack.empty()) {
      const Pending p = stack.back();
      stack.pop_back();
      const Bisection::Cell& from = bisection.cells[p.from];
      if (from.child == kNone) {
        mesh_.cells[p.to].element = AppendElement(bisection, from.corner);
        continue;
      }
      const uint32_t child = static_cast<uint32_t>(mesh_.cells.size());
      mesh_.cells[p.to].child = child;
      mesh_.cells[p.to].apex = from.apex;
      mesh_.cells.resize(child + 2);
      stack.push_back({from.child + 1, child + 1});
      stack.push_back({from.child, child});
    }
    return root;
  }

  uint32_t AppendElement(const Bisection& bisection, const std::array<uint32_t, 3>& vertices) {
    std::array<uint32_t, 3> nodes;
    for (int k = 0; k < 3; ++k) {
      uint32_t& node = node_of_vertex_[vertices[k]];
      if (node == kNone || wide_[vertices[k]]) {  // at wide corners every element has a node of its own
        node = static_cast<uint32_t>(mesh_.node_count());
        mesh_.node_position.push_back(bisection.position[vertices[k]]);
        mesh_.node_normal.push_back(bisection.normal[vertices[k]]);
      }
      nodes[k] = node;
    }
    mesh_.elements.push_back(nodes);
    return static_cast<uint32_t>(mesh_.elements.size() - 1);
  }

  /// Unit shading normals on the patch's side.
  void FinishNormals(Mesh::Patch* patch) {
    const uint32_t begin = patch->node_begin;
    const std::vector<Vec3d> mean_normal = MeanNormals(mesh_, *patch);
    for (uint32_t n = begin; n < patch->node_end; ++n) {
      Vec3& normal = mesh_.node_normal[n];
      const Vec3 mean = mean_normal[n - begin].cast<float>();
      const bool has_mean = !mean.isZero(0);
      normal.normalize();
      // Interpolation between normals that oppose each other ends anywhere.
      if (has_mean && !(normal.dot(mean) > 0)) normal = mean;
      if (!normal.allFinite() || normal.isZero(0)) normal = Vec3::UnitZ();
    }
    patch->planar = true;
    for (uint32_t n = begin; n < patch->node_end; ++n) {
      if (!((mesh_.node_normal[n] - mesh_.node_normal[begin]).norm() <= 1e-6f)) patch->planar = false;
    }
  }

  Mesh& mesh_;
  std::vector<uint32_t> node_of_vertex_;
  std::vector<bool> wide_;  // by vertex
};

}  // namespace

Mesh Tessellate(const Scene& scene, const TessellateOptions& options, const std::vector<bool>& sides,
                const std::function<void()>& poll) {
  if (!(options.max_edge > 0) || !std::isfinite(options.max_edge)) {
    throw std::invalid_argument("Tessellate: max_edge must be positive");
  }
  if (!sides.empty() && sides.size() != 2 * scene.faces.size()) {
    throw std::invalid_argument("Tessellate: sides must hold two per face");
  }
  const std::vector<Group> groups = MakeGroups(scene, sides);
  const Eigen::AlignedBox3f bounds = scene.Bounds();
  CheckSize(scene, bounds, groups, options.max_edge);

  Mesh mesh;
  mesh.roots.assign(2 * scene.faces.size(), kNone);
  Layout layout(&mesh);
  for (const Group& group : groups) {
    if (poll) poll();
    std::vector<bool> wide;
    const Bisection bisection = BisectGroup(scene, bounds, group, options, poll, &wide);
    layout.Append(scene, group, bisection, std::move(wide));
  }
  PlaceSamplePoints(&mesh, options.border_inset);
  return mesh;
}

}  // namespace lobe
