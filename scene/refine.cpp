#include "scene/refine.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "scene/bisection.h"
#include "scene/sample_points.h"

namespace lobe {

namespace {

/// Must a face of this material be cut alike on both sides, since light passes through it?
bool SidesStayAlike(const Material& material) { return material.transmits(); }

/// Per element, the one on the other side of the same piece of a sheet that is to stay alike; kNone without.
std::vector<uint32_t> OppositeElements(const Scene& scene, const Mesh& mesh) {
  std::vector<uint32_t> opposite(mesh.element_count(), kNone);
  std::vector<std::array<uint32_t, 2>> open;  // a cell of the front, a cell of the back
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    const uint32_t front = mesh.roots[2 * f], back = mesh.roots[2 * f + 1];
    if (front == kNone || back == kNone || !SidesStayAlike(scene.material(scene.faces[f]))) continue;
    // A back's corners are (p0, p2, p1) of the front's, which stays so from parent to child if of the
    // children of one the first goes with the second of the other.
    open.push_back({front, back});
    while (!open.empty()) {
      const Mesh::Cell &a = mesh.cells[open.back()[0]], &b = mesh.cells[open.back()[1]];
      open.pop_back();
      if (a.child == kNone && b.child == kNone) {
        opposite[a.element] = b.element;
        opposite[b.element] = a.element;
      } else if (a.child != kNone && b.child != kNone && b.apex == (3 - a.apex) % 3) {
        open.push_back({a.child, b.child + 1});
        open.push_back({a.child + 1, b.child});
      }
    }
  }
  return opposite;
}

/// Highest priority first. An element and its opposite are one request, at the higher one's place.
std::vector<BisectionRequest> Requests(const std::vector<float>& priority,
                                       const std::vector<uint32_t>& opposite) {
  std::vector<uint32_t> order;
  for (uint32_t e = 0; e < priority.size(); ++e) {
    if (priority[e] > 0) order.push_back(e);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return priority[a] > priority[b]; });
  std::vector<BisectionRequest> requests;
  std::vector<bool> asked(priority.size(), false);
  for (const uint32_t e : order) {
    if (asked[e]) continue;
    if (opposite[e] != kNone) asked[opposite[e]] = true;
    requests.push_back({e, opposite[e]});
  }
  static_assert(kNone == kNoTriangle);
  return requests;
}

/// Vertices' shading normals, of unit length: those given, and of the others the mean of their ends'.
std::vector<Vec3> ShadingNormals(const Mesh& mesh, const Bisection& bisection) {
  std::vector<Vec3> normal = mesh.node_normal;
  normal.reserve(bisection.ends.size());
  for (size_t v = normal.size(); v < bisection.ends.size(); ++v) {
    const Vec3 &a = normal[bisection.ends[v][0]], &b = normal[bisection.ends[v][1]];
    normal.push_back(a == b ? Vec3(a) : (a + b).normalized());
  }
  return normal;
}

/// Writes the old mesh's trees with the bisections of its elements hung into their leaves: trees in preorder,
/// elements in the order of leaves, nodes in the order elements meet them.
class Rewriter {
 public:
  Rewriter(const Mesh& old, const Bisection& bisection)
      : old_(old),
        bisection_(bisection),
        normal_(ShadingNormals(old, bisection)),
        node_of_vertex_(bisection.position.size(), kNone) {}

  /// Fills everything but sample points.
  void Run(Refinement* out) {
    mesh_.roots.assign(old_.roots.size(), kNone);
    for (const Root& root : RootsInOrder()) {
      while (mesh_.patches.size() <= old_.element_patch[root.element]) BeginPatch();
      mesh_.roots[root.index] = AppendTree(old_.roots[root.index]);
    }
    while (mesh_.patches.size() < old_.patches.size()) BeginPatch();
    EndPatch();

    const size_t old_count = old_.node_count();
    out->node_of_old.assign(node_of_vertex_.begin(), node_of_vertex_.begin() + ptrdiff_t(old_count));
    out->made.assign(node_of_vertex_.begin() + ptrdiff_t(old_count), node_of_vertex_.end());
    out->parents.resize(mesh_.node_count());
    for (size_t v = 0; v < node_of_vertex_.size(); ++v) {
      const auto& [a, b] = bisection_.ends[v];
      out->parents[node_of_vertex_[v]] = {node_of_vertex_[a], node_of_vertex_[b]};
    }
    out->mesh = std::move(mesh_);
  }

 private:
  struct Root {
    size_t index;
    uint32_t element;  // its tree's first
  };

  /// In the order of their elements, and so by patch.
  std::vector<Root> RootsInOrder() const {
    std::vector<Root> roots;
    for (size_t i = 0; i < old_.roots.size(); ++i) {
      if (old_.roots[i] == kNone) continue;
      uint32_t cell = old_.roots[i];
      while (old_.cells[cell].child != kNone) cell = old_.cells[cell].child;
      roots.push_back({i, old_.cells[cell].element});
    }
    std::sort(roots.begin(), roots.end(), [](const Root& a, const Root& b) { return a.element < b.element; });
    return roots;
  }

  void BeginPatch() {
    EndPatch();
    Mesh::Patch patch = old_.patches[mesh_.patches.size()];
    patch.node_begin = static_cast<uint32_t>(mesh_.node_count());
    patch.element_begin = static_cast<uint32_t>(mesh_.element_count());
    mesh_.patches.push_back(patch);
  }

  void EndPatch() {
    if (mesh_.patches.empty()) return;
    const uint32_t index = static_cast<uint32_t>(mesh_.patches.size() - 1);
    Mesh::Patch& patch = mesh_.patches.back();
    // Nodes that no element has; ours have none such, files by other hands may.
    for (uint32_t n = old_.patches[index].node_begin; n < old_.patches[index].node_end; ++n) NodeOf(n);
    patch.node_end = static_cast<uint32_t>(mesh_.node_count());
    patch.element_end = static_cast<uint32_t>(mesh_.element_count());
    mesh_.node_patch.resize(patch.node_end, index);
    mesh_.element_patch.resize(patch.element_end, index);
  }

  uint32_t AppendTree(uint32_t old_root) {
    struct Pending {
      uint32_t from, to;
      bool cut_now;  // `from` is a cell of the bisection, not of the old mesh
    };
    const uint32_t root = static_cast<uint32_t>(mesh_.cells.size());
    mesh_.cells.emplace_back();
    std::vector<Pending> open = {{old_root, root, false}};
    while (!open.empty()) {
      Pending p = open.back();
      open.pop_back();
      if (!p.cut_now && old_.cells[p.from].child == kNone) p = {old_.cells[p.from].element, p.to, true};
      const uint32_t from_child = p.cut_now ? bisection_.cells[p.from].child : old_.cells[p.from].child;
      if (from_child == kNone) {
        mesh_.cells[p.to].element = AppendElement(bisection_.cells[p.from].corner);
        continue;
      }
      const uint32_t child = static_cast<uint32_t>(mesh_.cells.size());
      mesh_.cells[p.to].child = child;
      mesh_.cells[p.to].apex = p.cut_now ? bisection_.cells[p.from].apex : old_.cells[p.from].apex;
      mesh_.cells.resize(child + 2);
      open.push_back({from_child + 1, child + 1, p.cut_now});
      open.push_back({from_child, child, p.cut_now});
    }
    return root;
  }

  uint32_t AppendElement(const std::array<uint32_t, 3>& vertices) {
    mesh_.elements.push_back({NodeOf(vertices[0]), NodeOf(vertices[1]), NodeOf(vertices[2])});
    return static_cast<uint32_t>(mesh_.elements.size() - 1);
  }

  uint32_t NodeOf(uint32_t vertex) {
    uint32_t& node = node_of_vertex_[vertex];
    if (node == kNone) {
      node = static_cast<uint32_t>(mesh_.node_count());
      mesh_.node_position.push_back(bisection_.position[vertex]);
      mesh_.node_normal.push_back(normal_[vertex]);
    }
    return node;
  }

  const Mesh& old_;
  const Bisection& bisection_;
  const std::vector<Vec3> normal_;
  std::vector<uint32_t> node_of_vertex_;
  Mesh mesh_;
};

}  // namespace

Refinement RefineMesh(const Scene& scene, const Mesh& mesh, const std::vector<float>& priority,
                      const TessellateOptions& options, size_t max_nodes) {
  if (priority.size() != mesh.element_count()) {
    throw std::invalid_argument("RefineMesh: priority must hold one value per element");
  }
  if (mesh.roots.size() != 2 * scene.faces.size()) {
    throw std::invalid_argument("RefineMesh: the mesh is not one of this scene");
  }
  const std::vector<BisectionRequest> requests = Requests(priority, OppositeElements(scene, mesh));
  const RequestedBisection requested =
      BisectRequested(mesh.elements, mesh.node_position, mesh.node_normal, requests, max_nodes);

  Refinement out;
  out.asked =
      static_cast<size_t>(std::count_if(priority.begin(), priority.end(), [](float p) { return p > 0; }));
  out.left_too_small = requested.too_small;
  out.out_of_nodes = requested.granted < requests.size();
  Rewriter(mesh, requested.bisection).Run(&out);
  PlaceSamplePoints(&out.mesh, options.border_inset);
  // The mean of two normals that oppose each other points anywhere; on a curved patch it may also point
  // behind the elements.
  for (const uint32_t n : out.made) {
    if (out.mesh.patches[out.mesh.node_patch[n]].planar) continue;
    const Vec3& geometric = out.mesh.node_sample_normal[n];
    if (!(out.mesh.node_normal[n].dot(geometric) > 0)) out.mesh.node_normal[n] = geometric;
  }
  return out;
}

}  // namespace lobe
