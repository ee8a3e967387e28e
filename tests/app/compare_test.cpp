// `lobe compare`, as a user runs it.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/exr.h"
#include "render/png.h"
#include "tests/app/program.h"
#include "tests/support/scratch_folder.h"

namespace lobe::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class CompareCommandTest : public ::testing::Test {
 protected:
  CompareCommandTest() {
    LayeredImage image(24, 16, LayerSet::All());
    for (Rgb& p : image.color.pixels) p.setConstant(0.5f);
    for (Rgb& p : image.layers[Layer::kNormal].pixels) p = Rgb(-1, 0, 0);
    for (Rgb& p : image.layers[Layer::kAlbedo].pixels) p = Rgb(0.2f, 0.4f, 0.6f);
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 24; ++x) image.layers[Layer::kDepth].at(x, y).setConstant(3);
    }
    WriteExr(image, {}, {}, File("reference.exr"));
    for (Rgb& p : image.color.pixels) p.setConstant(0.6f);
    for (Rgb& p : image.layers[Layer::kAlbedo].pixels) p = Rgb(0.2f, 0.4f, 0.9f);
    for (int x = 0; x < 24; ++x) image.layers[Layer::kDepth].at(x, 2).setConstant(6);
    WriteExr(image, {}, {}, File("a.exr"));
  }
  std::string File(const std::string& name) const { return folder_.File(name); }
  json Compare(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"compare", File("a.exr"), File("reference.exr"), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult r = RunLobe(arguments);
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return json::parse(r.out, nullptr, false);
  }
  ScratchFolder folder_;
};

// 0.1 above 0.5 everywhere; the epsilon is 0.01 x 0.25.
TEST_F(CompareCommandTest, JsonHasEveryFigure) {
  const json r = Compare({});
  EXPECT_NEAR(r["pixel_error"].get<double>(), 0.2, 1e-6);
  EXPECT_NEAR(r["block_error"].get<double>(), 0.2, 1e-6);
  EXPECT_NEAR(r["bias"].get<double>(), 0.2, 1e-6);
  EXPECT_NEAR(r["relative_mse_epsilon"].get<double>(), 0.0025, 1e-8);
  EXPECT_NEAR(r["relative_mse"].get<double>(), 0.01 / 0.2525, 1e-6);
  for (const char* name : {"p50", "p90", "p99", "max"}) {
    EXPECT_NEAR(r["relative_error"][name].get<double>(), std::sqrt(0.01 / 0.2525), 1e-6) << name;
  }
  EXPECT_TRUE(r["includes_reference_noise"].get<bool>());
  EXPECT_EQ(r["flip"]["tone"], "srgb");
  EXPECT_NEAR(r["flip"]["pixels_per_degree"].get<double>(), 67.02, 1e-9);
  EXPECT_GT(r["flip"]["mean"].get<double>(), 0.05);
  EXPECT_LT(Compare({"--exposure", "-8"})["flip"]["mean"], r["flip"]["mean"]) << "nearly black";
  EXPECT_NE(Compare({"--tone", "filmic"})["flip"]["mean"], r["flip"]["mean"]);
}

TEST_F(CompareCommandTest, LayersAreComparedByName) {
  const json albedo = Compare({"--layer", "albedo"});
  EXPECT_NEAR(albedo["pixel_error"].get<double>(), std::sqrt(0.09 / 3) / 0.4, 1e-6);
  EXPECT_EQ(albedo["layer"], "albedo");
  EXPECT_TRUE(albedo.contains("flip"));
  const json normal = Compare({"--layer", "N"});
  EXPECT_EQ(normal["pixel_error"], 0) << "although its mean is negative";
  EXPECT_FALSE(normal.contains("flip")) << "directions are not seen";
  const json depth = Compare({"--layer", "Z"});
  EXPECT_EQ(depth["pixels"], 8 * 24) << "the lower half hits nothing";
  EXPECT_NEAR(depth["pixel_error"].get<double>(), std::sqrt(9.0 / 8) / 3, 1e-6);
  ExpectOneSentence(RunQuietly({"compare", File("a.exr"), File("reference.exr"), "--layer", "depth"}), 1,
                    {"a.exr", "no layer 'depth'", "albedo"});
}

TEST_F(CompareCommandTest, SideBySideIsThreePicturesWideAndAMapIsOne) {
  Compare({"-o", File("row.png")});
  EXPECT_EQ(ReadPngMask(File("row.png")).width, 72);
  EXPECT_EQ(ReadPngMask(File("row.png")).height, 16);
  Compare({"-o", File("map.png"), "--layout", "map"});
  EXPECT_EQ(ReadPngMask(File("map.png")).width, 24);
}

TEST_F(CompareCommandTest, ItSaysWhetherTheReferencesNoiseIsIncluded) {
  const std::string stem = std::string(LOBE_TEST_DATA) + "/truth/cornell_diffuse.view0";
  const ProgramResult one = RunLobe({"compare", stem + ".a.exr", stem + ".b.exr"});
  EXPECT_THAT(one.out, HasSubstr("one reference: whatever noise it has is included"));
  const ProgramResult two = RunLobe({"compare", stem + ".a.exr", stem + ".a.exr", stem + ".b.exr"});
  EXPECT_THAT(two.out, HasSubstr("it cancels"));
  EXPECT_THAT(two.out, Not(HasSubstr("is included")));
  const ProgramResult same = RunLobe({"compare", stem + ".a.exr", stem + ".b.exr", stem + ".b.exr"});
  EXPECT_THAT(same.err, HasSubstr("the two references are equal"));
}

TEST_F(CompareCommandTest, ACropIsComparedWithItsPartOfTheReference) {
  LayeredImage whole(20, 12, {}), crop(6, 5, {});
  for (size_t i = 0; i < whole.color.pixels.size(); ++i) whole.color.pixels[i].setConstant(1 + float(i));
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x) crop.color.at(x, y) = whole.color.at(x + 9, y + 4);
  }
  Mask mask{20, 12, std::vector<bool>(240, false)};
  mask.set[4 * 20 + 9] = mask.set[0] = true;  // the crop's first pixel, and one outside it
  WritePngMask(mask, File("m.png"));
  WriteExr(whole, {}, {}, File("whole.exr"));
  WriteExr(crop, {}, {.full_width = 20, .full_height = 12, .left = 9, .top = 4}, File("crop.exr"));
  const ProgramResult r =
      RunLobe({"compare", File("crop.exr"), File("whole.exr"), "--mask", File("m.png"), "--json"});
  const json c = json::parse(r.out, nullptr, false);
  EXPECT_EQ(c["pixels"], 29) << r.err;
  EXPECT_EQ(c["pixel_error"], 0);
  ExpectOneSentence(RunQuietly({"compare", File("crop.exr"), File("a.exr")}), 1, {"6 x 5", "24 x 16"});
}

TEST_F(CompareCommandTest, WrongFlagsAreRefusedBeforeFilesAreRead) {
  const std::vector<std::string> start{"compare", "none.exr", "none.exr"};
  const auto refused = [&](std::vector<std::string> more, std::vector<std::string> parts) {
    more.insert(more.begin(), start.begin(), start.end());
    ExpectOneSentence(RunQuietly(more), 2, parts);
  };
  refused({"--layout", "upside-down"}, {"--layout", "upside-down", "side-by-side"});
  refused({"--tone", "aces"}, {"--tone", "aces", "reinhard"});
  refused({"--exposure", "1000"}, {"--exposure", "-100 to 100"});
  refused({"--exposure", "nan"}, {"--exposure", "nan"});
  refused({"--pixels-per-degree", "1"}, {"--pixels-per-degree", "5 to 1000"});
}

}  // namespace
}  // namespace lobe::test
