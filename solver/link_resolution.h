#pragma once

#include <cstdint>
#include <vector>

#include "brdf/material_lobes.h"
#include "scene/mesh.h"
#include "solver/links.h"

namespace lobe {

/// How finely links resolve the lobes they read, as a limit on the degree of what each node sends.
///
/// A lobe of K coefficients that is read N times, in directions spread by chance, sends on average the energy
/// it has. But one lobe of that K-dimensional space is read where it is largest: it sends
/// (1 + sqrt(K / N))^2 times its energy (the largest eigenvalue of the Gram matrix of N random samples of K
/// orthonormal functions: Marchenko and Pastur, Math. USSR Sbornik 1, 1967). Links are traced once, so light
/// in such lobes of facing bright walls would grow without end. Reflection multiplies the norm of a lobe
/// (L2 under the cosine) by at most the albedo a. So no loop of reflections grows if
///   a (1 + sqrt(K / N)) <= (1 + a) / 2,
/// which is what limits K here; the other half of the distance from a to 1 is left for what the model
/// neglects: nodes have more or fewer reads than those around them, and a facet's normal is not the shading
/// normal. That bound is for the one worst loop. 40 reads for each coefficient, a gain of 1.16, are enough
/// for any albedo in practice; where they are not, PlanSweep lowers the degree further.
/// docs/validation.md#link-resolution; LinkResolutionTest measures the growth.
class LinkResolution {
 public:
  LinkResolution() = default;
  /// `node_area`: 0 for hidden nodes.
  LinkResolution(const Mesh& mesh, const Links& links, const std::vector<MaterialLobes>& materials,
                 const std::vector<double>& node_area);

  /// Per node: the highest degree that links resolve, and not above `cap`. Empty if no node sends less than
  /// it has.
  ///
  /// The first step sends all that emission has brought, once: nothing can grow, and it is most of the light.
  /// Its degree is limited by `cap` alone.
  std::vector<uint8_t> Degrees(int step, int cap) const;

 private:
  std::vector<uint8_t> resolved_;  // per node; empty where all materials are diffuse
};

}  // namespace lobe
