#include "solver/near_contacts.h"

#include <algorithm>
#include <array>

#include <tbb/parallel_for.h>

#include "scene/box_tree.h"

namespace lobe {

std::vector<float> NearContacts(const Scene& scene, const Mesh& mesh, float distance) {
  std::vector<float> near(mesh.node_count(), 0.0f);
  std::vector<std::array<Vec3, 2>> lines;
  std::vector<BoxTree::Item> boxes;
  for (const Face& face : scene.faces) {
    const auto corners = scene.Corners(face);
    for (int k = 0; k < 3; ++k) {
      if (!(face.contact >> k & 1)) continue;
      lines.push_back({corners[k], corners[(k + 1) % 3]});
      Eigen::AlignedBox3f box(lines.back()[0].cwiseMin(lines.back()[1]),
                              lines.back()[0].cwiseMax(lines.back()[1]));
      boxes.push_back({box, uint32_t(lines.size() - 1)});
    }
  }
  if (lines.empty()) return near;
  const BoxTree tree(std::move(boxes));
  const Vec3 reach = Vec3::Constant(distance);
  tbb::parallel_for(size_t(0), near.size(), [&](size_t n) {
    const Vec3& p = mesh.node_position[n];
    tree.Find({p - reach, p + reach}, Vec3::UnitX(), p.x(), distance, [&](uint32_t i) {
      const Vec3 &a = lines[i][0], along = lines[i][1] - a;
      const float t = std::clamp((p - a).dot(along) / std::max(along.squaredNorm(), 1e-30f), 0.0f, 1.0f);
      if ((a + t * along - p).norm() <= distance) near[n] = 1;
    });
  });
  return near;
}

std::vector<float> CarryOver(const std::vector<float>& values, const Refinement& refined) {
  std::vector<float> out(refined.mesh.node_count(), 0.0f);
  for (size_t n = 0; n < refined.node_of_old.size(); ++n) out[refined.node_of_old[n]] = values[n];
  for (const uint32_t n : refined.made) {
    out[n] = 0.5f * (out[refined.parents[n][0]] + out[refined.parents[n][1]]);
  }
  return out;
}

}  // namespace lobe
