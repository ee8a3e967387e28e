#include "solver/time_left.h"

#include <cmath>

#include <gtest/gtest.h>

namespace lobe {
namespace {

/// A tenth of the power stays with every step of `pace` seconds, after emission of 100 s.
std::vector<StepRecord> Tenths(int steps, double pace) {
  std::vector<StepRecord> history;
  for (int i = 0; i <= steps; ++i) history.push_back({i, std::pow(0.1, i), 100 + i * pace, 0, 0});
  return history;
}

SolveOptions DownTo(double residual) {
  SolveOptions o;
  o.residual = residual;
  return o;
}

TEST(TimeLeftTest, StepsToComeAreLikeTheLastOnes) {
  const SolveOptions o = DownTo(0.5e-6);
  EXPECT_NEAR(SecondsLeft(Tenths(2, 8), o, 0, 116).value(), 5 * 8, 1e-9);
  EXPECT_NEAR(SecondsLeft(Tenths(4, 8), o, 0, 132).value(), 3 * 8, 1e-9);
  EXPECT_NEAR(SecondsLeft(Tenths(4, 8), o, 0.75, 138).value(), 2.25 * 8, 1e-9);
  EXPECT_EQ(SecondsLeft(Tenths(7, 8), o, 0.5, 160), 0);
}

TEST(TimeLeftTest, NothingIsSaidBeforeItCanBe) {
  EXPECT_FALSE(SecondsLeft({}, DownTo(1e-3), 0.5, 1));
  EXPECT_FALSE(SecondsLeft(Tenths(0, 8), DownTo(1e-3), 0.5, 1));
  EXPECT_FALSE(SecondsLeft(Tenths(1, 8), DownTo(1e-3), 0.5, 1)) << "one step may be unlike the others";
  std::vector<StepRecord> stuck = Tenths(4, 8);
  for (StepRecord& r : stuck) r.residual = 0.5;
  EXPECT_FALSE(SecondsLeft(stuck, DownTo(1e-3), 0.5, 1));
}

TEST(TimeLeftTest, LimitsEndItSooner) {
  SolveOptions o = DownTo(0.5e-9);
  ASSERT_NEAR(SecondsLeft(Tenths(4, 8), o, 0, 132).value(), 6 * 8, 1e-9);
  o.max_steps = 5;
  EXPECT_NEAR(SecondsLeft(Tenths(4, 8), o, 0, 132).value(), 8, 1e-9);
  o.max_seconds = 135;
  EXPECT_NEAR(SecondsLeft(Tenths(4, 8), o, 0, 132).value(), 3, 1e-9);
  EXPECT_EQ(SecondsLeft(Tenths(4, 8), o, 0, 140), 0);
}

}  // namespace
}  // namespace lobe
