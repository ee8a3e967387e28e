#include "tests/support/rooms/furniture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe::test {
namespace {

using Box3 = Eigen::AlignedBox3f;
using Eigen::Affine3f, Eigen::AngleAxisf, Eigen::Translation3f;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kSharp = 0.3f;  // README: gloss of roughness 0.3 and less is sharp
constexpr int kTries = 40;      // to find room for a thing

Affine3f Upright(const Vec3& at, float angle) { return Translation3f(at) * AngleAxisf(angle, Vec3::UnitY()); }

}  // namespace

bool Furniture::IsFree(const Box3& box) const {
  return std::none_of(taken_.begin(), taken_.end(), [&](const Box3& other) { return other.intersects(box); });
}

uint32_t Furniture::Material(const DrawnReflectance& drawn, bool double_sided) {
  words_.insert(drawn.model);
  return scene_.AddMaterial(drawn.model, drawn.reflectance, Rgb::Zero(), double_sided);
}

uint32_t Furniture::Opaque(const RoughnessRange& roughness) {
  return Material(DrawReflectance(random_, roughness, DrawAlbedo(random_)));
}

Shading Furniture::DrawShading() {
  if (random_.Chance(0.35f)) return Shading::kFlat;
  return random_.Chance(0.8f) ? Shading::kSmooth : Shading::kSmoothByArea;
}

int Furniture::Sides() {
  static constexpr int kSides[] = {8, 12, 16, 16, 24, 32, 32, 48};
  return random_.Of(kSides);
}

Furniture::Part Furniture::Round(Solid solid, uint32_t material) {
  const Shading shading = DrawShading();
  const bool sharp = RoughnessOf(scene_.material(material).reflectance) < kSharp;
  if (shading != Shading::kFlat) words_.insert(sharp ? "smooth sharp" : "smooth");
  return {std::move(solid), material, shading};
}

Furniture::Part Furniture::Sheet(const std::vector<Vec3>& corners, uint32_t material) const {
  Part part{{}, material};
  part.solid.AddPolygon(corners);
  return part;
}

Furniture::Thing Furniture::MakeBall(uint32_t material) {
  words_.insert("ball");
  const float radius = random_.Between(0.15f, 0.6f);
  const int sides = Sides();
  Solid ball = random_.Chance(0.3f) ? Icosphere(radius, random_.Whole(1, 3)) : Ball(radius, sides, sides / 2);
  // Standing, or held a little above the floor.
  const float gap = random_.Chance(0.3f) ? random_.LogBetween(0.005f, 0.1f) : 0;
  if (gap > 0) words_.insert("gap");
  ball.Move(Affine3f(Translation3f(0, gap - ball.Bounds().min().y(), 0)));
  return {Round(std::move(ball), material)};
}

Furniture::Thing Furniture::MakeDrum(uint32_t material) {
  words_.insert("cylinder");
  const float radius = random_.Between(0.15f, 0.5f), height = random_.Between(0.3f, 1.3f);
  const bool caps_apart = random_.Chance(0.8f);
  return {Round(Cylinder(radius, height, Sides(), caps_apart), material)};
}

Furniture::Thing Furniture::MakePipe(uint32_t material) {
  words_.insert("cylinder");
  const float radius = random_.Between(0.05f, 0.3f), length = random_.Between(0.5f, 1.8f);
  Solid pipe = Cylinder(radius, length, Sides());
  pipe.Move(Affine3f(AngleAxisf(kPi / 2, Vec3::UnitX())));
  pipe.Move(Affine3f(
      Translation3f(-pipe.Bounds().center().x(), -pipe.Bounds().min().y(), -pipe.Bounds().center().z())));
  return {Round(std::move(pipe), material)};
}

Furniture::Thing Furniture::MakeTorus(uint32_t material) {
  words_.insert("torus");
  const float major = random_.Between(0.25f, 0.6f), minor = major * random_.Between(0.15f, 0.5f);
  static constexpr int kMinorSides[] = {8, 12, 16};
  const int minor_sides = random_.Of(kMinorSides);
  Solid torus = Torus(major, minor, std::max(12, Sides()), minor_sides);
  if (random_.Chance(0.4f)) torus.Move(Affine3f(AngleAxisf(kPi / 2, Vec3::UnitX())));
  torus.Move(Affine3f(Translation3f(0, -torus.Bounds().min().y(), 0)));
  return {Round(std::move(torus), material)};
}

Furniture::Thing Furniture::MakeBevelledBox(uint32_t material) {
  words_.insert("bevel");
  const Vec3 size{random_.Between(0.3f, 1.2f), random_.Between(0.3f, 1.5f), random_.Between(0.3f, 1)};
  const float bevel = size.minCoeff() * random_.LogBetween(0.02f, 0.3f);
  return {Round(BevelledBox({-size.x() / 2, 0, -size.z() / 2}, {size.x() / 2, size.y(), size.z() / 2}, bevel,
                            random_.Whole(1, 4)),
                material)};
}

// One, or two with a slot between them.
Furniture::Thing Furniture::MakeBoxes(uint32_t material) {
  words_.insert("box");
  const Vec3 size{random_.Between(0.3f, 0.8f), random_.Between(0.3f, 1.6f), random_.Between(0.3f, 0.8f)};
  Part first{Box({-size.x(), 0, -size.z() / 2}, {0, size.y(), size.z() / 2}), material};
  // A cube that somebody shaded smooth.
  if (random_.Chance(0.15f)) {
    words_.insert("smooth cube");
    first.shading = Shading::kSmooth;
  }
  Thing thing{first};
  if (random_.Chance(0.5f)) {
    words_.insert("gap");
    const float slot = random_.LogBetween(0.005f, 0.1f);
    thing.push_back(
        {Box({slot, 0, -size.z() / 2}, {slot + size.x(), size.y() * random_.Between(0.5f, 1), size.z() / 2}),
         material});
  }
  return thing;
}

Furniture::Thing Furniture::MakeTable(const RoughnessRange& roughness) {
  words_.insert("table");
  const float x = random_.Between(0.35f, 0.9f), z = random_.Between(0.3f, 0.5f), y = random_.Between(0.4f, 1);
  const float leg = random_.Between(0.02f, 0.06f), board = random_.Between(0.02f, 0.06f);
  const uint32_t top = Opaque(roughness), metal = Opaque(roughness);
  Thing thing{{Box({-x, y, -z}, {x, y + board, z}), top}};
  const int sides = Sides();
  const Part round = Round(Cylinder(leg, y, std::min(sides, 16)), metal);
  for (const float sx : {-1.0f, 1.0f}) {
    for (const float sz : {-1.0f, 1.0f}) {
      Part part = round;
      part.solid.Move(Affine3f(Translation3f(sx * (x - 1.5f * leg), 0, sz * (z - 1.5f * leg))));
      thing.push_back(std::move(part));
    }
  }
  return thing;
}

// Panels of one thickness around shelves, with or without doors. Panels touch.
Furniture::Thing Furniture::MakeCabinet(const RoughnessRange& roughness) {
  words_.insert("cabinet");
  const float x = random_.Between(0.3f, 0.8f), y = random_.Between(0.6f, 2), z = random_.Between(0.3f, 0.5f);
  const float t = random_.Between(0.016f, 0.04f);
  const uint32_t wood = Opaque(roughness);
  const auto panel = [&](const Vec3& min, const Vec3& max, uint32_t material) {
    return Part{Box(min, max), material};
  };
  Thing thing{panel({-x, 0, -z / 2}, {t - x, y, z / 2}, wood), panel({x - t, 0, -z / 2}, {x, y, z / 2}, wood),
              panel({t - x, 0, -z / 2}, {x - t, y, t - z / 2}, wood)};
  const int boards = random_.Whole(2, 5);  // bottom, top, shelves
  for (int i = 0; i < boards; ++i) {
    const float at = (y - t) * static_cast<float>(i) / static_cast<float>(boards - 1);
    thing.push_back(panel({t - x, at, t - z / 2}, {x - t, at + t, z / 2}, wood));
  }
  if (random_.Chance(0.4f)) {
    words_.insert("gap");
    const uint32_t door = Opaque(roughness);
    const float slot = random_.LogBetween(0.003f, 0.02f);
    for (const float side : {-1.0f, 1.0f}) {
      const float a = side * slot / 2, b = side * x;
      thing.push_back(
          panel({std::min(a, b), 0.01f, z / 2 + slot / 2}, {std::max(a, b), y, z / 2 + slot / 2 + t}, door));
    }
  }
  return thing;
}

Furniture::Thing Furniture::MakeColumn(uint32_t material) {
  words_.insert("column");
  const float radius = random_.Between(0.08f, 0.35f);
  return {Round(Cylinder(radius, room_.sizes().y(), Sides()), material)};
}

Furniture::Thing Furniture::MakeScreen(uint32_t material) {
  words_.insert("sheet");
  const float x = random_.Between(0.3f, 1), y = random_.Between(0.6f, 2);
  const float foot = random_.Chance(0.5f) ? random_.LogBetween(0.005f, 0.1f) : 0;
  if (foot > 0) words_.insert("gap");
  return {Sheet({{-x, foot, 0}, {x, foot, 0}, {x, y, 0}, {-x, y, 0}}, material)};
}

Furniture::Thing Furniture::MakeSheetOverFloor(uint32_t material) {
  words_.insert("sheet over floor");
  const float x = random_.Between(0.3f, 1.2f), z = random_.Between(0.3f, 1.2f),
              y = random_.LogBetween(0.02f, 0.5f);
  return {Sheet({{-x, y, -z}, {-x, y, z}, {x, y, z}, {x, y, -z}}, material)};
}

bool Furniture::TryAt(const Thing& thing, const Affine3f& where) {
  Box3 bounds;
  Thing moved = thing;
  for (Part& part : moved) {
    part.solid.Move(where);
    bounds.extend(part.solid.Bounds());
  }
  constexpr float kApart = 0.03f;
  const Box3 grown(bounds.min() - Vec3(kApart, 0, kApart), bounds.max() + Vec3(kApart, 0, kApart));
  Box3 inside = room_;  // rounding must not forbid a column
  inside.min().y() -= kApart, inside.max().y() += kApart;
  if (!inside.contains(bounds) || !IsFree(grown)) return false;
  Take(grown);
  features_.merge(words_);
  for (const Part& part : moved) part.solid.AddTo(&scene_, part.material, part.shading);
  return true;
}

void Furniture::Place(Thing thing) {
  for (int i = 0; i < kTries; ++i) {
    const float angle = random_.Chance(0.5f) ? kPi / 2 * static_cast<float>(random_.Whole(0, 3))
                                             : random_.Between(0, 2 * kPi);
    const Vec3 at{random_.Between(room_.min().x(), room_.max().x()), 0,
                  random_.Between(room_.min().z(), room_.max().z())};
    if (TryAt(thing, Upright(at, angle))) return;
  }
}

void Furniture::PlaceAtWall(Thing thing, float gap) {
  Box3 bounds;
  for (const Part& part : thing) bounds.extend(part.solid.Bounds());
  for (int i = 0; i < kTries; ++i) {
    const int wall = random_.Whole(0, 3);
    const bool along_x = wall % 2 == 0;
    const float half = (along_x ? room_.sizes().z() : room_.sizes().x()) / 2;
    const float width = (along_x ? room_.sizes().x() : room_.sizes().z()) / 2;
    const Vec3 at(random_.Between(-width, width), 0, -half + gap - bounds.min().z());
    if (TryAt(thing, AngleAxisf(kPi / 2 * static_cast<float>(wall), Vec3::UnitY()) * Translation3f(at)))
      return;
  }
}

void Furniture::AddThing(const RoughnessRange& roughness) {
  words_.clear();
  switch (random_.Whole(0, 11)) {
    case 0:
    case 1:
      return Place(MakeBall(Opaque(roughness)));
    case 2:
      return Place(MakeDrum(Opaque(roughness)));
    case 3:
      return Place(MakePipe(Opaque(roughness)));
    case 4:
      return Place(MakeTorus(Opaque(roughness)));
    case 5:
      return Place(MakeBevelledBox(Opaque(roughness)));
    case 6:
      return Place(MakeBoxes(Opaque(roughness)));
    case 7:
      return Place(MakeTable(roughness));
    case 8: {
      const float gap = random_.Chance(0.5f) ? 0 : random_.LogBetween(0.005f, 0.05f);
      return PlaceAtWall(MakeCabinet(roughness), gap);
    }
    case 9:
      return Place(MakeColumn(Opaque(roughness)));
    case 10:
      return Place(MakeScreen(
          random_.Chance(0.5f) ? Material(DrawTranslucent(random_, DrawAlbedo(random_)), true)
                               : Material(DrawReflectance(random_, roughness, DrawAlbedo(random_)), true)));
    default:
      return Place(MakeSheetOverFloor(Material(random_.Chance(0.25f)
                                                   ? DrawTranslucent(random_, DrawAlbedo(random_))
                                                   : DrawReflectance(random_, roughness, DrawAlbedo(random_)),
                                               true)));
  }
}

void Furniture::AddGlassBody() {
  words_.clear();
  const uint32_t glass = Material(DrawGlass(random_, true));
  Part part;
  if (random_.Chance(0.5f)) {
    const float radius = random_.Between(0.15f, 0.4f);
    part = {Ball(radius, 32, 16), glass, Shading::kSmooth};
  } else {
    part = {Box({-0.2f, 0, -0.2f}, {0.2f, random_.Between(0.3f, 0.8f), 0.2f}), glass};
  }
  // Bodies of glass do not touch: what lies between them and the floor is air.
  part.solid.Move(Affine3f(Translation3f(0, 0.01f - part.solid.Bounds().min().y(), 0)));
  Place({part});
}

void Furniture::AddPane() {
  words_.clear();
  const uint32_t pane = Material(DrawGlass(random_, false), true);
  const float x = random_.Between(0.4f, 1.2f), y = random_.Between(1, 2);
  Place({Sheet({{-x, 0.02f, 0}, {x, 0.02f, 0}, {x, y, 0}, {-x, y, 0}}, pane)});
}

void Furniture::AddMirror() {
  words_.clear();
  DrawnReflectance mirror = DrawMetal(random_, {0, 0}, random_.Between(0.7f, 0.95f));
  mirror.model = "mirror";
  const uint32_t material = Material(mirror);
  const float x = random_.Between(0.2f, 0.8f), low = random_.Between(0.2f, 0.8f),
              high = low + random_.Between(0.5f, 1.2f);
  PlaceAtWall({Sheet({{-x, low, 0}, {x, low, 0}, {x, high, 0}, {-x, high, 0}}, material)}, 0.01f);
}

}  // namespace lobe::test
