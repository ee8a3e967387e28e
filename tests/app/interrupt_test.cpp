// Stopping early: the result is saved, readable, and says why; exit code 3.

#include <chrono>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"
#include "tests/support/scratch_folder.h"

namespace lobe::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Minutes of work, in many short pieces.
std::vector<std::string> LongSolve(const std::string& output) {
  return {"solve",
          ScenePath("cornell_diffuse"),
          "-o",
          output,
          "--edge",
          "0.5",
          "--light-samples",
          "20000",
          "--delta-areas",
          "20000"};
}

json InfoOf(const std::string& path) {
  const ProgramResult r = RunQuietly({"info", path, "--json"});
  EXPECT_EQ(r.exit_code, 0) << r.err;
  return json::parse(r.out);
}

/// Sends `signal` once, when the program has said what it is about to solve: by then it listens.
ProgramOptions SignalOnceListening(int signal) {
  ProgramOptions options;
  auto sent = std::make_shared<bool>(false);
  options.on_stderr = [=](pid_t child, const std::string& err) {
    if (*sent || err.find("cameras:") == std::string::npos) return;
    *sent = true;
    kill(child, signal);
  };
  return options;
}

TEST(InterruptTest, InterruptSavesAReadableSolution) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const ScratchFolder folder;
    const ProgramResult r = RunLobe(LongSolve(folder.File("out.glb")), SignalOnceListening(signal));
    EXPECT_EQ(r.exit_code, 3) << r.err;
    EXPECT_THAT(r.err, HasSubstr("lobe: stopped early, interrupted"));
    EXPECT_THAT(r.err, HasSubstr("saved as " + folder.File("out.glb")));
    EXPECT_EQ(folder.Entries(), std::vector<std::string>{"out.glb"});
    const json info = InfoOf(folder.File("out.glb"));
    EXPECT_EQ(info["stop_reason"], "interrupted");
    EXPECT_GT(info["residual"].get<double>(), 1e-3);
  }
}

TEST(InterruptTest, TimeLimitSavesAReadableSolution) {
  const ScratchFolder folder;
  auto arguments = LongSolve(folder.File("out.glb"));
  arguments.insert(arguments.end(), {"--max-seconds", "0.3"});
  const ProgramResult r = RunQuietly(arguments);
  EXPECT_EQ(r.exit_code, 3);
  EXPECT_THAT(r.err, HasSubstr("time limit"));
  EXPECT_EQ(InfoOf(folder.File("out.glb"))["stop_reason"], "time limit");
}

TEST(InterruptTest, AStopBeforeAnyLightIsSolvedSavesSomethingThatRendersAndGoesOn) {
  const ScratchFolder folder;
  const std::string out = folder.File("out.glb"), whole = folder.File("whole.glb");
  const auto start = std::chrono::steady_clock::now();
  // A mesh of two million elements takes seconds; within them it is not there yet.
  const ProgramResult r = RunQuietly(
      {"solve", ScenePath("cornell_diffuse"), "-o", out, "--edge", "0.03", "--max-seconds", "0.1"});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(r.exit_code, 3) << r.err;
  EXPECT_LT(took.count(), 2.0) << "stops within about a second";
  const json info = InfoOf(out);
  EXPECT_EQ(info["stop_reason"], "time limit");
  EXPECT_EQ(info["history"].size(), 0u);
  EXPECT_LT(info["ledger"]["closure"], 1e-9) << "all that is emitted is unshot";
  EXPECT_EQ(
      RunQuietly({"render", out, "-o", folder.File("a.png"), "--size", "16x16", "--spp", "1"}).exit_code, 0);
  // Going on is starting over.
  EXPECT_EQ(RunQuietly({"solve", "--resume", out, "--max-seconds", "0.1"}).exit_code, 3);
}

/// "... light ..., 123 nodes, 1.2 million rays (3 million/s), 8 s, about 2 min 5 s left"
TEST(InterruptTest, ProgressTellsPhasePowerNodesRaysAndTimeLeft) {
  const ScratchFolder folder;
  const ProgramResult r =
      RunLobe({"solve", ScenePath("cornell_diffuse"), "-o", folder.File("out.glb"), "--edge", "0.5",
               "--refine-error", "0", "--transport", "shooting", "--step-fraction", "0.1", "--delta-areas",
               "2048", "--residual", "1e-6", "--max-seconds", "5"});  // plain lines come every two seconds
  EXPECT_THAT(r.err, HasSubstr("needs about "));
  EXPECT_THAT(r.err, ::testing::ContainsRegex(
                         "bounce [0-9]+ \\([0-9]+ %\\), [0-9.e-]+ % of the power still moving, [0-9]+ nodes, "
                         "[0-9.e+]+ million rays \\([0-9.e+]+ million/s\\), [0-9]+ s, about [0-9].* left"));
}

TEST(InterruptTest, StepLimitSavesWhatTheStepsDid) {
  const ScratchFolder folder;
  const ProgramResult r =
      RunQuietly({"solve", ScenePath("cornell_diffuse"), "-o", folder.File("out.glb"), "--edge", "2",
                  "--light-samples", "4", "--delta-areas", "16", "--max-steps", "2"});
  EXPECT_EQ(r.exit_code, 3);
  EXPECT_THAT(r.err, HasSubstr("after 2 steps"));
  const json info = InfoOf(folder.File("out.glb"));
  ASSERT_EQ(info["history"].size(), 3u) << "emission and two steps";
  EXPECT_LT(info["history"][2]["residual"], info["history"][1]["residual"]);
}

TEST(InterruptTest, ASecondInterruptEndsTheProgramAtOnce) {
  const ScratchFolder folder;
  ProgramOptions options;
  bool sent = false;
  options.on_stderr = [&](pid_t child, const std::string& err) {
    if (sent || err.find("cameras:") == std::string::npos) return;
    sent = true;
    // Blocked together they would merge into one; the pause lets the first arrive. Were it to come late
    // all the same, the program would save and exit with 3.
    kill(child, SIGINT);
    usleep(20000);
    kill(child, SIGINT);
  };
  auto arguments = LongSolve(folder.File("out.glb"));
  const ProgramResult r = RunLobe(arguments, options);
  EXPECT_TRUE(r.exit_code == 128 + SIGINT || r.exit_code == 3) << r.exit_code;
  for (const std::string& entry : folder.Entries()) {
    EXPECT_TRUE(entry == "out.glb" || r.exit_code != 3) << entry;
  }
}

}  // namespace
}  // namespace lobe::test
