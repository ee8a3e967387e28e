// What a solution's own record says about it, as a user meets it: solver/trust.h.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "solver/solution.h"
#include "solver/trust.h"
#include "tests/app/program.h"
#include "tests/support/scratch_folder.h"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class TrustTest : public ::testing::Test {
 protected:
  std::string File(const std::string& name) const { return folder_.File(name); }
  // A small solution whose record is changed as told.
  template <typename Change>
  std::string Changed(const std::string& name, const Change& change) {
    const std::string path = File(name);
    SolveCoarsely("cornell_diffuse", path);
    Solution s = ReadSolution(path);
    s.stop_reason = StopReason::kConverged;
    s.ledger.imbalance = {};
    change(s);
    WriteSolution(s, path);
    return path;
  }
  static void Imbalance(Solution& s, double fraction) {
    for (int c = 0; c < 3; ++c) s.ledger.imbalance[c] = -fraction * s.ledger.delivered[c];
  }
  ProgramResult Render(const std::string& solution, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"render", solution, "-o",    File("view.exr"),
                                          "--size", "16x16",  "--spp", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunLobe(arguments);
  }
  ScratchFolder folder_;
};

TEST_F(TrustTest, WhatDidNotConvergeIsNotRenderedUnlessAskedFor) {
  const std::string path = Changed("grew.glb", [](Solution& s) {
    s.stop_reason = StopReason::kNotConverging;
    s.history.back().residual = 2.5;
    Imbalance(s, 0.2);
  });
  ProgramResult r = Render(path);
  EXPECT_EQ(r.exit_code, 1);
  EXPECT_THAT(r.err, HasSubstr("did not converge"));
  EXPECT_THAT(r.err, HasSubstr("250 %"));
  EXPECT_THAT(r.err, HasSubstr("20 %"));
  EXPECT_THAT(r.err, HasSubstr("--unconverged"));
  EXPECT_FALSE(std::filesystem::exists(File("view.exr")));
  r = Render(path, {"--unconverged"});
  EXPECT_EQ(r.exit_code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("did not converge"));
  EXPECT_EQ(Render(path, {"--mode", "path"}).exit_code, 0) << "no lobe is read";
  for (const char* command : {"info", "inspect"}) {
    std::vector<std::string> arguments = {command, path};
    if (command == std::string("inspect")) arguments.insert(arguments.end(), {"--node", "0"});
    const ProgramResult said = RunLobe(arguments);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    EXPECT_THAT(said.err, HasSubstr("did not converge")) << command;
  }
}

TEST_F(TrustTest, WhatWasStoppedRendersAndSaysHowMuchIsMissing) {
  for (const StopReason reason : {StopReason::kTimeLimit, StopReason::kStepLimit, StopReason::kInterrupted}) {
    const std::string path = Changed("stopped.glb", [&](Solution& s) {
      s.stop_reason = reason;
      s.history.back().residual = 0.25;
    });
    const ProgramResult r = Render(path);
    EXPECT_EQ(r.exit_code, 0) << r.err;
    EXPECT_THAT(r.err, HasSubstr("25 % of the emitted power is unshot"));
  }
}

TEST_F(TrustTest, ASoundSolutionIsRenderedInSilence) {
  const std::string path = Changed("sound.glb", [](Solution& s) { Imbalance(s, 0.02); });
  const ProgramResult r = Render(path, {"--quiet"});
  EXPECT_EQ(r.exit_code, 0);
  EXPECT_EQ(r.err, "");
}

TEST_F(TrustTest, TheBoundsOfTheImbalanceAreThreeAndTenPercent) {
  const auto judge = [&](double imbalance) {
    return JudgeSolution(ReadSolution(Changed("mesh.glb", [&](Solution& s) { Imbalance(s, imbalance); })));
  };
  EXPECT_EQ(judge(0.029), Trust::kSound);
  EXPECT_EQ(judge(0.031), Trust::kCoarse);
  EXPECT_EQ(judge(0.099), Trust::kCoarse);
  EXPECT_EQ(judge(0.101), Trust::kWrong);
}

// Nodes at the corners of the room alone see little of what goes on in it.
TEST_F(TrustTest, AMeshThatIsFarTooCoarseEndsWithFourAndItsFileIsSaved) {
  const ProgramResult r = RunLobe({"solve", ScenePath("cornell_glossy"), "-o", File("coarse.glb"), "--edge",
                                   "100", "--refine-error", "0", "--contact-distance", "0", "--json"});
  ASSERT_TRUE(std::filesystem::exists(File("coarse.glb"))) << r.err;
  const auto json = nlohmann::json::parse(r.out);
  const double imbalance = json["ledger"]["relative_imbalance"].get<double>();
  RecordProperty("imbalance", std::to_string(imbalance));
  EXPECT_EQ(r.exit_code, imbalance > kWrongImbalance ? 4 : 0);
  EXPECT_EQ(json["trust"], imbalance > kWrongImbalance    ? "wrong"
                           : imbalance > kCoarseImbalance ? "coarse"
                                                          : "sound");
  if (imbalance > kCoarseImbalance) EXPECT_THAT(r.err, HasSubstr("--edge"));
}

}  // namespace
}  // namespace lobe::test
