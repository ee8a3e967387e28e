// The commands on real scenes, as a user runs them.

#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/exr.h"
#include "scene/gltf_file.h"
#include "sh/vector.h"
#include "tests/app/program.h"
#include "tests/support/scratch_folder.h"

namespace lobe::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Runs with --json: exit code 0 and exactly one JSON object on standard output.
json RunForJson(std::vector<std::string> arguments) {
  arguments.push_back("--json");
  const ProgramResult r = RunLobe(arguments);
  EXPECT_EQ(r.exit_code, 0) << r.err;
  EXPECT_EQ(r.out.substr(0, 1), "{");
  const json object = json::parse(r.out, nullptr, false);  // refuses anything after the object
  EXPECT_TRUE(object.is_object()) << r.out;
  return object;
}

Vec3 ToVec3(const json& list) {
  return Vec3(list.at(0).get<float>(), list.at(1).get<float>(), list.at(2).get<float>());
}

class CommandsTest : public ::testing::Test {
 protected:
  std::string File(const std::string& name) const { return folder_.File(name); }
  std::string Solved(const std::string& scene) {
    const std::string path = File(scene + ".glb");
    SolveCoarsely(scene, path);
    return path;
  }
  ScratchFolder folder_;
};

TEST_F(CommandsTest, SolveReportsWhatItDid) {
  const json r =
      RunForJson({"solve", ScenePath("cornell_glossy"), "-o", File("out.glb"), "--edge", "2", "--lmax", "6",
                  "--light-samples", "4", "--delta-areas", "16", "--residual", "0.01"});
  EXPECT_GT(r["nodes"].get<int>(), 50);
  EXPECT_GT(r["elements"].get<int>(), 50);
  EXPECT_EQ(r["materials"].size(), 6u);
  EXPECT_EQ(r["stop_reason"], "converged");
  EXPECT_LE(r["residual"].get<double>(), 0.01);
  EXPECT_EQ(r["history"].back()["residual"], r["residual"]);
  EXPECT_LT(r["ledger"]["closure"].get<double>(), 1e-5);
  EXPECT_GT(r["solve_seconds"].get<double>(), 0);
  EXPECT_GT(r["cpu_seconds"].get<double>(), 0);
  EXPECT_GT(r["time_split"]["links"].get<double>(), 0);
  EXPECT_EQ(r["output"], File("out.glb"));
  EXPECT_EQ(folder_.Entries(), std::vector<std::string>{"out.glb"});
}

TEST_F(CommandsTest, SolveSpeaksOnStandardErrorOnly) {
  const ProgramResult r =
      RunLobe({"solve", ScenePath("cornell_diffuse"), "-o", File("out.glb"), "--edge", "2"});
  EXPECT_EQ(r.exit_code, 0);
  EXPECT_EQ(r.out, "");
  for (const char* part : {"material", "emitted", "absorbed", "nodes", "converged", "wrote"}) {
    EXPECT_THAT(r.err, HasSubstr(part));
  }
  EXPECT_EQ(r.err.find('\r'), std::string::npos) << "no terminal, no bar";
}

TEST_F(CommandsTest, SolveWarnsOfLightThatMirrorsWouldThrow) {
  const ProgramResult r = RunLobe({"solve", ScenePath("furnace_glossy"), "-o", File("out.glb"), "--edge", "2",
                                   "--transport", "shooting"});
  EXPECT_EQ(r.exit_code, 0);
  EXPECT_THAT(r.err, HasSubstr("fell on ideal mirrors"));
}

TEST_F(CommandsTest, QuietIsSilent) {
  const ProgramResult r =
      RunQuietly({"solve", ScenePath("cornell_diffuse"), "-o", File("out.glb"), "--edge", "2"});
  EXPECT_EQ(r.exit_code, 0);
  EXPECT_EQ(r.out + r.err, "");
}

TEST_F(CommandsTest, InfoOfASceneSaysWhatEachMaterialCosts) {
  const json r = RunForJson({"info", ScenePath("cornell_glossy")});
  EXPECT_EQ(r["type"], "scene");
  EXPECT_EQ(r["scene"]["faces"], 38);
  EXPECT_EQ(r["scene"]["cameras"][0]["name"], "view0");
  std::map<std::string, std::string> kinds;
  for (const json& m : r["materials"]) kinds[m["name"]] = m["kind"];
  EXPECT_EQ(kinds["red"], "none");
  EXPECT_EQ(kinds["glossy back wall"], "sharp");
  EXPECT_EQ(kinds["brushed aluminium"], "lobe");
  const json forced = RunForJson({"info", ScenePath("cornell_glossy"), "--force-lmax", "7"});
  for (const json& m : forced["materials"]) {
    if (m["kind"] == "none") continue;
    EXPECT_EQ(m["l_max_gloss"], 7);
  }
}

TEST_F(CommandsTest, InfoNamesTranslucentMaterials) {
  for (const json& m : RunForJson({"info", ScenePath("lampshade")})["materials"]) {
    EXPECT_EQ(m["translucent"], m["name"] == "shade") << m["name"];
  }
  EXPECT_THAT(RunLobe({"info", ScenePath("lampshade")}).out, HasSubstr("none, translucent"));
}

TEST_F(CommandsTest, InfoOfASolutionRepeatsWhatSolveSaid) {
  const json solved = RunForJson({"solve", ScenePath("cornell_glossy"), "-o", File("out.glb"), "--edge", "2",
                                  "--lmax", "6", "--light-samples", "4", "--delta-areas", "16"});
  json info = RunForJson({"info", File("out.glb")});
  // What lobes lose and take, info alone says.
  for (json& material : info["materials"]) material.erase("lobes");
  EXPECT_EQ(info["type"], "solution");
  EXPECT_EQ(info["mesh"]["nodes"], solved["nodes"]);
  EXPECT_EQ(info["materials"], solved["materials"]);
  EXPECT_EQ(info["ledger"], solved["ledger"]);
  EXPECT_EQ(info["history"], solved["history"]);
  EXPECT_EQ(info["settings"], solved["settings"]);
  EXPECT_EQ(info["settings"]["lmax"], 6);
  const ProgramResult text = RunLobe({"info", File("out.glb")});
  for (const char* part : {"solution", "ledger", "settings", "convergence", "converged"}) {
    EXPECT_THAT(text.out, HasSubstr(part));
  }
}

TEST_F(CommandsTest, RenderTracesPathsOfAScene) {
  const std::string scene = ScenePath("cornell_diffuse");
  RunForJson({"render", scene, "--mode", "path", "-o", File("p.exr"), "--size", "24x24", "--spp", "64"});
  RunForJson({"render", Solved("cornell_diffuse"), "-o", File("s.exr"), "--size", "24x24"});
  const json c = RunForJson({"compare", File("p.exr"), File("s.exr")});
  EXPECT_NEAR(c["mean"].get<double>() / c["reference_mean"].get<double>(), 1, 0.1);
}

TEST_F(CommandsTest, RenderWritesLayersThatSumToTheColour) {
  RunForJson(
      {"render", Solved("cornell_diffuse"), "-o", File("l.exr"), "--size", "24x24", "--layers", "all"});
  const Image colour = ReadExr(File("l.exr"));
  Image sum(colour.width, colour.height);
  for (const char* name : {"direct", "indirect", "specular"}) {
    const Image layer = ReadExrLayer(File("l.exr"), name).image;
    for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += layer.pixels[i];
  }
  for (size_t i = 0; i < sum.pixels.size(); ++i) {
    EXPECT_LT((sum.pixels[i] - colour.pixels[i]).abs().maxCoeff(), 1e-4f * (1 + colour.pixels[i].maxCoeff()));
  }
  EXPECT_EQ(ListExrLayers(File("l.exr")).size(), 8u);
}

TEST_F(CommandsTest, RenderWritesBothKindsOfPicture) {
  const json r = RunForJson({"render", Solved("cornell_diffuse"), "--camera", "view1", "-o", File("a.exr"),
                             "-o", File("a.png"), "--size", "40x30", "--spp", "4"});
  EXPECT_EQ(r["camera"], "view1");
  EXPECT_EQ(r["width"], 40);
  EXPECT_TRUE(r["complete"].get<bool>());
  const Image image = ReadExr(File("a.exr"));
  EXPECT_EQ(image.width, 40);
  EXPECT_EQ(image.height, 30);
  double sum = 0;
  for (const Rgb& p : image.pixels) sum += p.sum();
  EXPECT_GT(sum, 0);
  const ExrAttributes attributes = ReadExrAttributes(File("a.exr"));
  EXPECT_EQ(std::get<std::string>(attributes.at("camera")), "view1");
  EXPECT_EQ(std::get<int>(attributes.at("samplesPerPixel")), 4);
  EXPECT_EQ(std::get<std::string>(attributes.at("lobeMode")), "auto");
  EXPECT_EQ(std::get<std::vector<float>>(attributes.at("worldToCamera")).size(), 16u);
  EXPECT_EQ(std::get<std::vector<float>>(attributes.at("worldToNDC")).size(), 16u);
  EXPECT_FALSE(std::get<std::string>(attributes.at("lobeVersion")).empty());
  EXPECT_EQ(ReadWholeFile(File("a.png")).substr(1, 3), "PNG");
}

TEST_F(CommandsTest, FirstCameraAndItsAspectAreTheDefault) {
  const json r = RunForJson({"render", Solved("cornell_diffuse"), "-o", File("a.png"), "--spp", "1"});
  EXPECT_EQ(r["camera"], "view0");
  EXPECT_EQ(r["height"], 512);
  EXPECT_EQ(r["width"], 512);
}

// view0 of the Cornell box stands at (0, 2.75, 5.15) and looks along -z: the same from flags.
TEST_F(CommandsTest, AnEyeOfOnesOwnSeesWhatTheFilesCameraSees) {
  const std::string solution = Solved("cornell_diffuse");
  const json camera = RunForJson({"info", solution})["scene"]["cameras"][0];
  const Vec3 eye = ToVec3(camera["eye"]), target = eye + 2 * ToVec3(camera["direction"]);
  const auto say = [](const Vec3& v) {
    return std::to_string(v.x()) + "," + std::to_string(v.y()) + "," + std::to_string(v.z());
  };
  RunForJson(
      {"render", solution, "--camera", "view0", "-o", File("a.exr"), "--size", "32x32", "--spp", "16"});
  RunForJson({"render", solution, "--eye", say(eye), "--target", say(target), "--fov",
              std::to_string(camera["fov_y_degrees"].get<double>()), "-o", File("b.exr"), "--size", "32x32",
              "--spp", "16"});
  const json c = RunForJson({"compare", File("b.exr"), File("a.exr")});
  // Rounded numbers move rays by 1e-6; only a few of them cross an edge.
  EXPECT_LT(c["pixel_error"].get<double>(), 0.02);
}

TEST_F(CommandsTest, SameBitsForAnyNumberOfThreads) {
  for (const char* threads : {"1", "2"}) {
    const std::string solution = File(std::string(threads) + ".glb"),
                      picture = File(std::string(threads) + ".exr");
    ASSERT_EQ(RunQuietly({"solve", ScenePath("cornell_glossy"), "-o", solution, "--edge", "2", "--lmax", "6",
                          "--light-samples", "4", "--delta-areas", "16", "--threads", threads})
                  .exit_code,
              0);
    ASSERT_EQ(
        RunQuietly({"render", solution, "-o", picture, "--size", "48x48", "--spp", "4", "--threads", threads})
            .exit_code,
        0);
  }
  const Image one = ReadExr(File("1.exr")), two = ReadExr(File("2.exr"));
  for (size_t i = 0; i < one.pixels.size(); ++i) ASSERT_TRUE((one.pixels[i] == two.pixels[i]).all()) << i;
}

TEST_F(CommandsTest, CompareTellsTheTruthsNoise) {
  const std::string stem = std::string(LOBE_TEST_DATA) + "/truth/cornell_diffuse.view0";
  const json one = RunForJson({"compare", stem + ".a.exr", stem + ".b.exr", "--mask", stem + ".mask.png"});
  const json two = RunForJson({"compare", stem + ".a.exr", stem + ".a.exr", stem + ".b.exr", "--mask",
                               stem + ".mask.png", "-o", File("d.png")});
  EXPECT_FALSE(one.contains("reference_pixel_noise"));
  EXPECT_NEAR(one["pixel_error"].get<double>(), std::sqrt(2.0) * two["reference_pixel_noise"].get<double>(),
              1e-3);
  EXPECT_EQ(two["pixel_error"], 0);
  EXPECT_EQ(ReadWholeFile(File("d.png")).substr(1, 3), "PNG");
  EXPECT_THAT(RunLobe({"compare", stem + ".a.exr", stem + ".b.exr"}).out, HasSubstr("pixel error"));
}

TEST_F(CommandsTest, InspectFindsOneNodeThreeWays) {
  const std::string solution = Solved("cornell_glossy");
  const json by_pixel =
      RunForJson({"inspect", solution, "--camera", "view0", "--pixel", "60,60", "--size", "100x100"});
  const json by_number =
      RunForJson({"inspect", solution, "--node", std::to_string(by_pixel["node"].get<int>())});
  EXPECT_EQ(by_pixel, by_number);
  const Vec3 position = ToVec3(by_pixel["position"]);
  const auto text = [](const Vec3& v) {
    return std::to_string(v.x()) + "," + std::to_string(v.y()) + "," + std::to_string(v.z());
  };
  const json by_place =
      RunForJson({"inspect", solution, "--at", text(position + 1e-3f * ToVec3(by_pixel["frame"]["z"]))});
  // Several nodes may share a place, where surfaces meet.
  EXPECT_LT((ToVec3(by_place["position"]) - position).norm(), 1e-4f);
}

TEST_F(CommandsTest, InspectSaysTheLobesFigures) {
  // The middle of view0 sees the back wall, which is glossy; its lobe has base and gloss parts.
  const json r = RunForJson({"inspect", Solved("cornell_glossy"), "--pixel", "60,30", "--size", "100x100"});
  EXPECT_EQ(r["material"], "glossy back wall");
  EXPECT_EQ(r["kind"], "sharp");
  EXPECT_EQ(r["l_max_gloss"], 5);
  EXPECT_EQ(r["coefficients"].size(), 21u) << "(5 + 1)(5 + 2) / 2";
  const Vec3 z = ToVec3(r["frame"]["z"]);
  EXPECT_NEAR(z.norm(), 1, 1e-5f);
  EXPECT_NEAR(ToVec3(r["frame"]["x"]).dot(z), 0, 1e-5f);
  EXPECT_GT(r["flux"][0].get<double>(), 0);
  EXPECT_GE(r["peak"]["luminance"].get<double>(), 0);
  EXPECT_GE(ToVec3(r["peak"]["direction_world"]).dot(z), -1e-4f);
  EXPECT_GE(r["negative_fraction"].get<double>(), 0);
  EXPECT_LE(r["negative_fraction"].get<double>(), 1);
  EXPECT_FALSE(r["hidden"].get<bool>());
}

TEST_F(CommandsTest, InspectDrawsTheLobe) {
  const std::string solution = Solved("cornell_glossy");
  for (const char* name : {"lobe.svg", "lobe.png", "lobe.glb"}) {
    ASSERT_EQ(RunQuietly({"inspect", solution, "--pixel", "60,30", "--size", "100x100", "-o", File(name)})
                  .exit_code,
              0);
  }
  EXPECT_NE(ReadWholeFile(File("lobe.svg")).find("glossy back wall"), std::string::npos);
  EXPECT_EQ(ReadWholeFile(File("lobe.png")).substr(1, 3), "PNG");
  EXPECT_EQ(GltfFile(File("lobe.glb")).json()["nodes"][0]["name"], "node");
}

TEST_F(CommandsTest, InspectRefusesNodesAndPixelsOutOfRange) {
  const std::string solution = Solved("cornell_diffuse");
  ExpectOneSentence(RunQuietly({"inspect", solution, "--node", "1000000"}), 2,
                    {"--node", "1000000", "0 to "});
  ExpectOneSentence(RunQuietly({"inspect", solution, "--node", "-1"}), 2, {"--node", "-1"});
  ExpectOneSentence(RunQuietly({"inspect", solution, "--pixel", "32,0", "--size", "32x32"}), 2,
                    {"--pixel", "32,0"});
  ExpectOneSentence(RunQuietly({"inspect", solution, "--camera", "view9", "--pixel", "0,0"}), 1,
                    {"view9", "view0"});
}

TEST_F(CommandsTest, TheCornellBoxLooksAsThePathTracerSaysItDoes) {
  const std::string stem = std::string(LOBE_TEST_DATA) + "/truth/cornell_diffuse.view0";
  ASSERT_EQ(
      RunQuietly({"solve", ScenePath("cornell_diffuse"), "-o", File("out.glb"), "--edge", "0.6"}).exit_code,
      0);
  RunForJson({"render", File("out.glb"), "-o", File("a.exr"), "--size", "256x256", "--spp", "4"});
  const json c =
      RunForJson({"compare", File("a.exr"), stem + ".a.exr", stem + ".b.exr", "--mask", stem + ".mask.png"});
  EXPECT_NEAR(c["mean"].get<double>() / c["reference_mean"].get<double>(), 1, 0.03);
  EXPECT_LT(c["block_error"].get<double>(), 0.08) << "a coarse mesh: 10 cells along a wall";
}

}  // namespace
}  // namespace lobe::test
