#include "render/camera_path.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace lobe {
namespace {

using test::ExpectInputError;
using test::ScratchFolder;
using test::WriteWholeFile;

CameraKey Key(double time, const Vec3& eye, double fov = 40) {
  return {time, eye, eye + Vec3(0.3f, -0.2f, -1), Vec3(0, 1, 0), fov};
}

/// Four keys at uneven times, turning and climbing.
CameraPath Flight() {
  return CameraPath(
      {Key(0, {0, 1, 5}, 30), Key(10, {2, 1.5f, 4}, 50), Key(14, {3, 3, 1}, 50), Key(30, {-1, 2, 0}, 20)},
      true);
}

TEST(CameraPathTest, PassesThroughItsKeys) {
  const Camera start = Flight().At(0), middle = Flight().At(14), end = Flight().At(30);
  EXPECT_LT((start.eye - Vec3(0, 1, 5)).norm(), 1e-6f);
  EXPECT_LT((middle.eye - Vec3(3, 3, 1)).norm(), 1e-6f);
  EXPECT_LT((end.eye - Vec3(-1, 2, 0)).norm(), 1e-6f);
  EXPECT_NEAR(start.fov_y, 30 * M_PI / 180, 1e-6);
  EXPECT_NEAR(end.fov_y, 20 * M_PI / 180, 1e-6);
  const Vec3 view = Vec3(0.3f, -0.2f, -1).normalized();
  EXPECT_LT((middle.back + view).norm(), 1e-6f);
}

// Eyes on a parabola in time: three-point derivatives are exact on those, so the spline is.
TEST(CameraPathTest, ParabolasAreKeptExactly) {
  const auto on = [](double t) {
    return Vec3(float(1 + 0.5 * t), float(0.1 * t * t), float(5 - t + 0.02 * t * t));
  };
  const CameraPath path({Key(0, on(0)), Key(1, on(1)), Key(4, on(4)), Key(6, on(6))}, false);
  for (double t = 0; t <= 6; t += 0.37) EXPECT_LT((path.At(t).eye - on(t)).norm(), 2e-6f) << t;
}

TEST(CameraPathTest, TwoKeysMakeAStraightLineAtEvenSpeed) {
  const CameraPath path({Key(0, {0, 0, 0}), Key(8, {4, 2, 0})}, true);
  EXPECT_LT((path.At(2).eye - Vec3(1, 0.5f, 0)).norm(), 1e-6f);
  EXPECT_LT((path.At(6).eye - Vec3(3, 1.5f, 0)).norm(), 1e-6f);
}

TEST(CameraPathTest, VelocityDoesNotJumpAtKeys) {
  const CameraPath path = Flight();
  constexpr double kStep = 1e-2;
  for (const double key : {10.0, 14.0}) {
    const Vec3 before = (path.At(key).eye - path.At(key - kStep).eye) / float(kStep);
    const Vec3 after = (path.At(key + kStep).eye - path.At(key).eye) / float(kStep);
    // Accelerations here are below 1 per frame squared; positions are floats.
    EXPECT_LT((after - before).norm(), 0.02f) << key;
    EXPECT_GT(before.norm(), 0.1f) << key;
  }
}

TEST(CameraPathTest, TwoEqualKeysAreAHalt) {
  const CameraPath path({Key(0, {0, 1, 5}), Key(5, {1, 1, 5}), Key(9, {1, 1, 5}), Key(12, {1, 1, 2})}, true);
  for (const double t : {5.0, 6.3, 8.9}) EXPECT_EQ((path.At(t).eye - Vec3(1, 1, 5)).norm(), 0) << t;
  EXPECT_LT((path.At(5).eye - path.At(4.9).eye).norm(), 0.01f) << "it slows down before";
}

TEST(CameraPathTest, FieldOfViewStaysBetweenItsKeys) {
  const CameraPath path = Flight();
  for (double t = 10; t <= 14; t += 0.1) EXPECT_NEAR(path.At(t).fov_y, 50 * M_PI / 180, 1e-6);
  for (double t = 14; t <= 30; t += 0.1) {
    EXPECT_LE(path.At(t).fov_y, 50.001 * M_PI / 180);
    EXPECT_GE(path.At(t).fov_y, 19.999 * M_PI / 180);
  }
}

TEST(CameraPathTest, FramesAreEveryWholeFrameOrSoMany) {
  const CameraPath path({Key(3, {0, 0, 0}), Key(7, {1, 0, 0})}, true);
  const auto own = path.Frames(std::nullopt);
  ASSERT_EQ(own.size(), 5u);
  EXPECT_EQ(own[0].number, 3);
  EXPECT_EQ(own[4].number, 7);
  EXPECT_EQ(own[4].time, 7);
  const auto three = path.Frames(3);
  ASSERT_EQ(three.size(), 3u);
  EXPECT_EQ(three[1].number, 1);
  EXPECT_EQ(three[1].time, 5);
  EXPECT_EQ(three[2].time, 7);
  EXPECT_EQ(path.Frames(1)[0].time, 3);
  ExpectInputError([&] { path.Frames(0); }, {"0 frames", "100000"});
  ExpectInputError(
      [] {
        CameraPath({Key(0, {0, 0, 0}), Key(1, {1, 0, 0})}, false).Frames(std::nullopt);
      },
      {"no frame numbers"});
  ExpectInputError(
      [] {
        CameraPath({Key(0, {0, 0, 0}), Key(1e9, {1, 0, 0})}, true).Frames(std::nullopt);
      },
      {"1e+09 frames", "100000"});
}

TEST(CameraPathTest, AFlightThroughItsOwnTargetNamesThePlace) {
  const CameraPath path({{0, Vec3(0, 0, 1), Vec3(0, 0, 0)}, {2, Vec3(0, 0, -1), Vec3(0, 0, 0)}}, false);
  ExpectInputError([&] { path.At(1); }, {"between keyframes 0 and 1, at 1", "same point"});
}

TEST(CameraPathFileTest, IsReadWithItsDefaults) {
  const ScratchFolder folder;
  WriteWholeFile(folder.File("p.json"), R"({"keyframes": [
    {"frame": 0, "eye": [0, 1, 5], "target": [0, 1, 0]},
    {"frame": 10, "eye": [2, 1, 5], "target": [0, 1, 0], "up": [0, 0, -2], "fov": 60}]})");
  const CameraPath path = ReadCameraPath(folder.File("p.json"));
  EXPECT_TRUE(path.in_frames());
  EXPECT_EQ(path.Frames(std::nullopt).size(), 11u);
  EXPECT_NEAR(path.At(0).fov_y, 40 * M_PI / 180, 1e-6);
  EXPECT_LT((path.At(0).up - Vec3(0, 1, 0)).norm(), 1e-6f);
  EXPECT_NEAR(path.At(10).fov_y, 60 * M_PI / 180, 1e-6);
}

TEST(CameraPathFileTest, WhatIsWrongIsNamed) {
  const ScratchFolder folder;
  const std::string path = folder.File("p.json");
  const auto refused = [&](const std::string& text, std::initializer_list<std::string> words) {
    WriteWholeFile(path, text);
    ExpectInputError([&] { ReadCameraPath(path); }, words);
  };
  const auto keys = [](const std::string& second) {
    return R"({"keyframes": [{"frame": 0, "eye": [0,1,5], "target": [0,1,0]}, )" + second + "]}";
  };
  ExpectInputError([&] { ReadCameraPath(folder.File("none.json")); }, {"none.json", "cannot be read"});
  ExpectInputError([&] { ReadCameraPath(folder.path()); }, {"is a directory"});
  ExpectInputError([] { ReadCameraPath("/dev/zero"); }, {"/dev/zero", "16 MB"});
  refused("", {"p.json", "JSON"});
  refused("{\"keyframes\": [", {"p.json", "JSON"});
  refused("[]", {"no array 'keyframes'"});
  refused(R"({"keyframes": {}})", {"no array 'keyframes'"});
  refused(R"({"keyframes": [], "loop": true})", {"unknown member 'loop'"});
  refused(R"({"keyframes": []})", {"no keyframe", "two or more"});
  refused(R"({"keyframes": [{"frame": 0, "eye": [0,1,5], "target": [0,1,0]}]})", {"one keyframe"});
  refused(keys("7"), {"keyframe 1 is number", "object"});
  refused(keys(R"({"frame": 1, "target": [0,1,0]})"), {"keyframe 1", "no 'eye'"});
  refused(keys(R"({"frame": 1, "eye": [0,1], "target": [0,1,0]})"),
          {"keyframe 1", "'eye' is [0,1]", "three numbers"});
  refused(keys(R"({"frame": 1, "eye": [0,1,1e300], "target": [0,1,0]})"), {"keyframe 1", "'eye'", "1e+300"});
  refused(keys(R"({"frame": 1, "eye": [0,1,5], "target": [0,1,0], "roll": 3})"), {"keyframe 1", "'roll'"});
  refused(keys(R"({"frame": 1.5, "eye": [0,1,5], "target": [0,1,0]})"),
          {"keyframe 1", "1.5", "whole number"});
  refused(keys(R"({"frame": 0, "eye": [0,1,5], "target": [0,1,0]})"), {"keyframe 1 is at 0", "rising"});
  refused(keys(R"({"time": 1, "eye": [0,1,5], "target": [0,1,0]})"), {"keyframe 1", "no 'frame'"});
  refused(keys(R"({"frame": 1, "time": 1, "eye": [0,1,5], "target": [0,1,0]})"), {"keyframe 1", "both"});
  refused(keys(R"({"eye": [0,1,5], "target": [0,1,0]})"), {"keyframe 1", "neither"});
  refused(keys(R"({"frame": 1, "eye": [0,1,5], "target": [0,1,5]})"), {"keyframe 1", "same point"});
  refused(keys(R"({"frame": 1, "eye": [0,1,5], "target": [0,9,5]})"), {"keyframe 1", "parallel"});
  refused(keys(R"({"frame": 1, "eye": [0,1,5], "target": [0,1,0], "fov": 180})"), {"keyframe 1", "180"});
  refused(keys(R"({"frame": 1, "eye": "here", "target": [0,1,0]})"), {"keyframe 1", "\"here\""});
  const std::string deep = std::string(300000, '[') + std::string(300000, ']');
  refused(keys("{\"frame\": 1, \"eye\": " + deep + "}"),
          {"keyframe 1", "'eye' is nested arrays", "three numbers"});
  refused(keys("{\"frame\": 1, \"eye\": \"" + std::string(1000, 'x') + "\"}"),
          {"'eye' is \"xxx", "...; three"});
}

}  // namespace
}  // namespace lobe
