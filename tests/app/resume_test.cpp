// What survives: kill -9, a full disk, an interrupt; and that --resume goes on from it to the same bits.

#include <sys/resource.h>

#include <chrono>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/glb_file.h"
#include "tests/app/program.h"
#include "tests/support/scratch_folder.h"

namespace lobe::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

using Arguments = std::vector<std::string>;

Arguments With(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// Half a second in many short steps, saved as often as may be.
const Arguments kManySteps = {"solve",
                              ScenePath("cornell_glossy"),
                              "--edge",
                              "0.7",
                              "--lmax",
                              "4",
                              "--light-samples",
                              "4",
                              "--delta-areas",
                              "24",
                              "--transport",
                              "shooting",
                              "--step-fraction",
                              "0.3",
                              "--residual",
                              "0.01",
                              "--checkpoint-seconds",
                              "0.001",
                              "--refine-error",
                              "0"};

/// A quarter of a second by links.
const Arguments kLinks = {"solve", ScenePath("cornell_glossy"), "--edge", "0.7", "--lmax", "4"};

/// All of a solution's file but what tells the time and how often it was resumed.
struct Bits {
  json document;
  std::string binary;
  bool operator==(const Bits&) const = default;
};
Bits BitsOf(const std::string& path) {
  GlbFile file(path);
  json& record = file.document["extensions"]["LOBE_directional_radiance"];
  record.erase("solveSeconds");
  record.erase("resumed");
  for (json& step : record["history"]) step.erase("seconds");
  return {file.document, file.binary};
}

json InfoOf(const std::string& path) {
  const ProgramResult r = RunQuietly({"info", path, "--json"});
  EXPECT_EQ(r.exit_code, 0) << r.err;
  return r.exit_code == 0 ? json::parse(r.out) : json();
}

/// Absent, or complete and valid. Returns whether it is there.
bool AbsentOrValid(const ScratchFolder& folder, const std::string& name) {
  const auto entries = folder.Entries();
  if (std::find(entries.begin(), entries.end(), name) == entries.end()) return false;
  const json info = InfoOf(folder.File(name));
  EXPECT_EQ(info["type"], "solution");
  EXPECT_GE(info["history"].size(), 1u) << "emission is in every checkpoint";
  EXPECT_LT(info["ledger"]["closure"], 1e-5);
  return true;
}

/// Kills `kills` solves at random moments spread over the time that a whole one takes, and a resumed one at
/// another; goes on from what is left each time, and compares with the solve that nobody killed.
void KillAndResume(int kills, int least_found) {
  const ScratchFolder whole;
  const auto start = std::chrono::steady_clock::now();
  const ProgramResult r = RunQuietly(With(kManySteps, {"-o", whole.File("out.glb")}));
  const std::chrono::duration<double, std::micro> duration = std::chrono::steady_clock::now() - start;
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const Bits expected = BitsOf(whole.File("out.glb"));

  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  int found = 0;
  for (int i = 0; i < kills; ++i) {
    SCOPED_TRACE(i);
    const ScratchFolder folder;
    const std::string out = folder.File("out.glb");
    const auto killed_at = [&](double share) {
      ProgramOptions options;
      options.kill_after = std::chrono::microseconds(1 + int64_t(share * duration.count()));
      return options;
    };
    // One moment in each of so many equal parts.
    const ProgramResult killed =
        RunQuietly(With(kManySteps, {"-o", out}), killed_at((i + uniform(random)) / kills));
    EXPECT_TRUE(killed.exit_code == 128 + SIGKILL || killed.exit_code == 0) << killed.exit_code;
    if (!AbsentOrValid(folder, "out.glb")) continue;
    ++found;
    RunQuietly({"solve", "--resume", out, "--checkpoint-seconds", "0.001"}, killed_at(0.7 * uniform(random)));
    EXPECT_TRUE(AbsentOrValid(folder, "out.glb")) << "what was resumed in place is gone";
    ASSERT_EQ(RunQuietly({"solve", "--resume", out}).exit_code, 0);
    EXPECT_TRUE(BitsOf(out) == expected);
  }
  EXPECT_GE(found, least_found) << "the kills came too early to say anything";
}

TEST(ResumeCommandTest, KilledAtTenMomentsItGoesOnToTheSameBits) { KillAndResume(10, 3); }

TEST(SlowResumeCommandTest, KilledAtFiftyMomentsItGoesOnToTheSameBits) { KillAndResume(50, 15); }

TEST(ResumeCommandTest, AStopIsGoneOnFromToTheSameBits) {
  const ScratchFolder folder;
  const std::string whole = folder.File("whole.glb"), half = folder.File("half.glb"),
                    out = folder.File("out.glb");
  ASSERT_EQ(RunQuietly(With(kLinks, {"-o", whole})).exit_code, 0);
  const ProgramResult stopped = RunQuietly(With(kLinks, {"-o", half, "--max-steps", "2"}));
  EXPECT_EQ(stopped.exit_code, 3);
  EXPECT_THAT(stopped.err, HasSubstr("--resume"));
  EXPECT_EQ(InfoOf(half)["resumed"], 0);
  const std::string before = ReadWholeFile(half);
  // With the scene beside it, a setting that says the same, and another number of threads.
  const ProgramResult resumed =
      RunQuietly({"solve", ScenePath("cornell_glossy"), "--resume", half, "-o", out, "--edge", "0.7",
                  "--transport", "auto", "--max-steps", "1000", "--threads", "1", "--json"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(json::parse(resumed.out)["resumed"], 1);
  EXPECT_TRUE(BitsOf(out) == BitsOf(whole));
  EXPECT_EQ(InfoOf(out)["resumed"], 1);
  EXPECT_EQ(ReadWholeFile(half), before) << "written elsewhere, it stays";
}

TEST(ResumeCommandTest, AConvergedSolutionIsDoneAtOnce) {
  const ScratchFolder folder;
  const std::string out = folder.File("out.glb");
  ASSERT_EQ(RunQuietly(With(kLinks, {"-o", out})).exit_code, 0);
  const std::string before = ReadWholeFile(out);
  const ProgramResult r = RunQuietly({"solve", "--resume", out, "--json"});
  EXPECT_EQ(r.exit_code, 0) << r.err;
  EXPECT_EQ(json::parse(r.out)["resumed"], 0);
  EXPECT_EQ(ReadWholeFile(out), before);
}

TEST(ResumeCommandTest, OtherSettingsAndOtherScenesAreRefused) {
  const ScratchFolder folder;
  const std::string half = folder.File("half.glb");
  ASSERT_EQ(RunQuietly(With(kLinks, {"-o", half, "--max-steps", "1"})).exit_code, 3);
  const std::string before = ReadWholeFile(half);
  const auto refused = [&](const Arguments& more, int exit_code, const Arguments& parts) {
    ExpectOneSentence(RunLobe(With({"solve", "--resume", half}, more)), exit_code, parts);
  };
  refused({"--edge", "0.3"}, 2, {"--edge: 0.3", "0.7", half});
  refused({"--lmax", "5"}, 2, {"--lmax: 5", "4"});
  refused({"--lobe-error", "3"}, 2, {"--lobe-error: 3"});
  refused({"--force-lmax", "3"}, 2, {"--force-lmax: 3", "none"});
  refused({"--transport", "shooting"}, 2, {"--transport: shooting", "links"});
  refused({"--links", "100"}, 2, {"--links: 100", half});
  refused({"--plain-sweeps"}, 2, {"--plain-sweeps"});
  refused({"--refine-error", "3"}, 2, {"--refine-error: 3", "10"});
  refused({"--seed", "2"}, 2, {"--seed: 2"});
  refused({ScenePath("cornell_diffuse")}, 1, {"cornell_diffuse", "not the scene", "materials"});
  refused({ScenePath("no-such-scene")}, 1, {"no-such-scene"});
  ExpectOneSentence(RunLobe({"solve", "--resume", ScenePath("cornell_diffuse"), "-o", folder.File("a.glb")}),
                    1, {"cornell_diffuse", "scene, not a solution"});
  ExpectOneSentence(RunLobe({"solve", "--resume", folder.File("none.glb")}), 1, {"none.glb"});
  EXPECT_EQ(ReadWholeFile(half), before);
}

TEST(ResumeCommandTest, AnInterruptWhileGoingOnKeepsTheFileAsGoodAsItWas) {
  const ScratchFolder folder;
  const std::string out = folder.File("out.glb");
  ASSERT_EQ(RunQuietly(With(kManySteps, {"-o", out, "--max-steps", "3"})).exit_code, 3);
  ProgramOptions options;
  bool sent = false;
  options.on_stderr = [&](pid_t child, const std::string& err) {
    if (sent || err.find("going on from") == std::string::npos) return;
    sent = true;
    kill(child, SIGINT);
  };
  const ProgramResult r = RunLobe({"solve", "--resume", out, "--max-steps", "1000"}, options);
  EXPECT_EQ(r.exit_code, 3);
  EXPECT_THAT(r.err, HasSubstr("interrupted"));
  EXPECT_GE(InfoOf(out)["history"].size(), 4u);
}

// What is saved while solving goes on is itself a solution: it says that it is not finished, and renders.
TEST(ResumeCommandTest, ACheckpointRendersAndSaysWhatItIs) {
  const ScratchFolder folder;
  const std::string out = folder.File("out.glb"), kept = folder.File("kept.glb");
  ProgramOptions options;
  bool seen = false;
  options.on_tick = [&](pid_t child) {
    if (seen || !std::filesystem::exists(out)) return;
    seen = true;
    std::filesystem::copy_file(out, kept);
    kill(child, SIGKILL);
  };
  RunLobe(With(kManySteps, {"-o", out}), options);
  ASSERT_TRUE(seen);
  const json info = InfoOf(kept);
  EXPECT_EQ(info["stop_reason"], "unfinished");
  EXPECT_EQ(info["checkpoint"], true);
  EXPECT_THAT(RunLobe({"info", kept}).out, HasSubstr("checkpoint"));
  EXPECT_EQ(
      RunQuietly({"render", kept, "-o", folder.File("a.png"), "--size", "32x32", "--spp", "1"}).exit_code, 0);
}

TEST(ResumeCommandTest, WithoutCheckpointsNothingIsWrittenBeforeTheEnd) {
  const ScratchFolder folder;
  const std::string out = folder.File("out.glb"), first = folder.File("first.glb");
  ProgramOptions options;
  options.on_tick = [&](pid_t) {
    if (std::filesystem::exists(out) && !std::filesystem::exists(first)) {
      std::filesystem::copy_file(out, first);
    }
  };
  Arguments arguments = With(kManySteps, {"-o", out});
  std::replace(arguments.begin(), arguments.end(), std::string("0.001"), std::string("0"));
  ASSERT_EQ(RunQuietly(arguments, options).exit_code, 0);
  if (std::filesystem::exists(first)) {
    EXPECT_EQ(InfoOf(first)["checkpoint"], false);
  }
  EXPECT_EQ(InfoOf(out)["checkpoint"], false);
}

/// From when the first checkpoint is there, files can grow no further: the disk is full.
ProgramOptions DiskFullAfterTheFirstCheckpoint(const std::string& out) {
  ProgramOptions options;
  options.on_tick = [=](pid_t child) {
    if (!std::filesystem::exists(out)) return;
    const rlimit limit{1000, 1000};
    prlimit(child, RLIMIT_FSIZE, &limit, nullptr);
  };
  return options;
}

TEST(ResumeCommandTest, ADiskThatFillsUpIsToldOnceAndTheLastGoodCheckpointKept) {
  const ScratchFolder whole, folder;
  const std::string out = folder.File("out.glb");
  ASSERT_EQ(RunQuietly(With(kManySteps, {"-o", whole.File("out.glb")})).exit_code, 0);

  const ProgramResult r = RunLobe(With(kManySteps, {"-o", out}), DiskFullAfterTheFirstCheckpoint(out));
  EXPECT_EQ(r.exit_code, 1);
  const size_t warning = r.err.find("warning: a checkpoint was not saved: " + out);
  ASSERT_NE(warning, std::string::npos) << r.err;
  EXPECT_EQ(r.err.find("was not saved", warning + 40), std::string::npos) << "told twice";
  // Solving went on to its end, and that could not be written either.
  const std::string last = r.err.substr(r.err.rfind("lobe: "));
  EXPECT_THAT(last, HasSubstr(out + ": cannot be written"));
  EXPECT_EQ(last.find('\n'), last.size() - 1) << last;
  EXPECT_EQ(folder.Entries(), std::vector<std::string>{"out.glb"}) << "no temporary file stays";

  ASSERT_TRUE(AbsentOrValid(folder, "out.glb"));
  EXPECT_EQ(InfoOf(out)["checkpoint"], true);
  ASSERT_EQ(RunQuietly({"solve", "--resume", out}).exit_code, 0);
  EXPECT_TRUE(BitsOf(out) == BitsOf(whole.File("out.glb")));
}

TEST(ResumeCommandTest, ADiskThatFillsUpIsOneSentenceWhenQuiet) {
  const ScratchFolder folder;
  const std::string out = folder.File("out.glb");
  ExpectOneSentence(RunQuietly(With(kManySteps, {"-o", out}), DiskFullAfterTheFirstCheckpoint(out)), 1,
                    {out, "cannot be written"});
  EXPECT_TRUE(AbsentOrValid(folder, "out.glb"));
}

}  // namespace
}  // namespace lobe::test
