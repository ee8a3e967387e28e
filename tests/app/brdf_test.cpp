// `lobe brdf`, as a user runs it.

#include <cmath>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"
#include "tests/support/scratch_folder.h"

namespace lobe::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json Brdf(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "brdf");
  arguments.push_back("--json");
  const ProgramResult r = RunQuietly(arguments);
  EXPECT_EQ(r.exit_code, 0) << r.err;
  return json::parse(r.out, nullptr, false);
}

std::string Contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Of the row of `rows` whose `key` is `value`.
json Row(const json& rows, const char* key, double value) {
  for (const json& row : rows) {
    if (std::abs(row.at(key).get<double>() - value) < 1e-6) return row;
  }
  ADD_FAILURE() << "no row with " << key << " " << value;
  return {};
}

// docs/validation.md#degree: roughness 0.5 leaves 8.4 % at degree 12, 5.0 % at 16 and takes 11 for 10 %.
TEST(BrdfCommandTest, ReportsTheErrorsOfGgx) {
  const json r = Brdf({"ggx:roughness=0.5"});
  EXPECT_EQ(r["kind"], "lobe");
  EXPECT_EQ(r["part"], "gloss");
  EXPECT_EQ(r["l_max_gloss"], 11);
  EXPECT_LE(r["error"]["total"].get<double>(), 0.1);
  EXPECT_LE(r["error"]["between_knots"].get<double>(), 0.012);
  EXPECT_GT(r["knots"].get<int>(), 4);
  EXPECT_LT(r["knots"].get<int>(), 15);
  EXPECT_EQ(r["lobe_bytes"], 3 * 4 * 78);
  EXPECT_NEAR(Row(r["over_l_max"], "l_max", 12)["error"]["total"].get<double>(), 0.084, 0.002);
  EXPECT_NEAR(Row(r["over_l_max"], "l_max", 16)["error"]["total"].get<double>(), 0.050, 0.002);
  EXPECT_GT(Row(r["over_l_max"], "l_max", 4)["negative_part"].get<double>(), 0.04);
  for (const json& row : r["over_theta"]) {
    EXPECT_NEAR(row["albedo"].get<double>(), row["lobe_albedo"].get<double>(), 1e-4);
    EXPECT_GT(row["albedo"].get<double>(), 0.5);
  }
}

TEST(BrdfCommandTest, FlagsChooseTheDegree) {
  EXPECT_EQ(Brdf({"ggx:roughness=0.5", "--force-lmax", "7"})["l_max_gloss"], 7);
  const json capped = Brdf({"ggx:roughness=0.2", "--lmax", "9"});
  EXPECT_EQ(capped["l_max_gloss"], 9);
  EXPECT_EQ(capped["kind"], "sharp");
  EXPECT_LT(Brdf({"ggx:roughness=0.5", "--lobe-error", "40"})["l_max_gloss"].get<int>(), 6);
}

TEST(BrdfCommandTest, KnowsEveryModelWithItsParameters) {
  for (const char* spec : {"gltf:base=0.6,metallic=0.5,roughness=0.5,ior=1.4", "lambert:albedo=0.2/0.3/0.4",
                           "phong:albedo=0.5,exponent=10", "blinn-phong:exponent=30", "ward:alpha=0.3",
                           "cook-torrance:f0=0.9,alpha=0.4", "oren-nayar:sigma=0.5,albedo=0.7",
                           "ashikhmin-shirley:diffuse=0.2,specular=0.1,exponent=20",
                           "plastic:albedo=0.4,ior=1.6,roughness=0.5", "ggx"}) {
    const ProgramResult r = RunQuietly({"brdf", spec, "--lmax", "8"});
    EXPECT_EQ(r.exit_code, 0) << spec << ": " << r.err;
    EXPECT_THAT(r.out, HasSubstr("theta_i")) << spec;
  }
  const json lambert = Brdf({"lambert:albedo=0.2/0.3/0.4"});
  EXPECT_EQ(lambert["part"], "base");
  EXPECT_LT(lambert["error"]["total"].get<double>(), 1e-6);
  EXPECT_NEAR(lambert["over_theta"][0]["albedo"].get<double>(), 0.2126 * 0.2 + 0.7152 * 0.3 + 0.0722 * 0.4,
              1e-6);
}

TEST(BrdfCommandTest, FindsMaterialsOfScenesAndSolutions) {
  const ScratchFolder folder;
  const std::string solution = folder.File("solved.glb");
  SolveCoarsely("cornell_glossy", solution);
  const json of_scene = Brdf({ScenePath("cornell_glossy") + "#brushed aluminium"});
  EXPECT_EQ(of_scene["model"], "ggx roughness 0.4");
  EXPECT_EQ(Brdf({solution + "#brushed aluminium"})["error"], of_scene["error"]);
  EXPECT_TRUE(Brdf({ScenePath("cornell_glossy") + "#glossy back wall"}).contains("with_base"));
}

TEST(BrdfCommandTest, ReadsMeasuredFiles) {
  const ScratchFolder folder;
  std::ofstream csv(folder.File("grey.csv"));
  csv << "theta_i,theta_o,phi,red,green,blue\n";
  for (const int i : {0, 30, 60, 90}) {
    for (const int o : {0, 30, 60, 90}) {
      for (const int phi : {0, 90, 180}) csv << i << ',' << o << ',' << phi << ",0.1,0.1,0.1\n";
    }
  }
  csv.close();
  const json r = Brdf({folder.File("grey.csv"), "--lmax", "6"});
  EXPECT_NEAR(r["over_theta"][3]["albedo"].get<double>(), 0.1 * 3.14159265, 1e-4);
  EXPECT_LT(r["error"]["total"].get<double>(), 0.01);
}

TEST(BrdfCommandTest, DrawsPngAndSvg) {
  const ScratchFolder folder;
  for (const char* spec : {"ggx:roughness=0.6", "oren-nayar"}) {
    const std::string svg = folder.File("plot.svg"), png = folder.File("plot.png");
    EXPECT_EQ(RunQuietly({"brdf", spec, "--lmax", "8", "-o", svg}).exit_code, 0);
    EXPECT_EQ(RunQuietly({"brdf", spec, "--lmax", "8", "-o", png}).exit_code, 0);
    EXPECT_THAT(Contents(svg), HasSubstr("</svg>"));
    EXPECT_THAT(Contents(svg), HasSubstr(spec));
    EXPECT_EQ(Contents(png).substr(1, 3), "PNG");
    // The same words and curves every time.
    const std::string first = Contents(svg);
    EXPECT_EQ(RunQuietly({"brdf", spec, "--lmax", "8", "-o", svg, "--threads", "1"}).exit_code, 0);
    EXPECT_EQ(Contents(svg), first);
  }
}

TEST(BrdfCommandTest, SaysWhatIsWrongWithASpec) {
  const auto usage = [](const std::string& spec, const std::vector<std::string>& parts) {
    ExpectOneSentence(RunQuietly({"brdf", spec}), 2, parts);
  };
  usage("velvet", {"'velvet' is no model", "oren-nayar", "plastic"});
  usage("ggx:rough=0.3", {"ggx has no parameter 'rough'", "roughness and f0"});
  usage("ggx:roughness=2", {"roughness '2'", "0.01 to 1"});
  usage("ggx:roughness=nan", {"roughness 'nan'"});
  usage("ggx:roughness", {"'roughness' has no value"});
  usage("plastic:albedo=0.1/0.2", {"albedo '0.1/0.2' is not a colour"});
  usage("phong:exponent=1/2/3", {"exponent '1/2/3' is not a number"});
  usage("", {"'' is no model"});
  usage(ScenePath("cornell_glossy"), {"which material?", "'brushed aluminium'"});
  const auto input = [](const std::string& spec, const std::vector<std::string>& parts) {
    ExpectOneSentence(RunQuietly({"brdf", spec}), 1, parts);
  };
  input(ScenePath("cornell_glossy") + "#chrome", {"no material is named 'chrome'", "'brushed aluminium'"});
  input("missing.binary", {"missing.binary"});
  input("missing.glb#x", {"missing.glb"});
  input("gltf:metallic=1,roughness=0", {"no lobes", "mirror"});
  ExpectOneSentence(RunQuietly({"brdf", "ggx", "-o", "plot.pdf"}), 2, {"-o", "plot.pdf", ".png or .svg"});
  ExpectOneSentence(RunQuietly({"brdf", "ggx", "--lmax", "33"}), 2, {"33", "0 to 32"});
}

TEST(InfoCommandTest, SaysWhatLobesLoseAndTake) {
  const ProgramResult text = RunQuietly({"info", ScenePath("cornell_glossy")});
  for (const char* word : {"truncation", "between knots", "negative", "knots", "build"}) {
    EXPECT_THAT(text.out, HasSubstr(word));
  }
  const ProgramResult r = RunQuietly({"info", ScenePath("cornell_glossy"), "--json"});
  for (const json& m : json::parse(r.out)["materials"]) {
    ASSERT_EQ(m.contains("lobes"), m["kind"] != "none") << m["name"];
    if (!m.contains("lobes")) continue;
    const json& lobes = m["lobes"];
    EXPECT_EQ(lobes["error"], m["lobe_error"]);
    EXPECT_LE(lobes["truncated"], lobes["error"]);
    EXPECT_LE(lobes["between_knots"].get<double>(), 0.01);  // a tenth of --lobe-error
    EXPECT_GT(lobes["negative_part"].get<double>(), 0.01);
    EXPECT_GT(lobes["lobe_bytes"].get<int>(), 12);
  }
}

}  // namespace
}  // namespace lobe::test
