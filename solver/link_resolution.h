#pragma once

#include <vector>

#include "brdf/material_lobes.h"
#include "scene/mesh.h"

namespace lobe {

/// How finely links resolve the lobes they read, as a limit on the degree of what a node sends.
///
/// Lobes of K coefficients that are read through M links a node, in directions spread by chance, send on
/// average the energy they have. But some of the fields of such lobes are read where they are largest: they
/// send (1 + sqrt(K / M))^2 times their energy (the largest eigenvalue of the Gram matrix of M random samples
/// of K orthonormal functions: Marchenko and Pastur, Math. USSR Sbornik 1, 1967; finer meshes on either side
/// do not change the ratio, since light that comes back has at most the freedom of the coarser side). Links
/// are traced once, so light in such fields between facing bright walls would grow without end. Reflection
/// multiplies the norm of a lobe (L2 under the cosine) by at most the albedo a. So no loop of reflections
/// grows if
///   a (1 + sqrt(K / M)) <= (1 + a) / 2,
/// which is what limits K here; the other half of the distance from a to 1 is left for what the model
/// neglects: links and nodes are not all alike, and a facet's normal is not the shading normal. That bound is
/// for the worst field. 40 links for each coefficient, a gain of 1.16, are enough for any albedo in practice;
/// where they are not, PlanSweep lowers the degree further. docs/validation.md#link-resolution;
/// LinkResolutionTest measures the growth.
int ResolvedDegree(const MaterialLobes& material, int links);

/// Per patch, the highest degree that its nodes send in a step through so many `links` (Links::Options), not
/// above `cap`.
///
/// The first step sends all that emission has brought, once: nothing can grow, and it is most of the light.
/// Its degree is limited by `cap` alone.
std::vector<int> SentDegrees(const Mesh& mesh, const std::vector<MaterialLobes>& materials, int links,
                             int step, int cap);

}  // namespace lobe
