#pragma once

#include <vector>

#include "scene/mesh.h"

namespace lobe {

/// Sets node_sample_position and node_sample_normal from elements, positions and normals alone, so that they
/// have the same bits whether the mesh was tessellated, refined, or read from a file.
///
/// A node inside a patch gathers light where it is; one on its border (on an edge of one element only) the
/// fraction `border_inset` of the way towards the mean of its elements' centroids, or on a curved surface,
/// which that way would leave, towards the centroid of the element that lies most in that direction.
void PlaceSamplePoints(Mesh* mesh, float border_inset);

/// Geometric normals at the nodes of one patch: unit means over their elements by area, counted from
/// node_begin; zero where they cancel out or have no area.
std::vector<Vec3d> MeanNormals(const Mesh& mesh, const Mesh::Patch& patch);

}  // namespace lobe
