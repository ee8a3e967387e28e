#include "solver/planar_mirrors.h"

#include <algorithm>

namespace lobe {

std::vector<PlanarMirror> FindPlanarMirrors(const Mesh& mesh, const std::vector<MaterialLobes>& materials,
                                            const std::vector<Emitter>& emitters) {
  // In a furnace whose walls all glow, shadow rays to images of walls were twice as noisy as links; a lamp
  // of a twentieth of the mirror's size is seen whole from most places that see it at all (chosen).
  constexpr double kSmall = 0.05;

  struct Candidate {
    PlanarMirror mirror;
    double area;
  };
  std::vector<Candidate> candidates;
  for (uint32_t p = 0; p < mesh.patches.size(); ++p) {
    const Mesh::Patch& patch = mesh.patches[p];
    if (patch.node_begin == patch.node_end || !patch.planar || !materials[patch.material].mirror()) continue;
    const Vec3& point = mesh.node_position[patch.node_begin];
    const Vec3& normal = mesh.node_sample_normal[patch.node_begin];
    // Equal shading normals do not make a plane: steps share theirs.
    float extent = 0, off = 0;
    for (uint32_t n = patch.node_begin; n < patch.node_end; ++n) {
      const Vec3 to = mesh.node_position[n] - point;
      extent = std::max(extent, to.norm());
      off = std::max(off, std::abs(to.dot(normal)));
    }
    if (off > 1e-5f * extent || (mesh.node_normal[patch.node_begin] - normal).norm() > 1e-4f) continue;
    double area = 0;
    for (uint32_t e = patch.element_begin; e < patch.element_end; ++e) area += mesh.ElementArea(e);
    candidates.push_back({{p, point, normal, float(kSmall * area)}, area});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.area > b.area; });
  std::vector<PlanarMirror> out;
  size_t images = 0;
  for (const Candidate& c : candidates) {
    const auto small = [&](const Emitter& e) { return e.area < c.mirror.largest_emitter; };
    const auto more = size_t(std::count_if(emitters.begin(), emitters.end(), small));
    if (more == 0 || images + more > kMostImages) continue;
    images += more;
    out.push_back(c.mirror);
  }
  return out;
}

}  // namespace lobe
