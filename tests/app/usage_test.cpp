// Wrong flags: exit code 2 and a sentence, before any file is opened or written.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/program.h"
#include "tests/support/scratch_folder.h"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;
using Arguments = std::vector<std::string>;

// The files named here do not exist: usage is judged first.
const Arguments kSolve = {"solve", "no-scene.glb", "-o", "no-folder/out.glb"};
const Arguments kRender = {"render", "no-solution.glb", "-o", "no-folder/out.exr"};
const Arguments kInspect = {"inspect", "no-solution.glb"};

Arguments With(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

void ExpectUsageError(const Arguments& arguments, const std::vector<std::string>& parts) {
  SCOPED_TRACE(::testing::PrintToString(arguments));
  ExpectOneSentence(RunLobe(arguments), 2, parts);
}

TEST(UsageTest, SolveFlagsOutOfRange) {
  ExpectUsageError(With(kSolve, {"--edge", "0"}), {"edge", "0"});
  ExpectUsageError(With(kSolve, {"--edge", "-1"}), {"edge", "-1"});
  ExpectUsageError(With(kSolve, {"--edge", "nan"}), {"edge"});
  ExpectUsageError(With(kSolve, {"--lmax", "33"}), {"lmax", "33"});
  ExpectUsageError(With(kSolve, {"--force-lmax", "-1"}), {"lmax", "-1"});
  ExpectUsageError(With(kSolve, {"--force-lmax", "40"}), {"lmax", "40"});
  ExpectUsageError(With(kSolve, {"--lobe-error", "0"}), {"lobe error"});
  ExpectUsageError(With(kSolve, {"--light-samples", "0"}), {"light samples"});
  ExpectUsageError(With(kSolve, {"--delta-areas", "0"}), {"delta areas"});
  ExpectUsageError(With(kSolve, {"--residual", "1"}), {"residual"});
  ExpectUsageError(With(kSolve, {"--residual", "0"}), {"residual"});
  ExpectUsageError(With(kSolve, {"--step-fraction", "1.5"}), {"step fraction"});
  ExpectUsageError(With(kSolve, {"--contact-distance", "-0.1"}), {"contact distance -0.1"});
  ExpectUsageError(With(kSolve, {"--max-steps", "-1"}), {"step limit"});
  ExpectUsageError(With(kSolve, {"--max-seconds", "-2"}), {"time limit"});
  ExpectUsageError(With(kSolve, {"--threads", "0"}), {"--threads"});
}

TEST(UsageTest, ValuesThatAreNoNumbers) {
  ExpectUsageError(With(kSolve, {"--edge", "wide"}), {"edge", "wide"});
  ExpectUsageError(With(kSolve, {"--lmax", "3.5"}), {"lmax", "3.5"});
  ExpectUsageError(With(kSolve, {"--edge", "0.4m"}), {"--edge", "'0.4m' is not a number"});
  ExpectUsageError(With(kSolve, {"--light-samples", "99999999999"}), {"--light-samples", "too large"});
  ExpectUsageError(With(kSolve, {"--seed", "-3"}), {"seed"});
  ExpectUsageError(With(kSolve, {"--seed", "18446744073709551616"}), {"--seed", "18446744073709551616"});
  ExpectUsageError(With(kRender, {"--spp", "many"}), {"spp", "many"});
}

TEST(UsageTest, SizesThatAreNone) {
  for (const char* size :
       {"-5x3", "0x10", "10", "10x", "x10", "10x20x30", "axb", "99999999999x1", "640x480 ", ""}) {
    ExpectUsageError(With(kRender, {"--size", size}), {"size"});
  }
}

TEST(UsageTest, RenderFlagsOutOfRange) {
  ExpectUsageError(With(kRender, {"--spp", "0"}), {"samples per pixel", "0"});
  ExpectUsageError(With(kRender, {"--max-mirror-depth", "-1"}), {"mirror depth"});
  ExpectUsageError(With(kRender, {"--mode", "magic"}), {"--mode", "magic", "stored"});
  ExpectUsageError(With(kRender, {"--filter", "tent"}), {"--filter", "tent", "box"});
  ExpectUsageError(With(kRender, {"--fov", "0"}), {"--fov"});
  ExpectUsageError(With(kRender, {"--fov", "180"}), {"--fov"});
  ExpectUsageError(With(kRender, {"--exposure", "nan"}), {"--exposure"});
}

TEST(UsageTest, CamerasOfOnesOwn) {
  ExpectUsageError(With(kRender, {"--eye", "1,2,3"}), {"--eye", "--target"});
  ExpectUsageError(With(kRender, {"--target", "1,2,3"}), {"--target", "--eye"});
  ExpectUsageError(With(kRender, {"--eye", "1,2", "--target", "0,0,0"}), {"--eye", "1,2"});
  ExpectUsageError(With(kRender, {"--eye", "1,2,nan", "--target", "0,0,0"}), {"--eye"});
  ExpectUsageError(With(kRender, {"--eye", "1,2,3", "--target", "1,2,3"}), {"same point"});
  ExpectUsageError(With(kRender, {"--eye", "0,1,0", "--target", "0,0,0"}), {"up", "parallel"});
  ExpectUsageError(With(kRender, {"--camera", "a", "--eye", "1,2,3", "--target", "0,0,0"}),
                   {"--camera", "--eye"});
}

TEST(UsageTest, OutputsWithoutAKnownEnding) {
  ExpectUsageError({"solve", "no-scene.glb", "-o", "out.obj"}, {"-o", "out.obj", ".glb"});
  ExpectUsageError({"render", "no-solution.glb", "-o", "out.jpg"}, {"-o", "out.jpg", ".exr", ".png"});
  ExpectUsageError(With(kRender, {"-o", "out"}), {"-o", "out"});
  ExpectUsageError(With(kInspect, {"--node", "0", "-o", "out.exr"}), {"-o", ".svg"});
  ExpectUsageError({"compare", "a.exr", "b.exr", "-o", "out.exr"}, {"-o", ".png"});
}

TEST(UsageTest, InspectWantsExactlyOnePlace) {
  ExpectUsageError(kInspect, {"--node", "--at", "--pixel"});
  ExpectUsageError(With(kInspect, {"--node", "0", "--at", "0,0,0"}), {"exactly one"});
  ExpectUsageError(With(kInspect, {"--camera", "view0"}), {"--pixel"});
  ExpectUsageError(With(kInspect, {"--pixel", "1"}), {"--pixel"});
  ExpectUsageError(With(kInspect, {"--at", "1,2"}), {"--at"});
}

TEST(UsageTest, MissingAndUnknownFlags) {
  ExpectUsageError({}, {"subcommand"});
  ExpectUsageError({"bake"}, {"bake"});
  ExpectUsageError({"solve", "no-scene.glb"}, {"--output"});
  ExpectUsageError({"render", "no-solution.glb"}, {"--output"});
  ExpectUsageError({"solve", "-o", "out.glb"}, {"SCENE"});
  ExpectUsageError(With(kSolve, {"--shiny"}), {"--shiny"});
  ExpectUsageError(With(kSolve, {"--shiny", "1"}), {"'--shiny' is no flag"});
  ExpectUsageError(With(kSolve, {"--edge"}), {"--edge"});
  ExpectUsageError(With(kSolve, {"second-scene.glb"}), {"second-scene.glb"});
  ExpectUsageError({"compare", "a.exr"}, {"REF"});
}

TEST(UsageTest, WhatSurvivingTakesIsInRange) {
  ExpectUsageError(With(kSolve, {"--max-memory", "0"}), {"--max-memory", "more than 0 GB"});
  ExpectUsageError(With(kSolve, {"--checkpoint-seconds", "-1"}),
                   {"--checkpoint-seconds", "0 (never) or more"});
  ExpectUsageError({"solve", "--resume", "half.exr"}, {"-o", ".glb"});
}

TEST(UsageTest, TheSceneIsNotOverwritten) {
  const ScratchFolder folder;
  const std::string scene = ReadWholeFile(ScenePath("cornell_diffuse"));
  WriteWholeFile(folder.File("scene.glb"), scene);
  ExpectUsageError({"solve", folder.File("scene.glb"), "-o", folder.path() + "/./scene.glb"},
                   {"scene itself"});
  EXPECT_EQ(ReadWholeFile(folder.File("scene.glb")), scene);
}

TEST(UsageTest, InputsOfInspectAndCompareAreNotOverwritten) {
  const ScratchFolder folder;
  const std::string bytes = ReadWholeFile(ScenePath("cornell_diffuse"));
  WriteWholeFile(folder.File("solution.glb"), bytes);
  WriteWholeFile(folder.File("mask.png"), bytes);
  ExpectUsageError(
      {"inspect", folder.File("solution.glb"), "--node", "0", "-o", folder.path() + "/./solution.glb"},
      {"solution itself"});
  ExpectUsageError(
      {"compare", "a.exr", "b.exr", "--mask", folder.File("mask.png"), "-o", folder.File("mask.png")},
      {"mask itself"});
  EXPECT_EQ(ReadWholeFile(folder.File("solution.glb")), bytes);
  EXPECT_EQ(ReadWholeFile(folder.File("mask.png")), bytes);
}

TEST(UsageTest, HelpTeachesOnStandardOutput) {
  const ProgramResult all = RunLobe({"--help"});
  EXPECT_EQ(all.exit_code, 0);
  EXPECT_EQ(all.err, "");
  for (const char* command : {"solve", "render", "info", "inspect", "compare"}) {
    EXPECT_THAT(all.out, HasSubstr(std::string("lobe ") + command + " ")) << "an example";
    const ProgramResult one = RunLobe({command, "--help"});
    EXPECT_EQ(one.exit_code, 0);
    EXPECT_THAT(one.out, HasSubstr("Example"));
    for (const char* common : {"--threads", "--json", "--quiet"})
      EXPECT_THAT(one.out, HasSubstr(common)) << command;
  }
  EXPECT_THAT(RunLobe({"solve", "--help"}).out, HasSubstr("metres"));
}

TEST(UsageTest, VersionIsOneLine) {
  const ProgramResult r = RunLobe({"--version"});
  EXPECT_EQ(r.exit_code, 0);
  EXPECT_THAT(r.out, ::testing::MatchesRegex("lobe [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

}  // namespace
}  // namespace lobe::test
