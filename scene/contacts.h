#pragma once

#include <cstddef>

#include "scene/scene.h"

namespace lobe {

struct ContactOptions {
  /// Edges nearer to a face than this leave their line on it, metres; 0: nothing is cut. More bridges larger
  /// gaps (a frame off a wall), less tells apart finer detail. At most a thousandth of the scene's diagonal
  /// is used, and at least a few rounding errors of its coordinates, so that what is meant to touch does.
  /// (chosen)
  float distance = 0.002f;
  /// Lines on one face. Beyond it small bends are straightened, up to a hundredth of the face's longest edge;
  /// then the longest lines are kept, and the scene warns. Time of a face grows with its square. (chosen)
  int max_lines = 1000;
};

struct ContactReport {
  size_t lines = 0;      ///< pieces of contact line that were cut along, straight ones merged, over all faces
  size_t faces_cut = 0;  ///< faces of the given scene that are no longer whole
  size_t pieces = 0;     ///< what has become of them
  size_t crowded_faces = 0;  ///< faces that lost lines to max_lines
};

/// Cuts faces along the lines where other faces touch or pierce them (discontinuity meshing of contacts:
/// Lischinski, Tampieri and Greenberg, IEEE CG&A 12(6), 1992, order D0), so that no element of a later mesh
/// lies on both sides of one. Light jumps there: a floor is dark under a box and lit beside it, a thin wall
/// stands between two rooms. The edges along such lines are marked in Face::contact, and nodes are not shared
/// across them.
///
/// A line is where another face passes through, or the outline of what lies within `distance` on a side of
/// the face that is seen. Surfaces that share the edge in question, as walls do in a room's corner, touch
/// without needing a cut. Pieces replace their face in place, in the same winding; faces that are not cut,
/// and scenes where nothing touches, come back bit for bit. New vertices lie on the old faces to rounding,
/// are equal wherever faces shared an edge (no T-junctions, no cracks), and have interpolated normals.
///
/// Faces whose border is not shared (two floors side by side with vertices of their own) are separate here as
/// in the tessellation. Where a line crosses from one curved face to the next, its two parts may miss each
/// other by distance times the angle between the faces.
///
/// O(n log n) in faces when each touches few others.
Scene CutAlongContacts(Scene scene, const ContactOptions& options = {}, ContactReport* report = nullptr);

}  // namespace lobe
