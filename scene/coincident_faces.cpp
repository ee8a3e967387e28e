#include "scene/coincident_faces.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scene/contact_lines.h"
#include "scene/coplanar_faces.h"
#include "scene/flat_triangle.h"
#include "scene/plane_rule.h"
#include "scene/scene_cutter.h"

namespace lobe {

namespace {

class Coincidences {
 public:
  Coincidences(const Scene& scene, CoplanarFaces found)
      : scene_(scene), found_(std::move(found)), rule_(scene) {
    SettleRepeats();
    RelateOverlaps();
  }

  bool AllMayStay() const { return !changed_ && others_.empty(); }

  /// `scene` is the one that was looked at.
  void Resolve(Scene* scene) {
    if (others_.empty()) {
      for (uint32_t f = 0; f < scene_.faces.size(); ++f) Add(scene_.faces[f], f, rule_.shown(f), scene);
      Warn(scene);
    } else {
      Scene cut = CutAndChoose();
      Warn(&cut);
      *scene = std::move(cut);
    }
    scene->faces = std::move(faces_);
  }

 private:
  /// Of faces with the same corners the first stands for all.
  uint32_t First(uint32_t f) const { return found_.first.empty() ? f : found_.first[f]; }

  void SettleRepeats() {
    std::map<uint32_t, std::vector<uint32_t>> repeats;
    for (uint32_t f = 0; f < found_.first.size(); ++f) {
      if (found_.first[f] != f) repeats[found_.first[f]].push_back(f);
    }
    for (auto& [first, faces] : repeats) {
      faces.push_back(first);
      for (const PlaneRule::Choice& choice : rule_.Choose(faces)) {
        changed_ |= rule_.shown(choice.face) != choice.sides;
        rule_.Show(choice.face, choice.sides);
        if (choice.sides) same_[first].push_back(choice.face);
        Cover(choice);
      }
    }
  }

  void RelateOverlaps() {
    const auto left_of = [this](uint32_t first) {
      const auto found = same_.find(first);
      return found == same_.end() ? std::vector{first} : found->second;
    };
    for (const auto& [a, b] : found_.overlaps) {
      for (const uint32_t f : left_of(a)) {
        for (const uint32_t g : left_of(b)) {
          if (!rule_.Meet(f, g)) continue;
          // One that is not seen beside the other is nothing to it.
          const std::vector<PlaneRule::Choice> choices = rule_.Choose({f, g});
          others_[choices[1].face].push_back(choices[0].face);
          if (choices[1].sides) others_[choices[0].face].push_back(choices[1].face);
        }
      }
    }
  }

  /// The outline, on `f`, of the faces that are to be told from it.
  std::vector<ContactLine> OutlineOn(uint32_t f, double snap) {
    using Place = std::array<float, 3>;
    struct Use {
      Vec3d a, b, opposite;
      uint32_t face;
    };
    std::map<std::pair<Place, Place>, std::vector<Use>> edges;
    for (const uint32_t g : others_[f]) {
      const auto p = scene_.Corners(scene_.faces[g]);
      for (int k = 0; k < 3; ++k) {
        const auto place = [&](int i) {
          const Vec3& at = p[(k + i) % 3];
          return Place{at.x() + 0.0f, at.y() + 0.0f, at.z() + 0.0f};  // -0 is 0
        };
        const auto at = [&](int i) -> Vec3d { return p[(k + i) % 3].cast<double>(); };
        edges[std::minmax(place(0), place(1))].push_back({at(0), at(1), at(2), g});
      }
    }
    const FlatTriangle flat(scene_.Corners(scene_.faces[f]));
    std::vector<ContactLine> lines;
    for (const auto& [place, uses] : edges) {
      const Vec3d &a = uses[0].a, &b = uses[0].b;
      if (uses.size() == 2) {
        // Inside a surface there is nothing to be told apart.
        const Face &one = scene_.faces[uses[0].face], &other = scene_.faces[uses[1].face];
        const Vec3d across = flat.normal.cross(b - a);
        const bool apart = (across.dot(uses[0].opposite - a) > 0) != (across.dot(uses[1].opposite - a) > 0);
        if (apart && one.material == other.material && one.surface == other.surface &&
            !rule_.Opposite(uses[0].face, uses[1].face)) {
          continue;
        }
      }
      double t0 = 0, t1 = 1;
      if (flat.ClipSegment(a, b, snap, &t0, &t1)) lines.push_back({a + t0 * (b - a), a + t1 * (b - a)});
    }
    return lines;
  }

  /// Cuts faces along the outlines of others, and chooses among the pieces. Returns the scene that `faces_`
  /// are of.
  Scene CutAndChoose() {
    Scene left = scene_;
    left.faces.clear();
    std::vector<uint32_t> origin;  // in scene_
    for (uint32_t f = 0; f < scene_.faces.size(); ++f) {
      if (rule_.shown(f) == kNoSide) continue;
      left.faces.push_back(scene_.faces[f]);
      origin.push_back(f);
    }
    // A hundred round lamps in one ceiling. Time of a face grows with the square. (chosen)
    constexpr size_t kMostLines = 4000;
    const ContactReach reach = ReachIn(scene_, 0);
    SceneCutter cutter(std::move(left), reach, kMostLines);
    std::vector<std::vector<ContactLine>> lines(cutter.sheets().size());
    for (size_t i = 0; i < lines.size(); ++i) {
      for (const uint32_t face : cutter.sheets()[i]) {
        if (!others_.contains(origin[face])) continue;
        const std::vector<ContactLine> outline = OutlineOn(origin[face], reach.snap);
        lines[i].insert(lines[i].end(), outline.begin(), outline.end());
      }
    }
    const bool is_cut = cutter.Cut(std::move(lines));
    if (is_cut) cutter.Rebuild();
    left = cutter.Take();
    if (const size_t crowded = cutter.crowded()) {
      left.warnings.push_back(std::to_string(crowded) + (crowded == 1 ? " face is" : " faces are") +
                              " overlapped by too many others in one plane: cut only along the longest " +
                              std::to_string(kMostLines) + " lines of their outlines");
    }
    for (size_t i = 0; i < left.faces.size(); ++i) {
      ChoosePiece(origin[is_cut ? cutter.origins()[i] : i], left.faces[i], &left);
    }
    return left;
  }

  /// Adds a piece of face `f` as far as it is seen.
  void ChoosePiece(uint32_t f, Face piece, Scene* scene) {
    const auto found = others_.find(f);
    if (found == others_.end()) return Add(piece, f, rule_.shown(f), scene);
    piece.contact = 0;  // what was cut here is no line of contact
    const std::array<Vec3, 3> p = scene->Corners(piece);
    const Vec3d centre = (p[0].cast<double>() + p[1].cast<double>() + p[2].cast<double>()) / 3;
    std::vector<uint32_t> stack = {f};
    for (const uint32_t g : found->second) {
      const double tolerance = CoplanarTolerance(scene_, scene_.faces[f], scene_.faces[g]);
      if (FlatTriangle(scene_.Corners(scene_.faces[g])).LiesUnder(centre, tolerance)) stack.push_back(g);
    }
    if (const auto same = same_.find(First(f)); same != same_.end()) {
      std::copy_if(same->second.begin(), same->second.end(), std::back_inserter(stack),
                   [f](uint32_t g) { return g != f; });
    }
    const std::vector<PlaneRule::Choice> choices = rule_.Choose(stack);
    const auto own =
        std::find_if(choices.begin(), choices.end(), [f](const PlaneRule::Choice& c) { return c.face == f; });
    Cover(*own);
    if (!own->sides) return;
    // Who else is seen here is seen from the other side. The first of the two lends the other its corners,
    // unless they are the same.
    const auto behind = std::find_if(choices.begin(), choices.end(), [&](const PlaneRule::Choice& c) {
      return c.sides && First(c.face) != First(f);
    });
    if (behind < own) return;
    Add(piece, f, own->sides, scene);
    if (behind != choices.end()) AddBehind(behind->face, behind->sides, scene);
  }

  void Add(Face piece, uint32_t f, Sides sides, Scene* scene) {
    if (sides == kNoSide) return;
    piece.material = MaterialOf(f, sides, scene);
    if (sides == kBackSide) std::swap(piece.vertex[1], piece.vertex[2]);
    faces_.push_back(piece);
  }

  /// Adds a piece of `f` with the corners of the last one, to be seen from the other side.
  void AddBehind(uint32_t f, Sides sides, Scene* scene) {
    const Face front = faces_.back(), &whole = scene_.faces[f];
    const FlatTriangle flat(scene_.Corners(whole));
    Face piece = whole;
    piece.material = MaterialOf(f, sides, scene);
    for (int k = 0; k < 3; ++k) {
      const Vec3 at = scene->positions[front.vertex[(3 - k) % 3]];
      Vec3d normal = Vec3d::Zero();
      for (int corner = 0; corner < 3; ++corner) {
        // A corner's weight grows linearly from the edge across.
        const int edge = (corner + 1) % 3;
        const double weight = flat.Inside(edge, at.cast<double>()) / flat.Inside(edge, flat.corner[corner]);
        normal += weight * scene_.CornerNormal(whole, corner).cast<double>();
      }
      piece.vertex[k] = static_cast<uint32_t>(scene->positions.size());
      scene->positions.push_back(at);
      scene->normals.push_back(normal.normalized().cast<float>());
    }
    faces_.push_back(piece);
  }

  /// Of a face that is seen from so many sides; a double-sided one may have lost one of them.
  uint32_t MaterialOf(uint32_t f, Sides sides, Scene* scene) {
    const uint32_t material = scene_.faces[f].material;
    if (sides == SidesOf(scene_.materials[material])) return material;
    const auto [copy, is_new] = single_sided_.try_emplace(material);
    if (is_new) {
      copy->second = static_cast<uint32_t>(scene->materials.size());
      Material single = scene->materials[material];
      single.double_sided = false;
      scene->materials.push_back(std::move(single));
    }
    return copy->second;
  }

  void Cover(const PlaneRule::Choice& choice) {
    if (!choice.under.empty()) under_[choice.face].insert(choice.under.begin(), choice.under.end());
  }

  /// Is it worth a word that `g` is seen instead of `f`? Not for flush faces of one material, nor for a sheet
  /// that is modelled from both sides.
  bool IsTold(uint32_t f, uint32_t g, const std::vector<bool>& surface_left) const {
    const Face &a = scene_.faces[f], &b = scene_.faces[g];
    if (a.material == b.material && a.surface == b.surface && rule_.Opposite(f, g)) return false;
    return a.material != b.material || scene_.material(a).emits() || First(f) == First(g) ||
           !surface_left[a.surface];
  }

  void Warn(Scene* scene) const {
    std::vector<bool> surface_left(scene_.surface_names.size());
    for (const Face& face : faces_) surface_left[face.surface] = true;
    std::map<std::pair<uint32_t, uint32_t>, std::set<uint32_t>> told;  // faces by surface, and that over it
    for (const auto& [f, seen] : under_) {
      for (const uint32_t g : seen) {
        if (IsTold(f, g, surface_left)) told[{scene_.faces[f].surface, scene_.faces[g].surface}].insert(f);
      }
    }
    if (told.empty()) return;
    constexpr size_t kNamed = 3;
    std::string pairs;
    size_t named = 0;
    for (const auto& [surfaces, faces] : told) {
      if (named++ == kNamed) break;
      pairs += (pairs.empty() ? "'" : ", '") + scene_.surface_names[surfaces.first] + "' lies where '" +
               scene_.surface_names[surfaces.second] + "' does (" + std::to_string(faces.size()) +
               (faces.size() == 1 ? " triangle)" : " triangles)");
    }
    if (const size_t rest = told.size() - std::min(told.size(), kNamed)) {
      pairs += ", and " + std::to_string(rest) + (rest == 1 ? " more pair" : " more pairs");
    }
    scene->warnings.push_back("surfaces in one plane: " + pairs +
                              "; only the emitter is seen there, else the later in the file: move them apart "
                              "or leave one out");
  }

  const Scene& scene_;
  const CoplanarFaces found_;
  PlaneRule rule_;
  bool changed_ = false;                              // a face that repeats another is not seen as it was
  std::map<uint32_t, std::vector<uint32_t>> same_;    // what is left of faces that repeat the first
  std::map<uint32_t, std::vector<uint32_t>> others_;  // that are seen in its place, or on its other side
  std::map<uint32_t, std::set<uint32_t>> under_;      // faces that are seen in its place
  std::map<uint32_t, uint32_t> single_sided_;         // copies of materials
  std::vector<Face> faces_;                           // as they are to be
};

}  // namespace

void ResolveCoincidentFaces(Scene* scene) {
  CoplanarFaces found = FindCoplanarFaces(*scene);
  if (found.none()) return;
  Coincidences coincidences(*scene, std::move(found));
  if (!coincidences.AllMayStay()) coincidences.Resolve(scene);
}

}  // namespace lobe
