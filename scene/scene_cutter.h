#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/contact_lines.h"
#include "scene/edge_table.h"
#include "scene/scene.h"
#include "scene/triangle_cutter.h"

namespace lobe {

/// Cuts faces of a scene along given lines. Pieces replace their face in place, in the same winding; faces
/// that are not cut stay as they are. New vertices lie on the old faces to rounding, are equal wherever faces
/// shared an edge (no T-junctions, no cracks), and have interpolated normals.
///
///     SceneCutter cutter(std::move(scene), reach, 1000);
///     if (cutter.Cut(LinesBySheet(cutter.scene(), cutter.sheets()))) cutter.Rebuild();
///     scene = cutter.Take();
class SceneCutter {
 public:
  /// Of one face more lines than `max_lines` are straightened, and then the longest are kept.
  SceneCutter(Scene scene, const ContactReach& reach, size_t max_lines);

  const Scene& scene() const { return scene_; }
  const EdgeTable& edges() const { return edges_; }
  const ContactReach& reach() const { return reach_; }

  /// Faces that repeat each other's corners, ascending; most sheets are one face. They are cut alike, or rays
  /// would no longer find them together; lines are those of the first. Faces without area are in no sheet.
  const std::vector<std::vector<uint32_t>>& sheets() const { return sheets_; }

  /// Finds the cuts along `lines`, given by sheet, each on the sheet's first face. False: there are none.
  bool Cut(std::vector<std::vector<ContactLine>> lines);
  /// Puts the pieces of every cut face in its place. Their edges along lines are marked in Face::contact.
  void Rebuild();
  Scene Take() { return std::move(scene_); }

  size_t lines() const { return line_count_; }  ///< cut along, straight ones merged
  size_t crowded() const { return crowded_; }   ///< faces that lost lines to `max_lines`
  /// After Rebuild: the face of the given scene that each face was, or is a piece of.
  const std::vector<uint32_t>& origins() const { return origins_; }

 private:
  /// What is to become of an edge, for all faces at it. Places along it are measured from its lower end,
  /// 0..1.
  struct EdgeCut {
    std::vector<double> wanted;                     // vertices
    std::vector<std::pair<double, double>> marked;  // parts that are lines
    std::vector<Vec3> points;                       // settled: in order
    std::vector<uint8_t> on_line;                   // of the parts between them
  };

  Vec3d At(uint32_t place) const { return edges_.position(place).cast<double>(); }
  uint32_t Place(uint32_t face, int k) const { return edges_.place(scene_.faces[face].vertex[k % 3]); }
  bool IsSmooth(uint32_t f, int k) const;
  double AlongEdge(uint32_t edge, const Vec3d& p) const;
  void Prepare(size_t sheet);
  void MarkEdge(uint32_t edge, const ContactLine& line);
  void Settle(uint32_t edge, EdgeCut* cut) const;
  void CutSheets();
  TriangleCutter CutSheet(size_t sheet) const;
  void AppendPieces(uint32_t f, uint32_t first, const TriangleCutter& cutter, std::vector<Face>* faces);

  Scene scene_;
  ContactReach reach_;
  size_t max_lines_;
  EdgeTable edges_;
  std::vector<std::vector<uint32_t>> sheets_;
  std::vector<std::vector<ContactLine>> lines_;  // by sheet
  std::map<uint32_t, EdgeCut> edge_cuts_;
  std::map<size_t, std::optional<TriangleCutter>> cut_;                             // by sheet
  std::map<std::tuple<uint32_t, uint32_t, float, float, float>, uint32_t> shared_;  // new vertices on edges
  std::vector<uint32_t> origins_;
  size_t line_count_ = 0, crowded_ = 0;
};

}  // namespace lobe
