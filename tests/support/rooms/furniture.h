#pragma once

#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "tests/support/rooms/random_choice.h"
#include "tests/support/rooms/room_materials.h"
#include "tests/support/rooms/solid.h"
#include "tests/support/scene_builder.h"

namespace lobe::test {

/// Puts things into a room, as they stand in houses: on the floor, against a wall, one beside another, none
/// inside another. Metres; things measure 0.1 to 2.5.
class Furniture {
 public:
  /// `room`: the inside of its walls. All outlive this.
  Furniture(const Eigen::AlignedBox3f& room, RandomChoice* random, SceneBuilder* scene)
      : room_(room), random_(*random), scene_(*scene) {}

  /// Opaque things are of `roughness`.
  void AddThing(const RoughnessRange& roughness);
  void AddGlassBody();
  void AddPane();
  void AddMirror();

  /// Room that is taken by something else.
  void Take(const Eigen::AlignedBox3f& box) { taken_.push_back(box); }
  bool IsFree(const Eigen::AlignedBox3f& box) const;
  /// Words for what there is: shapes, models, gaps.
  const std::set<std::string>& features() const { return features_; }

 private:
  struct Part {
    Solid solid;
    uint32_t material;
    Shading shading = Shading::kFlat;
  };
  using Thing = std::vector<Part>;

  uint32_t Material(const DrawnReflectance& drawn, bool double_sided = false);
  uint32_t Opaque(const RoughnessRange& roughness);
  Shading DrawShading();
  int Sides();
  /// A round body: its shading, and if that is smooth and its gloss sharp, the word for it.
  Part Round(Solid solid, uint32_t material);
  Part Sheet(const std::vector<Vec3>& corners, uint32_t material) const;

  Thing MakeBall(uint32_t material);
  Thing MakeDrum(uint32_t material);
  Thing MakePipe(uint32_t material);
  Thing MakeTorus(uint32_t material);
  Thing MakeBevelledBox(uint32_t material);
  Thing MakeBoxes(uint32_t material);
  Thing MakeTable(const RoughnessRange& roughness);
  Thing MakeCabinet(const RoughnessRange& roughness);
  Thing MakeColumn(uint32_t material);
  Thing MakeScreen(uint32_t material);
  Thing MakeSheetOverFloor(uint32_t material);

  /// Somewhere on the floor, turned about y; not at all if there is no room for it.
  void Place(Thing thing);
  /// With its back, -z, to a wall, `gap` before it.
  void PlaceAtWall(Thing thing, float gap);
  bool TryAt(const Thing& thing, const Eigen::Affine3f& where);

  Eigen::AlignedBox3f room_;
  RandomChoice& random_;
  SceneBuilder& scene_;
  std::vector<Eigen::AlignedBox3f> taken_;
  std::set<std::string> features_, words_;  // words_: of the thing in hand
};

}  // namespace lobe::test
