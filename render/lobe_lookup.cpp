#include "render/lobe_lookup.h"

#include "brdf/frame.h"

namespace lobe {

Rgb LobeLookup::Read(const NodeLobes& lobes, LobePart part, const Mesh::Location& where, const Vec3& wo,
                     float* basis) const {
  if (where.element == kNone) return Rgb::Zero();
  const Mesh& mesh = solution_.mesh;
  const NodeWeights w = Interpolate(mesh, solution_.hidden, where);
  if (w.count == 0) return Rgb::Zero();
  const bool diffuse = lobes.degrees(w.node[0]).diffuse();
  const bool planar = mesh.patches[mesh.element_patch[where.element]].planar;  // one frame serves all
  Rgb out = Rgb::Zero();
  for (int k = 0; k < w.count; ++k) {
    const uint32_t node = w.node[k];
    out += w.weight[k] * (diffuse ? lobes.Radiance(node, Vec3::UnitZ(), basis, part)
                          : planar && k > 0
                              ? lobes.RadianceFromBasis(node, basis, part)
                              : lobes.Radiance(node, Frame(mesh.node_normal[node]).ToLocal(wo), basis, part));
  }
  return out;
}

}  // namespace lobe
