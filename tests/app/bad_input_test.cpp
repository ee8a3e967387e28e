// What comes from outside may be anything. Each case: the exit code, one sentence that names the thing, and
// nothing left behind under the asked-for name or any other.

#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/glb_file.h"
#include "tests/app/program.h"
#include "tests/support/scratch_folder.h"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;

class BadInputTest : public ::testing::Test {
 protected:
  std::string File(const std::string& name) const { return folder_.File(name); }
  std::string Output() const { return output_folder_.File("out.glb"); }

  /// Solving `scene` fails with these words, and `info` on it does the same.
  void ExpectSolveFails(const std::string& scene, const std::vector<std::string>& parts) {
    ExpectOneSentence(RunQuietly({"solve", scene, "-o", Output(), "--edge", "2"}), 1, parts);
    ExpectNothingLeft();
  }
  void ExpectNothingLeft() { EXPECT_THAT(output_folder_.Entries(), ::testing::IsEmpty()); }

  ScratchFolder folder_, output_folder_;
};

TEST_F(BadInputTest, MissingSceneIsNamed) {
  ExpectSolveFails(File("missing.glb"), {"missing.glb"});
  ExpectOneSentence(RunQuietly({"info", File("missing.glb")}), 1, {"missing.glb"});
  ExpectOneSentence(RunQuietly({"render", File("missing.glb"), "-o", File("a.png")}), 1, {"missing.glb"});
  ExpectOneSentence(RunQuietly({"inspect", File("missing.glb"), "--node", "0"}), 1, {"missing.glb"});
  ExpectOneSentence(RunQuietly({"compare", File("missing.exr"), File("b.exr")}), 1, {"missing.exr"});
}

TEST_F(BadInputTest, EmptySceneIsRefused) {
  WriteWholeFile(File("empty.glb"), "");
  ExpectSolveFails(File("empty.glb"), {"empty.glb"});
}

TEST_F(BadInputTest, DirectoryAsSceneIsRefused) { ExpectSolveFails(folder_.path(), {folder_.path()}); }

TEST_F(BadInputTest, EdgesTooShortForTheMachineAreRefused) {
  // 1.8e9 elements, some 360 GB; then more than can be counted.
  for (const char* edge : {"8e-4", "1e-6"}) {
    ExpectOneSentence(RunQuietly({"solve", ScenePath("cornell_diffuse"), "-o", Output(), "--edge", edge}), 1,
                      {"cornell_diffuse.glb", "elements", "choose longer edges"});
    ExpectNothingLeft();
  }
}

TEST_F(BadInputTest, WhatNeedsMoreMemoryThanAllowedIsRefusedWithAnEdgeThatFits) {
  ExpectOneSentence(RunQuietly({"solve", ScenePath("cornell_diffuse"), "-o", Output(), "--edge", "0.02",
                                "--max-memory", "0.1"}),
                    1, {"cornell_diffuse.glb", "0.02 m", "GB", "at most 100 MB", "m would fit"});
  ExpectNothingLeft();
}

TEST_F(BadInputTest, WrongMagicIsRefused) {
  std::string bytes = ReadWholeFile(ScenePath("cornell_diffuse"));
  bytes.replace(0, 4, "gTLF");
  WriteWholeFile(File("magic.glb"), bytes);
  ExpectSolveFails(File("magic.glb"), {"magic.glb"});
}

TEST_F(BadInputTest, SceneCutAnywhereIsRefused) {
  const std::string bytes = ReadWholeFile(ScenePath("cornell_diffuse"));
  for (size_t length = 1; length < bytes.size(); length += bytes.size() / 12) {
    SCOPED_TRACE(length);
    WriteWholeFile(File("cut.glb"), bytes.substr(0, length));
    ExpectOneSentence(RunQuietly({"info", File("cut.glb")}), 1, {"cut.glb"});
  }
}

TEST_F(BadInputTest, AccessorBeyondItsBufferIsNamed) {
  GlbFile glb(ScenePath("cornell_diffuse"));
  glb.document["accessors"][glb.PositionAccessor()]["count"] = 100000;
  glb.Save(File("accessor.glb"));
  ExpectSolveFails(File("accessor.glb"), {"accessor.glb", "accessor"});
}

TEST_F(BadInputTest, IndexBeyondTheVerticesIsRefused) {
  GlbFile glb(ScenePath("cornell_diffuse"));
  // Fewer vertices than the indices ask for.
  glb.document["accessors"][glb.PositionAccessor()]["count"] = 1;
  glb.Save(File("index.glb"));
  ExpectSolveFails(File("index.glb"), {"index.glb"});
}

TEST_F(BadInputTest, NanPositionIsRefused) {
  GlbFile glb(ScenePath("cornell_diffuse"));
  glb.SetFloat(glb.PositionAccessor(), 4, std::nanf(""));
  glb.Save(File("nan.glb"));
  ExpectSolveFails(File("nan.glb"), {"nan.glb"});
}

TEST_F(BadInputTest, RoughnessOutsideZeroToOneIsRefused) {
  for (const double roughness : {1.5, -0.1}) {
    GlbFile glb(ScenePath("cornell_diffuse"));
    glb.Material("red")["pbrMetallicRoughness"]["roughnessFactor"] = roughness;
    glb.Save(File("rough.glb"));
    ExpectSolveFails(File("rough.glb"), {"rough.glb", "red", "oughness"});
  }
}

TEST_F(BadInputTest, SceneWithoutEmitterIsRefused) {
  GlbFile glb(ScenePath("cornell_diffuse"));
  for (auto& material : glb.document["materials"]) material.erase("emissiveFactor");
  glb.Save(File("dark.glb"));
  ExpectSolveFails(File("dark.glb"), {"dark.glb"});
}

TEST_F(BadInputTest, TrianglesWithoutAreaAreWarnedOfAndDropped) {
  GlbFile glb(ScenePath("cornell_diffuse"));
  // The first primitive's first corner moves onto the second: one or two of its triangles lose their area.
  const auto& primitive = glb.document["meshes"][0]["primitives"][0];
  const int positions = primitive["attributes"]["POSITION"].get<int>();
  const auto& view =
      glb.document["bufferViews"][glb.document["accessors"][positions]["bufferView"].get<int>()];
  const size_t at =
      view.value("byteOffset", 0u) + glb.document["accessors"][positions].value("byteOffset", 0u);
  glb.binary.replace(at, 12, glb.binary.substr(at + 12, 12));
  glb.Save(File("flat.glb"));
  const ProgramResult r = RunLobe({"info", File("flat.glb")});
  EXPECT_EQ(r.exit_code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("warning: "));
  EXPECT_EQ(RunQuietly({"solve", File("flat.glb"), "-o", Output(), "--edge", "2"}).exit_code, 0);
}

TEST_F(BadInputTest, SolutionWhereASceneIsWantedIsRefused) {
  SolveCoarsely("cornell_diffuse", File("solution.glb"));
  ExpectSolveFails(File("solution.glb"), {"solution.glb", "solution", "scene"});
}

TEST_F(BadInputTest, SceneWhereASolutionIsWantedIsRefused) {
  const std::string scene = ScenePath("cornell_diffuse");
  ExpectOneSentence(RunQuietly({"render", scene, "-o", output_folder_.File("a.exr")}), 1,
                    {scene, "solution"});
  ExpectOneSentence(RunQuietly({"inspect", scene, "--node", "0"}), 1, {scene, "solution"});
  ExpectNothingLeft();
}

TEST_F(BadInputTest, CutSolutionIsRefused) {
  SolveCoarsely("cornell_diffuse", File("solution.glb"));
  const std::string bytes = ReadWholeFile(File("solution.glb"));
  for (const size_t length : {bytes.size() / 4, bytes.size() / 2, bytes.size() - 4}) {
    WriteWholeFile(File("cut.glb"), bytes.substr(0, length));
    ExpectOneSentence(RunQuietly({"render", File("cut.glb"), "-o", output_folder_.File("a.exr")}), 1,
                      {"cut.glb"});
  }
  ExpectNothingLeft();
}

TEST_F(BadInputTest, UnknownCameraNamesThoseThereAre) {
  SolveCoarsely("cornell_diffuse", File("solution.glb"));
  const std::string picture = output_folder_.File("a.exr");
  ExpectOneSentence(RunQuietly({"render", File("solution.glb"), "--camera", "view7", "-o", picture}), 1,
                    {"view7", "view0", "view1"});
  ExpectNothingLeft();
}

TEST_F(BadInputTest, SceneWithoutCameraNeedsAnEye) {
  GlbFile glb(ScenePath("cornell_diffuse"));
  glb.document.erase("cameras");
  for (auto& node : glb.document["nodes"]) node.erase("camera");
  glb.Save(File("blind.glb"));
  ASSERT_EQ(RunQuietly({"solve", File("blind.glb"), "-o", File("solution.glb"), "--edge", "2"}).exit_code, 0);
  const std::string picture = output_folder_.File("a.png");
  ExpectOneSentence(RunQuietly({"render", File("solution.glb"), "-o", picture}), 1, {"camera", "--eye"});
  ExpectNothingLeft();
  const ProgramResult r =
      RunQuietly({"render", File("solution.glb"), "--eye", "0,2.75,5", "--target", "0,2.75,0", "--fov", "60",
                  "-o", picture, "--size", "16x16", "--spp", "1"});
  EXPECT_EQ(r.exit_code, 0) << r.err;
  EXPECT_EQ(output_folder_.Entries(), std::vector<std::string>{"a.png"});
}

TEST_F(BadInputTest, UnwritableOutputIsFoundBeforeWork) {
  const std::string scene = ScenePath("cornell_diffuse");
  WriteWholeFile(File("file"), "not a folder");
  for (const std::string& place :
       {File("file") + "/out.glb", File("no/such/out.glb"), std::string("/proc/out.glb")}) {
    SCOPED_TRACE(place);
    // Solving at this edge would take minutes: the answer must come before.
    ExpectOneSentence(RunQuietly({"solve", scene, "-o", place, "--edge", "0.01"}), 1, {place});
  }
  EXPECT_EQ(ReadWholeFile(File("file")), "not a folder");
}

TEST_F(BadInputTest, DirectoryAsOutputIsRefused) {
  std::filesystem::create_directory(File("folder.glb"));
  ExpectOneSentence(RunQuietly({"solve", ScenePath("cornell_diffuse"), "-o", File("folder.glb")}), 1,
                    {"folder.glb", "directory"});
  EXPECT_TRUE(std::filesystem::is_empty(File("folder.glb")));
}

// As on a full disk: the solution needs more than 20 kB.
TEST_F(BadInputTest, FullDiskIsOneSentenceAndNoFile) {
  ProgramOptions options;
  options.file_size_limit = 20000;
  const ProgramResult r = RunQuietly(
      {"solve", ScenePath("cornell_diffuse"), "-o", Output(), "--edge", "2", "--light-samples", "1"},
      options);
  ExpectOneSentence(r, 1, {Output()});
  ExpectNothingLeft();
}

TEST_F(BadInputTest, FullDiskKeepsWhatWasThere) {
  WriteWholeFile(Output(), "an older solution");
  ProgramOptions options;
  options.file_size_limit = 20000;
  RunQuietly({"solve", ScenePath("cornell_diffuse"), "-o", Output(), "--edge", "2", "--light-samples", "1"},
             options);
  EXPECT_EQ(ReadWholeFile(Output()), "an older solution");
  EXPECT_EQ(output_folder_.Entries(), std::vector<std::string>{"out.glb"});
}

TEST_F(BadInputTest, PicturesThatDoNotFitAreNamed) {
  const std::string truth = std::string(LOBE_TEST_DATA) + "/truth/cornell_diffuse.view0";
  SolveCoarsely("cornell_diffuse", File("solution.glb"));
  ASSERT_EQ(RunQuietly({"render", File("solution.glb"), "-o", File("a.exr"), "--size", "32x32", "--spp", "1"})
                .exit_code,
            0);
  ExpectOneSentence(RunQuietly({"compare", File("a.exr"), truth + ".a.exr"}), 1,
                    {"a.exr", "32 x 32", "256 x 256"});
  ExpectOneSentence(RunQuietly({"compare", truth + ".a.exr", truth + ".b.exr", "--mask", truth + ".a.exr"}),
                    1, {"PNG"});
  WriteWholeFile(File("b.exr"), ReadWholeFile(truth + ".a.exr").substr(0, 5000));
  ExpectOneSentence(RunQuietly({"compare", File("b.exr"), truth + ".b.exr"}), 1, {"b.exr", "OpenEXR"});
}

}  // namespace
}  // namespace lobe::test
