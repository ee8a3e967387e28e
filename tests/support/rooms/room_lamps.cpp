#include "tests/support/rooms/room_lamps.h"

#include <cmath>
#include <numbers>

namespace lobe::test {
namespace {

using Box3 = Eigen::AlignedBox3f;
using Eigen::Affine3f, Eigen::AngleAxisf, Eigen::Translation3f;

constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace

uint32_t RoomLamps::Glow(float power, float area) {
  const Rgb colour = random_.Chance(0.2f) ? DrawColour(random_, 1)
                                          : Rgb{1, random_.Between(0.8f, 1), random_.Between(0.6f, 1)};
  return scene_.AddMaterial("lamp", Lambert{Rgb::Zero()}, colour * (power / (kPi * area)));
}

bool RoomLamps::FindPlace(const Vec3& size, float bottom, Vec3* centre) {
  constexpr float kFromWall = 0.1f;
  for (int i = 0; i < 40; ++i) {
    const Vec3 half = size / 2;
    const Vec3 room_half = room_.sizes() / 2;
    const float x = room_half.x() - half.x() - kFromWall, z = room_half.z() - half.z() - kFromWall;
    if (x <= 0 || z <= 0) return false;
    *centre = Vec3{random_.Between(-x, x), bottom + half.y(), random_.Between(-z, z)};
    const Box3 box(*centre - half - Vec3(0.05f, 0, 0.05f), *centre + half + Vec3(0.05f, 0, 0.05f));
    if (!furniture_.IsFree(box)) continue;
    furniture_.Take(box);
    return true;
  }
  return false;
}

bool RoomLamps::HangPanel(float power) {
  const float x = random_.Between(0.2f, 0.8f), z = random_.Between(0.2f, 0.8f),
              y = random_.LogBetween(0.005f, 0.05f);
  Vec3 at;
  if (!FindPlace({2 * x, y, 2 * z}, room_.max().y() - y, &at)) return false;
  features_.insert("panel");
  const float bottom = room_.max().y() - y;
  scene_.AddQuad({at.x() - x, bottom, at.z() - z}, {at.x() + x, bottom, at.z() - z},
                 {at.x() + x, bottom, at.z() + z}, {at.x() - x, bottom, at.z() + z}, Glow(power, 4 * x * z));
  return true;
}

bool RoomLamps::HangFixture(float power) {
  const float x = random_.Between(0.15f, 0.6f), z = random_.Between(0.1f, 0.4f),
              height = random_.Between(0.04f, 0.1f);
  Vec3 at;
  const float top = room_.max().y() - (random_.Chance(0.5f) ? 0 : random_.Between(0.2f, 0.6f)),
              bottom = top - height;
  if (!FindPlace({2 * x, height, 2 * z}, bottom, &at)) return false;
  features_.insert("fixture");
  const Vec3 a(at.x() - x, bottom, at.z() - z), b(at.x() + x, top, at.z() + z);
  const uint32_t body = scene_.AddMaterial("fixture", DrawMatte(random_, DrawAlbedo(random_)).reflectance);
  const auto at_corner = [&](int i, int j, int k) {
    return Vec3(i ? b.x() : a.x(), j ? b.y() : a.y(), k ? b.z() : a.z());
  };
  scene_.AddQuad(at_corner(0, 0, 0), at_corner(1, 0, 0), at_corner(1, 0, 1), at_corner(0, 0, 1),
                 Glow(power, 4 * x * z));
  scene_.AddQuad(at_corner(0, 1, 0), at_corner(0, 1, 1), at_corner(1, 1, 1), at_corner(1, 1, 0), body);
  scene_.AddQuad(at_corner(0, 0, 0), at_corner(0, 0, 1), at_corner(0, 1, 1), at_corner(0, 1, 0), body);
  scene_.AddQuad(at_corner(1, 0, 0), at_corner(1, 1, 0), at_corner(1, 1, 1), at_corner(1, 0, 1), body);
  scene_.AddQuad(at_corner(0, 0, 0), at_corner(0, 1, 0), at_corner(1, 1, 0), at_corner(1, 0, 0), body);
  scene_.AddQuad(at_corner(0, 0, 1), at_corner(1, 0, 1), at_corner(1, 1, 1), at_corner(0, 1, 1), body);
  return true;
}

bool RoomLamps::HangAtWall(float power) {
  const float x = random_.Between(0.15f, 0.6f), y = random_.Between(0.1f, 0.4f),
              off = random_.LogBetween(0.005f, 0.05f);
  const int wall = random_.Whole(0, 3);
  const float half = (wall % 2 == 0 ? room_.sizes().z() : room_.sizes().x()) / 2;
  const float width = (wall % 2 == 0 ? room_.sizes().x() : room_.sizes().z()) / 2 - x - 0.1f;
  const float height = random_.Between(0.5f, 0.8f) * room_.sizes().y();
  if (width <= 0) return false;
  const Affine3f place(AngleAxisf(kPi / 2 * static_cast<float>(wall), Vec3::UnitY()) *
                       Translation3f(random_.Between(-width, width), height, off - half));
  Box3 box;
  for (const float sx : {-x, x}) {
    for (const float sy : {-y, y}) {
      for (const float z : {-off, 0.3f}) box.extend(place * Vec3(sx, sy, z));  // its light must get out
    }
  }
  if (!furniture_.IsFree(box)) return false;
  furniture_.Take(box);
  features_.insert("wall lamp");
  scene_.AddQuad(place * Vec3(-x, -y, 0), place * Vec3(x, -y, 0), place * Vec3(x, y, 0),
                 place * Vec3(-x, y, 0), Glow(power, 4 * x * y));
  return true;
}

bool RoomLamps::HangBulb(float power, bool shaded) {
  const float radius = random_.Between(0.06f, 0.13f), reach = shaded ? 2 * radius : radius;
  const float below = reach + random_.Between(0.1f, 0.35f) * room_.sizes().y();
  Vec3 at;
  if (!FindPlace(Vec3::Constant(2 * reach), room_.max().y() - below - reach, &at)) return false;
  static constexpr int kColumns[] = {8, 12, 16};
  const int columns = random_.Of(kColumns);
  Solid bulb = Ball(radius, columns, columns / 2);
  bulb.Move(Affine3f(Translation3f(at)));
  const Shading shading = random_.Chance(0.5f) ? Shading::kFlat : Shading::kSmooth;
  bulb.AddTo(&scene_, Glow(power, 4 * kPi * radius * radius), shading);
  features_.insert("bulb");
  if (shaded) {
    direct_ = false;
    features_.insert("shaded");
    const uint32_t shade = scene_.AddMaterial(
        "shade", DrawTranslucent(random_, DrawAlbedo(random_)).reflectance, Rgb::Zero(), true);
    // Open above and below.
    Solid wall = Cylinder(reach, 2 * reach, 16, true).Without({1, 2});
    wall.Move(Affine3f(Translation3f(at - Vec3(0, reach, 0))));
    wall.AddTo(&scene_, shade, Shading::kSmooth);
  }
  return true;
}

bool RoomLamps::HangTube(float power) {
  const float radius = random_.Between(0.02f, 0.05f), length = random_.Between(0.5f, 1.4f);
  const bool along_x = random_.Chance(0.5f);
  const Vec3 size = along_x ? Vec3(length, 2 * radius, 2 * radius) : Vec3(2 * radius, 2 * radius, length);
  Vec3 at;
  if (!FindPlace(size, room_.max().y() - 2 * radius - random_.Between(0.05f, 0.5f), &at)) return false;
  features_.insert("tube");
  Solid tube = Cylinder(radius, length, 12);
  tube.Move(Affine3f(Translation3f(0, -length / 2, 0)));
  tube.Move(Affine3f(Translation3f(at) * AngleAxisf(kPi / 2, along_x ? Vec3::UnitZ() : Vec3::UnitX())));
  tube.AddTo(&scene_, Glow(power, 2 * kPi * radius * (radius + length)), Shading::kFlat);
  return true;
}

bool RoomLamps::StandUplight(float power) {
  const float half = random_.Between(0.12f, 0.3f), height = random_.Between(0.3f, 0.6f) * room_.sizes().y();
  Vec3 at;
  if (!FindPlace({2 * half, height, 2 * half}, 0, &at)) return false;
  direct_ = false;
  features_.insert("uplight");
  const uint32_t body = scene_.AddMaterial("stand", DrawMatte(random_, DrawAlbedo(random_)).reflectance);
  Box({at.x() - half, 0, at.z() - half}, {at.x() + half, height, at.z() + half})
      .AddTo(&scene_, body, Shading::kFlat);
  const float y = height + 0.01f, in = 0.9f * half;
  scene_.AddQuad({at.x() - in, y, at.z() - in}, {at.x() - in, y, at.z() + in}, {at.x() + in, y, at.z() + in},
                 {at.x() + in, y, at.z() - in}, Glow(power, 4 * in * in));
  return true;
}

bool RoomLamps::HangOne(float power, bool indirect) {
  if (indirect) return random_.Chance(0.5f) ? HangBulb(power, true) : StandUplight(power);
  switch (random_.Whole(0, 7)) {
    case 0:
    case 1:
    case 2:
      return HangPanel(power);
    case 3:
    case 4:
      return HangFixture(power);
    case 5:
      return HangAtWall(power);
    case 6:
      return HangBulb(power, false);
    default:
      return HangTube(power);
  }
}

void RoomLamps::Hang(int lamps, float power, bool some_indirect) {
  for (int i = 0; i < lamps || hung_ == 0; ++i) {
    const bool indirect = some_indirect && random_.Chance(0.7f);
    if (HangOne(power * random_.LogBetween(1 / 3.0f, 3), indirect)) ++hung_;
  }
}

}  // namespace lobe::test
