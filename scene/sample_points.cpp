#include "scene/sample_points.h"

#include "scene/mesh_edges.h"

namespace lobe {

namespace {

Vec3d Centroid(const Mesh& mesh, uint32_t element) {
  Vec3d sum = Vec3d::Zero();
  for (uint32_t n : mesh.elements[element]) sum += mesh.node_position[n].cast<double>();
  return sum / 3;
}

std::vector<uint8_t> BorderNodes(const Mesh& mesh) {
  std::vector<uint8_t> border(mesh.node_count(), 0);
  for (const MeshEdge& edge : MeshEdges(mesh)) {
    if (edge.element[1] == kNone) border[edge.node[0]] = border[edge.node[1]] = 1;
  }
  return border;
}

void PlacePatch(Mesh* mesh, const Mesh::Patch& patch, const std::vector<uint8_t>& border,
                float border_inset) {
  struct Surround {
    Vec3d centroids = Vec3d::Zero();  // their sum
    int elements = 0;
    bool flat = true;
    double best = -1;  // of a border node on a curved surface, see below
  };
  const uint32_t begin = patch.node_begin;
  const std::vector<Vec3d> mean_normal = MeanNormals(*mesh, patch);
  std::vector<Surround> around(mean_normal.size());
  for (uint32_t e = patch.element_begin; e < patch.element_end; ++e) {
    const Vec3d centroid = Centroid(*mesh, e), normal = mesh->ElementCross(e).normalized();
    for (uint32_t n : mesh->elements[e]) {
      Surround& s = around[n - begin];
      s.centroids += centroid;
      ++s.elements;
      // Coplanar up to the rounding of small elements' corners.
      if (!(normal.dot(mean_normal[n - begin]) > 1 - 1e-6)) s.flat = false;
    }
  }
  for (uint32_t n = begin; n < patch.node_end; ++n) {
    const Surround& s = around[n - begin];
    const Vec3d p = mesh->node_position[n].cast<double>();
    Vec3d sample = p;
    if (border[n]) sample += border_inset * (s.centroids / s.elements - p);
    mesh->node_sample_position[n] = sample.cast<float>();
    const Vec3d& mean = mean_normal[n - begin];
    mesh->node_sample_normal[n] = mean.isZero(0) ? mesh->node_normal[n] : Vec3(mean.cast<float>());
  }
  // On a curved surface the way to the mean of the centroids leaves the surface, on a convex one
  // into the solid. There the node goes into the one element that lies most in that direction.
  for (uint32_t e = patch.element_begin; e < patch.element_end; ++e) {
    const Vec3d cross = mesh->ElementCross(e);
    if (cross.isZero(0)) continue;
    const Vec3d centroid = Centroid(*mesh, e);
    for (uint32_t n : mesh->elements[e]) {
      Surround& s = around[n - begin];
      if (!border[n] || s.flat) continue;
      const Vec3d p = mesh->node_position[n].cast<double>();
      const double towards = (centroid - p).normalized().dot((s.centroids / s.elements - p).normalized());
      if (towards <= s.best) continue;
      s.best = towards;
      mesh->node_sample_position[n] = (p + border_inset * (centroid - p)).cast<float>();
      mesh->node_sample_normal[n] = cross.normalized().cast<float>();
    }
  }
}

}  // namespace

std::vector<Vec3d> MeanNormals(const Mesh& mesh, const Mesh::Patch& patch) {
  std::vector<Vec3d> sum(patch.node_end - patch.node_begin, Vec3d::Zero());
  for (uint32_t e = patch.element_begin; e < patch.element_end; ++e) {
    const Vec3d cross = mesh.ElementCross(e);
    for (uint32_t n : mesh.elements[e]) sum[n - patch.node_begin] += cross;
  }
  for (Vec3d& n : sum) n.normalize();  // leaves zero as it is
  return sum;
}

void PlaceSamplePoints(Mesh* mesh, float border_inset) {
  mesh->node_sample_position.resize(mesh->node_count());
  mesh->node_sample_normal.resize(mesh->node_count());
  const std::vector<uint8_t> border = BorderNodes(*mesh);
  for (const Mesh::Patch& patch : mesh->patches) PlacePatch(mesh, patch, border, border_inset);
}

}  // namespace lobe
