#pragma once

#include <set>
#include <string>

#include <Eigen/Geometry>

#include "tests/support/rooms/furniture.h"
#include "tests/support/rooms/random_choice.h"
#include "tests/support/scene_builder.h"

namespace lobe::test {

/// Hangs lamps into a room: panels at the ceiling and on walls, boxes with a glowing underside, bulbs, tubes;
/// now and then one that is not seen directly: behind a translucent shade, or shining at the ceiling.
class RoomLamps {
 public:
  RoomLamps(const Eigen::AlignedBox3f& room, RandomChoice* random, SceneBuilder* scene, Furniture* furniture)
      : room_(room), random_(*random), scene_(*scene), furniture_(*furniture) {}

  /// `power`: watts of the mean lamp; they differ by up to 3 each way. One lamp at least finds room.
  void Hang(int lamps, float power, bool some_indirect);

  int hung() const { return hung_; }
  bool all_seen_directly() const { return direct_; }
  const std::set<std::string>& features() const { return features_; }

 private:
  bool HangOne(float power, bool indirect);
  bool HangPanel(float power);
  bool HangFixture(float power);
  bool HangAtWall(float power);
  bool HangBulb(float power, bool shaded);
  bool HangTube(float power);
  bool StandUplight(float power);

  /// A lamp of so much power, spread over an area.
  uint32_t Glow(float power, float area);
  /// Somewhere at this height; false if there is no room for it. What is there is taken.
  bool FindPlace(const Vec3& size, float bottom, Vec3* centre);

  Eigen::AlignedBox3f room_;
  RandomChoice& random_;
  SceneBuilder& scene_;
  Furniture& furniture_;
  int hung_ = 0;
  bool direct_ = true;
  std::set<std::string> features_;
};

}  // namespace lobe::test
