#pragma once

#include <vector>

#include "brdf/material_lobes.h"
#include "scene/mesh.h"
#include "solver/exposure.h"

namespace lobe {

/// An ideal opaque mirror that lies in one plane: a lamp seen in it is a lamp behind it, which shadow rays
/// can aim at. Links would have to meet the lamp's picture by chance.
struct PlanarMirror {
  uint32_t patch;
  Vec3 point, normal;  ///< of the plane, on the mirror's side
  /// Faces of emitters smaller than this, square metres, are shot by way of the mirror. Of larger ones it
  /// shows only a part, which links find better.
  float largest_emitter;

  Vec3 Image(const Vec3& at) const { return at - 2 * normal.dot(at - point) * normal; }
};

/// The planar mirrors of a mesh, largest first, as many as keep images of emitters below kMostImages: every
/// receiver looks at each of them. The others' emission stays with the links.
std::vector<PlanarMirror> FindPlanarMirrors(const Mesh& mesh, const std::vector<MaterialLobes>& materials,
                                            const std::vector<Emitter>& emitters);
inline constexpr size_t kMostImages = 1024;

}  // namespace lobe
