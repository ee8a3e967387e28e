// `lobe render` of many views, parts of views, and the files it writes.

#include <csignal>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/exr.h"
#include "render/png.h"
#include "tests/app/program.h"
#include "tests/support/scene_builder.h"
#include "tests/support/scene_glb.h"
#include "tests/support/scratch_folder.h"

namespace lobe::test {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kFlight = R"({"keyframes": [
  {"frame": 8, "eye": [0, 2.75, 5], "target": [0, 2.75, 0], "fov": 50},
  {"frame": 10, "eye": [0.5, 2.5, 4], "target": [0, 2.75, 0], "fov": 60}]})";

class RenderViewsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    solved_ = new ScratchFolder;
    SolveCoarsely("cornell_diffuse", solved_->File("s.glb"));
  }
  static void TearDownTestSuite() {
    delete solved_;
    solved_ = nullptr;
  }
  std::string File(const std::string& name) const { return folder_.File(name); }
  ProgramResult Render(std::vector<std::string> more, bool as_json = false,
                       const ProgramOptions& options = {}) const {
    std::vector<std::string> arguments{"render", solved_->File("s.glb")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (as_json) arguments.push_back("--json");
    return as_json ? RunLobe(arguments, options) : RunQuietly(arguments, options);
  }
  json RenderForJson(const std::vector<std::string>& more) const {
    const ProgramResult r = Render(more, true);
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return json::parse(r.out, nullptr, false);
  }
  static ScratchFolder* solved_;
  ScratchFolder folder_;
};
ScratchFolder* RenderViewsTest::solved_ = nullptr;

void ExpectSameBits(const Image& a, const Image& b) {
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    ASSERT_EQ(std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(Rgb)), 0) << i;
  }
}

TEST_F(RenderViewsTest, AllCamerasAreThePicturesOfEach) {
  const json r = RenderForJson({"--all-cameras", "-o", File("all_{camera}.exr"), "-o", File("{camera}.png"),
                                "--size", "24x20", "--spp", "4"});
  EXPECT_EQ(r["asked"], 2);
  EXPECT_TRUE(r["complete"].get<bool>());
  ASSERT_EQ(r["views"].size(), 2u);
  EXPECT_EQ(r["views"][1]["camera"], "view1");
  EXPECT_THAT(folder_.Entries(), ElementsAre("all_view0.exr", "all_view1.exr", "view0.png", "view1.png"));
  for (const std::string camera : {"view0", "view1"}) {
    ASSERT_EQ(Render({"--camera", camera, "-o", File("one.exr"), "--size", "24x20", "--spp", "4"}).exit_code,
              0);
    ExpectSameBits(ReadExr(File("all_" + camera + ".exr")), ReadExr(File("one.exr")));
  }
}

TEST_F(RenderViewsTest, AFlightWritesNumberedFrames) {
  WriteWholeFile(File("flight.json"), kFlight);
  const json r = RenderForJson({"--camera-path", File("flight.json"), "-o", File("f_{frame}.exr"), "--mask",
                                File("m_{frame}.png"), "--size", "16x16", "--spp", "1"});
  EXPECT_EQ(r["views"][2]["frame"], 10);
  EXPECT_THAT(folder_.Entries(), ElementsAre("f_0008.exr", "f_0009.exr", "f_0010.exr", "flight.json",
                                             "m_0008.png", "m_0009.png", "m_0010.png"));
  EXPECT_EQ(std::get<int>(ReadExrAttributes(File("f_0009.exr")).at("lobeFrame")), 9);
  // The last frame is its keyframe, from flags.
  ASSERT_EQ(Render({"--eye", "0.5,2.5,4", "--target", "0,2.75,0", "--fov", "60", "-o", File("key.exr"),
                    "--size", "16x16", "--spp", "1"})
                .exit_code,
            0);
  ExpectSameBits(ReadExr(File("f_0010.exr")), ReadExr(File("key.exr")));
  const json two = RenderForJson({"--camera-path", File("flight.json"), "--frames", "2", "-o",
                                  File("g_{frame}.png"), "--size", "8x8", "--spp", "1"});
  EXPECT_EQ(two["views"].size(), 2u);
  EXPECT_EQ(two["views"][1]["frame"], 1);
}

TEST_F(RenderViewsTest, ACropIsThatPartOfThePicture) {
  RenderForJson({"-o", File("whole.exr"), "-o", File("whole.png"), "--size", "40x32", "--spp", "4"});
  const json r = RenderForJson({"-o", File("part.exr"), "-o", File("part.png"), "--size", "40x32", "--spp",
                                "4", "--crop", "5,3,21,30"});
  EXPECT_EQ(r["crop"], json({5, 3, 21, 30}));
  const ExrWindows windows = ReadExrWindows(File("part.exr"));
  EXPECT_EQ(windows.data, (PixelRect{5, 3, 21, 30}));
  EXPECT_EQ(windows.display, (PixelRect{0, 0, 40, 32}));
  const Image whole = ReadExr(File("whole.exr")), part = ReadExr(File("part.exr"));
  Image expected(16, 27);
  for (int y = 0; y < 27; ++y) {
    for (int x = 0; x < 16; ++x) expected.at(x, y) = whole.at(x + 5, y + 3);
  }
  ExpectSameBits(part, expected);
  EXPECT_EQ(ReadPngMask(File("part.png")).width, 16);
  EXPECT_EQ(ReadPngMask(File("part.png")).height, 27);
}

TEST_F(RenderViewsTest, TheMaskIsThatOfTheTruth) {
  ASSERT_EQ(Render({"--camera", "view0", "-o", File("a.exr"), "--mask", File("m.png"), "--size", "256x256",
                    "--spp", "16"})
                .exit_code,
            0);
  const Mask mask = ReadPngMask(File("m.png"));
  const Mask truth = ReadPngMask(std::string(LOBE_TEST_DATA) + "/truth/cornell_diffuse.view0.mask.png");
  ASSERT_EQ(mask.set.size(), truth.set.size());
  size_t different = 0;
  for (size_t i = 0; i < mask.set.size(); ++i) different += mask.set[i] != truth.set[i];
  EXPECT_LE(different, mask.set.size() / 1000);
}

TEST_F(RenderViewsTest, HalfAndToneReachTheFiles) {
  RenderForJson({"-o", File("float.exr"), "-o", File("srgb.png"), "--size", "16x16", "--spp", "1"});
  RenderForJson({"-o", File("half.exr"), "-o", File("filmic.png"), "--size", "16x16", "--spp", "1", "--half",
                 "--tone", "filmic"});
  const Image a = ReadExr(File("float.exr")), b = ReadExr(File("half.exr"));
  bool exact = true;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    ASSERT_TRUE(((a.pixels[i] - b.pixels[i]).abs() <= a.pixels[i] / 2048 + 1e-7f).all());
    exact = exact && (a.pixels[i] == b.pixels[i]).all();
  }
  EXPECT_FALSE(exact);
  EXPECT_NE(ReadWholeFile(File("srgb.png")), ReadWholeFile(File("filmic.png")));
}

// Interrupted once a few frames are there: those are whole, no other is, and it says how many.
TEST_F(RenderViewsTest, AnInterruptKeepsFinishedFrames) {
  WriteWholeFile(File("flight.json"), kFlight);
  ProgramOptions options;
  bool sent = false;
  options.on_tick = [&](pid_t child) {
    if (!sent && folder_.Entries().size() >= 3) {
      kill(child, SIGINT);
      sent = true;
    }
  };
  const ProgramResult r = Render({"--camera-path", File("flight.json"), "--frames", "2000", "-o",
                                  File("f_{frame}.exr"), "--size", "64x64", "--spp", "16"},
                                 true, options);
  EXPECT_EQ(r.exit_code, 3) << r.err;
  const json object = json::parse(r.out, nullptr, false);
  const size_t finished = object["views"].size();
  EXPECT_GE(finished, 2u);
  EXPECT_LT(finished, 2000u);
  EXPECT_FALSE(object["complete"].get<bool>());
  EXPECT_EQ(object["asked"], 2000);
  EXPECT_THAT(r.err,
              HasSubstr("interrupted; " + std::to_string(finished) + " of 2000 views finished and kept"));
  EXPECT_EQ(folder_.Entries().size(), finished + 1) << "frames and the path, no temporary files";
  for (size_t i = 0; i < finished; ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "f_%04d.exr", int(i));
    EXPECT_EQ(std::get<int>(ReadExrAttributes(File(name)).at("lobeComplete")), 1) << name;
  }
}

// Cameras may be called anything; files may not lie in other folders, hide, or fall on one another.
TEST_F(RenderViewsTest, NamesOfCamerasBecomeNamesOfFiles) {
  const auto solve = [&](const std::vector<std::string>& cameras) {
    SceneBuilder b;
    b.AddBox({0, 0, 0}, {2, 2, 2}, b.AddEmitter(Rgb::Constant(1)), true);
    for (const std::string& name : cameras) b.AddCamera(name, {1, 1, 1.5f}, {1, 1, 0});
    WriteSceneGlb(b.Build(), File("scene.glb"));
    ASSERT_EQ(RunQuietly({"solve", File("scene.glb"), "-o", File("named.glb"), "--edge", "2"}).exit_code, 0);
  };
  const auto render = [&] {
    return RunQuietly({"render", File("named.glb"), "--all-cameras", "-o", File("{camera}.png"), "--size",
                       "8x8", "--spp", "1"});
  };
  solve({"../up", ".hidden", "from the door"});
  EXPECT_EQ(render().exit_code, 0);
  EXPECT_THAT(folder_.Entries(),
              ElementsAre("_._up.png", "_hidden.png", "from the door.png", "named.glb", "scene.glb"));
  solve({"a/b", "a_b"});
  ExpectOneSentence(render(), 1, {"named.glb", "'a/b' and 'a_b'", "a_b.png"});
}

TEST_F(RenderViewsTest, WrongUsageIsNamed) {
  WriteWholeFile(File("flight.json"), kFlight);
  const std::string flight = File("flight.json");
  const auto refused = [&](const std::vector<std::string>& flags, const std::vector<std::string>& parts) {
    ExpectOneSentence(Render(flags), 2, parts);
  };
  refused({"--all-cameras", "-o", File("a.exr")}, {"-o", "a.exr", "{camera}", "several cameras"});
  refused({"--all-cameras", "-o", File("{camera}.exr"), "--mask", File("m.png")},
          {"--mask", "m.png", "{camera}"});
  refused({"--camera-path", flight, "-o", File("a.exr")}, {"-o", "a.exr", "{frame}", "several frames"});
  refused({"--camera-path", flight, "-o", File("{camera}{frame}.exr")}, {"{camera}", "--camera-path"});
  refused({"-o", File("{frame}.exr")}, {"{frame}", "--camera-path"});
  refused({"-o", File("{view}.exr")}, {"'{view}'", "unknown", "{camera} and {frame}"});
  refused({"-o", File("a.exr"), "-o", File("./a.exr")}, {"a.exr", "twice"});
  refused({"-o", File("a.png"), "--mask", File("a.png")}, {"a.png", "twice"});
  refused({"-o", File("a.exr"), "--mask", File("a.exr")}, {"--mask", ".png"});
  refused({"--all-cameras", "--camera-path", flight, "-o", File("{camera}.exr")}, {"exclude"});
  refused({"--all-cameras", "--camera", "view0", "-o", File("{camera}.exr")}, {"--all-cameras", "--camera"});
  refused({"--camera-path", flight, "--fov", "30", "-o", File("{frame}.exr")}, {"--fov", "keyframes"});
  refused({"--frames", "3", "-o", File("a.exr")}, {"--frames", "--camera-path"});
  refused({"--camera-path", flight, "--frames", "0", "-o", File("{frame}.exr")}, {"--frames", "0", "100000"});
  refused({"--crop", "1,2,3", "-o", File("a.exr")}, {"--crop", "1,2,3", "X0,Y0,X1,Y1"});
  refused({"--crop", "3,0,3,5", "-o", File("a.exr")}, {"--crop", "X0 < X1"});
  refused({"--crop", "0,0,33,32", "--size", "32x32", "-o", File("a.exr")}, {"--crop 0,0,33,32", "0,0,32,32"});
  refused({"--tone", "aces", "-o", File("a.png")}, {"--tone", "aces", "filmic"});
  EXPECT_THAT(folder_.Entries(), ElementsAre("flight.json"));
}

TEST_F(RenderViewsTest, BadFilesAreNamed) {
  const std::string path = File("flight.json");
  const std::vector<std::string> flags{"--camera-path", path, "-o", File("{frame}.exr")};
  ExpectOneSentence(Render(flags), 1, {"flight.json", "cannot be read"});
  WriteWholeFile(path, "{\"keyframes\": [1,");
  ExpectOneSentence(Render(flags), 1, {"flight.json", "JSON"});
  WriteWholeFile(path, R"({"keyframes": [{"time": 0, "eye": [0,0,1], "target": [0,0,0]},
                                          {"time": 1, "eye": [0,0,-1], "target": [0,0,0]}]})");
  ExpectOneSentence(Render(flags), 2, {"flight.json", "times", "--frames"});
  std::vector<std::string> three = flags;
  three.insert(three.end(), {"--frames", "3"});
  ExpectOneSentence(Render(three), 1, {"flight.json", "between keyframes 0 and 1", "same point"});
  ExpectOneSentence(Render({"--all-cameras", "-o", File("none/{camera}.exr")}), 1, {"none"});
  ExpectOneSentence(Render({"--all-cameras", "-o", File("{camera}/a.exr")}), 1, {"view0"});
  EXPECT_THAT(folder_.Entries(), ElementsAre("flight.json"));
}

}  // namespace
}  // namespace lobe::test
