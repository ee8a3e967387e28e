#include "scene/tessellate.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "scene/bisection.h"
#include "scene/input_error.h"
#include "scene/weld.h"

namespace lobe {

namespace {

/// Vertices of one surface closer than this, as a fraction of the scene's size, are one. (chosen: some ten
/// times the rounding of single-precision coordinates)
constexpr double kWeldFraction = 1e-6;

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
      const bool want = sides.empty() ? side == Side::kFront || scene.material(scene.faces[f]).double_sided
                                      : sides[2 * size_t{f} + static_cast<size_t>(side)];
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

/// Shading normal at a corner of a face, on the front: one that points behind the face is turned, one that
/// lies in its plane replaced.
Vec3 CornerNormal(const Scene& scene, const Face& face, int k, const Vec3& geometric) {
  constexpr float kGrazing = 1e-3f;  // chosen
  const Vec3& normal = scene.normals[face.vertex[k]];
  const float cosine = normal.dot(geometric);
  if (!(std::abs(cosine) > kGrazing)) return geometric;
  return cosine > 0 ? normal : Vec3(-normal);
}

/// `wide`: see PartAtContacts; by vertex, shorter than those.
Bisection BisectGroup(const Scene& scene, const Eigen::AlignedBox3f& bounds, const Group& group,
                      const TessellateOptions& options, std::vector<bool>* wide) {
  Welder welder(bounds, kWeldFraction * bounds.diagonal().norm(), options.crease_angle);
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<uint32_t> contact;
  triangles.reserve(group.size());
  for (const FaceSide& s : group) {
    const Face& face = scene.faces[s.face];
    const Vec3 geometric = scene.GeometricNormal(face);
    std::array<Vec3, 3> position = scene.Corners(face), normal;
    for (int k = 0; k < 3; ++k) normal[k] = CornerNormal(scene, face, k, geometric);
    if (s.side == Side::kBack) {
      std::swap(position[1], position[2]);
      std::swap(normal[1], normal[2]);
      for (Vec3& n : normal) n = -n;
    }
    std::array<uint32_t, 3> corner;
    for (int k = 0; k < 3; ++k) corner[k] = welder.Add(position[k], normal[k]);
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) {
      // Smaller than the welding distance.
      for (int k = 0; k < 3; ++k) corner[k] = welder.AddAlone(position[k], normal[k]);
    }
    triangles.push_back(corner);
    const uint32_t bits = face.contact;
    // The back's corners 1 and 2 are swapped, so its first edge is the face's last.
    contact.push_back(s.side == Side::kFront ? bits : (bits & 2) | (bits & 1) << 2 | bits >> 2);
  }
  *wide = PartAtContacts(contact, &welder, &triangles);
  return BisectLongEdges(triangles, welder.positions(), welder.normals(),
                         options.max_edge * (1 + kEdgeSlack));
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
  Layout(Mesh* mesh, const TessellateOptions& options) : mesh_(*mesh), options_(options) {}

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
      border_.clear();
      for (uint32_t root : piece) {
        const FaceSide& s = group[root];
        mesh_.roots[2 * size_t{s.face} + static_cast<size_t>(s.side)] = AppendTree(bisection, root);
      }
      patch.node_end = static_cast<uint32_t>(mesh_.node_count());
      patch.element_end = static_cast<uint32_t>(mesh_.element_count());
      const uint32_t index = static_cast<uint32_t>(mesh_.patches.size());
      mesh_.node_patch.resize(patch.node_end, index);
      mesh_.element_patch.resize(patch.element_end, index);
      FinishNodes(&patch);
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
        border_.push_back(bisection.border[vertices[k]]);
      }
      nodes[k] = node;
    }
    mesh_.elements.push_back(nodes);
    return static_cast<uint32_t>(mesh_.elements.size() - 1);
  }

  /// Twice the area times the geometric normal, on the patch's side.
  Vec3d ElementCross(uint32_t element) const {
    const auto& e = mesh_.elements[element];
    const Vec3d p = mesh_.node_position[e[0]].cast<double>();
    return (mesh_.node_position[e[1]].cast<double>() - p).cross(mesh_.node_position[e[2]].cast<double>() - p);
  }

  Vec3d Centroid(uint32_t element) const {
    Vec3d sum = Vec3d::Zero();
    for (uint32_t n : mesh_.elements[element]) sum += mesh_.node_position[n].cast<double>();
    return sum / 3;
  }

  /// Unit shading normals, and where nodes gather light.
  void FinishNodes(Mesh::Patch* patch) {
    const uint32_t begin = patch->node_begin, count = patch->node_end - begin;
    struct Surround {
      Vec3d cross = Vec3d::Zero(), centroids = Vec3d::Zero();
      int elements = 0;
      bool flat = true;
      double best = -1;  // of a border node on a curved surface, see below
    };
    std::vector<Surround> around(count);
    for (uint32_t e = patch->element_begin; e < patch->element_end; ++e) {
      const Vec3d cross = ElementCross(e), centroid = Centroid(e);
      for (uint32_t n : mesh_.elements[e]) {
        around[n - begin].cross += cross;
        around[n - begin].centroids += centroid;
        ++around[n - begin].elements;
      }
    }
    for (Surround& s : around) s.cross.normalize();
    for (uint32_t e = patch->element_begin; e < patch->element_end; ++e) {
      const Vec3d normal = ElementCross(e).normalized();
      for (uint32_t n : mesh_.elements[e]) {
        // Coplanar up to the rounding of small elements' corners.
        if (!(normal.dot(around[n - begin].cross) > 1 - 1e-6)) around[n - begin].flat = false;
      }
    }

    mesh_.node_sample_position.resize(patch->node_end);
    mesh_.node_sample_normal.resize(patch->node_end);
    for (uint32_t n = begin; n < patch->node_end; ++n) {
      const Surround& s = around[n - begin];
      Vec3& normal = mesh_.node_normal[n];
      const Vec3 average = s.cross.cast<float>();
      normal.normalize();
      // Interpolation between normals that oppose each other ends anywhere.
      if (!normal.allFinite() || (average.allFinite() && normal.dot(average) <= 0)) normal = average;
      if (!normal.allFinite()) normal = Vec3::UnitZ();

      const Vec3d p = mesh_.node_position[n].cast<double>();
      Vec3d sample = p;
      if (border_[n - begin]) sample += options_.border_inset * (s.centroids / s.elements - p);
      mesh_.node_sample_position[n] = sample.cast<float>();
      mesh_.node_sample_normal[n] = average.allFinite() ? average : normal;
    }
    // On a curved surface the way to the mean of the centroids leaves the surface, on a convex one
    // into the solid. There the node goes into the one element that lies most in that direction.
    for (uint32_t e = patch->element_begin; e < patch->element_end; ++e) {
      const Vec3d centroid = Centroid(e);
      for (uint32_t n : mesh_.elements[e]) {
        Surround& s = around[n - begin];
        if (!border_[n - begin] || s.flat) continue;
        const Vec3d p = mesh_.node_position[n].cast<double>();
        const double towards = (centroid - p).normalized().dot((s.centroids / s.elements - p).normalized());
        if (towards <= s.best) continue;
        s.best = towards;
        mesh_.node_sample_position[n] = (p + options_.border_inset * (centroid - p)).cast<float>();
        mesh_.node_sample_normal[n] = ElementCross(e).normalized().cast<float>();
      }
    }
    patch->planar = true;
    for (uint32_t n = begin; n < patch->node_end; ++n) {
      if (!((mesh_.node_normal[n] - mesh_.node_normal[begin]).norm() <= 1e-6f)) patch->planar = false;
    }
  }

  Mesh& mesh_;
  const TessellateOptions& options_;
  std::vector<uint32_t> node_of_vertex_;
  std::vector<bool> wide_;       // by vertex
  std::vector<uint8_t> border_;  // per node of the patch at hand
};

}  // namespace

Mesh Tessellate(const Scene& scene, const TessellateOptions& options, const std::vector<bool>& sides) {
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
  Layout layout(&mesh, options);
  for (const Group& group : groups) {
    std::vector<bool> wide;
    const Bisection bisection = BisectGroup(scene, bounds, group, options, &wide);
    layout.Append(scene, group, bisection, std::move(wide));
  }
  return mesh;
}

}  // namespace lobe
