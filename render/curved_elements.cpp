#include "render/curved_elements.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {
namespace {

float Angle(const Vec3& a, const Vec3& b) { return 2 * std::asin(std::min(1.0f, 0.5f * (a - b).norm())); }

// The largest angle between shading normals of an element's nodes.
float Turn(const Mesh& mesh, const std::array<uint32_t, 3>& nodes) {
  float turn = 0;
  for (int k = 0; k < 3; ++k) {
    turn = std::max(turn, Angle(mesh.node_normal[nodes[k]], mesh.node_normal[nodes[(k + 1) % 3]]));
  }
  return turn;
}

// The largest angle between the element's normal and its nodes' shading normals.
float Tilt(const Mesh& mesh, uint32_t element) {
  const Vec3 facet = mesh.ElementCross(element).normalized().cast<float>();
  float tilt = 0;
  for (const uint32_t n : mesh.elements[element]) tilt = std::max(tilt, Angle(facet, mesh.node_normal[n]));
  return tilt;
}

}  // namespace

std::vector<NotStored> FindCurvedElements(const Solution& solution) {
  const Mesh& mesh = solution.mesh;
  std::vector<NotStored> out;
  for (uint32_t p = 0; p < mesh.patches.size(); ++p) {
    const Mesh::Patch& patch = mesh.patches[p];
    const Material& material = solution.scene.materials[patch.material];
    const bool glows = patch.side == Side::kFront ? material.emits() : material.emits_behind();
    if (patch.planar || glows) continue;
    const PartDegrees& degrees = solution.total.patch_degrees(p);
    for (uint32_t e = patch.element_begin; e < patch.element_end; ++e) {
      const float gloss_turn =
          2 * Turn(mesh, mesh.elements[e]) * float(std::max(0, degrees.gloss)) / std::numbers::pi_v<float>;
      NotStored what = NotStored::kNothing;
      if (gloss_turn > kMostGlossTurn) {
        what = degrees.base < 0 ? NotStored::kGloss : NotStored::kStraightLight;
      } else if (Tilt(mesh, e) > kMostTilt) {
        what = NotStored::kStraightLight;
      }
      if (what == NotStored::kNothing) continue;
      if (out.empty()) out.resize(mesh.element_count(), NotStored::kNothing);
      out[e] = what;
    }
  }
  return out;
}

}  // namespace lobe
