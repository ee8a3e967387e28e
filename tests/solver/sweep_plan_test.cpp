#include "solver/sweep_plan.h"

#include <gtest/gtest.h>

namespace lobe {
namespace {

std::vector<StepRecord> History(const std::vector<double>& residuals) {
  std::vector<StepRecord> history;
  for (const double residual : residuals)
    history.push_back({.step = int(history.size()), .residual = residual});
  return history;
}
SweepPlan PlanAfter(const std::vector<double>& residuals, const SolveOptions& options = {}) {
  return PlanSweep(History(residuals), options);
}

TEST(SweepPlanTest, TheFirstSweepIsPlainAndShootingAheadGoesOnWhileItPays) {
  EXPECT_EQ(PlanAfter({1}).ahead, 0);
  EXPECT_EQ(PlanAfter({1, 0.6}).ahead, 1);
  EXPECT_EQ(PlanAfter({1, 0.6, 0.3}).ahead, 1);
}

TEST(SweepPlanTest, APlainSweepFollowsAFailureAndTheNextShootsHalfAsFarAhead) {
  EXPECT_EQ(PlanAfter({1, 0.6, 0.6}).ahead, 0);
  EXPECT_EQ(PlanAfter({1, 0.6, 0.6, 0.4}).ahead, 0.5f);
}

// At most the steps of plain sweeps and few more.
TEST(SweepPlanTest, AfterTwoFailuresAllSweepsArePlain) {
  const std::vector<double> failures = {1, 0.9, 0.9, 0.81, 0.81, 0.73};
  EXPECT_EQ(PlanAfter(failures).ahead, 0);
  int taken_back = 0;
  std::vector<double> residuals = {1};
  for (int step = 1; step < 60; ++step) {
    const bool fails = PlanAfter(residuals).ahead > 0;
    taken_back += fails;
    residuals.push_back(residuals.back() * (fails ? 1 : 0.9));
  }
  EXPECT_EQ(taken_back, SweepPlan::kMostFailures);
}

TEST(SweepPlanTest, SolvesOfFewStepsBearWithWhatHalvesTheResidual) {
  EXPECT_EQ(PlanAfter({1, 0.05, 0.01, 0.002}).ahead, 1) << "0.2 is more than 0.05, but enough";
}

TEST(SweepPlanTest, OneSlowSweepMayBeMadeUpForTwoAreAFailure) {
  EXPECT_EQ(PlanAfter({1, 0.6, 0.5}).ahead, 1);
  EXPECT_EQ(PlanAfter({1, 0.6, 0.5, 0.1}).ahead, 1);
  EXPECT_EQ(PlanAfter({1, 0.6, 0.5, 0.4}).ahead, 0);
  EXPECT_EQ(PlanAfter({1, 0.6, 0.6, 0.36, 0.3}).ahead, 0) << "after a failure, one is";
}

TEST(SweepPlanTest, PlainSweepsThatGrowLowerTheDegreeUntilAllIsDiffuse) {
  SolveOptions plain;
  plain.accelerate = false;
  std::vector<double> residuals = {1};
  int cap = PlanAfter(residuals, plain).degree_cap;
  for (int step = 0; step < 8; ++step) {
    residuals.push_back(residuals.back() * 1.1);
    const int next = PlanAfter(residuals, plain).degree_cap;
    EXPECT_TRUE(next < cap || next == 0) << "step " << step;
    cap = next;
  }
  EXPECT_EQ(cap, 0);
  residuals.push_back(residuals.back() * 0.5);
  EXPECT_EQ(PlanAfter(residuals, plain).degree_cap, 0) << "and it stays";
}

TEST(SweepPlanTest, DimLightTakesFewerLinksUnlessSomethingGrew) {
  EXPECT_EQ(PlanAfter({1, 0.5}).thinning, 1);
  EXPECT_EQ(PlanAfter({1, 0.5, 0.2}).thinning, 2);
  EXPECT_EQ(PlanAfter({1, 0.5, 0.2, 0.02}).thinning, 8);
  EXPECT_EQ(PlanAfter({1, 1.1, 0.2, 0.02}).thinning, 1);
  SolveOptions plain;
  plain.accelerate = false;
  EXPECT_EQ(PlanAfter({1, 0.5, 0.2, 0.02}, plain).thinning, 1);
}

}  // namespace
}  // namespace lobe
