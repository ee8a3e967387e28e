#include "solver/unsettled.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "solver/solver.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

// Two diffuse boxes in a room, one of them dark.
Scene Room() {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {3, 3, 3}, b.AddLambert(Rgb(0.8f, 0.7f, 0.5f)), true);
  b.AddQuad({1, 2.9f, 1}, {2, 2.9f, 1}, {2, 2.9f, 2}, {1, 2.9f, 2}, b.AddEmitter(Rgb::Constant(10)));
  b.AddBox({0.4f, 0, 0.5f}, {1.3f, 1.5f, 1.4f}, b.AddLambert(Rgb::Constant(0.6f)));
  b.AddBox({1.8f, 0, 1.5f}, {2.6f, 0.8f, 2.4f}, b.AddLambert(Rgb::Zero()));
  return b.Build();
}

Solution AfterSteps(int steps) {
  SolveOptions o;
  o.mesh.max_edge = 0.5f;
  o.refine.rounds = 0;
  o.links = 128;
  o.accelerate = false;
  o.residual = 1e-9;
  o.max_steps = steps;
  return Solve(Room(), o);
}

double Unsettled(const Solution& s, double fraction) {
  return UnsettledArea(s.total, s.unshot, NodeAreas(s.mesh, s.hidden), fraction);
}

TEST(UnsettledAreaTest, IsAllOfWhatReflectsAtFirstAndNothingOfWhatIsShot) {
  Solution s = AfterSteps(0);
  EXPECT_EQ(Unsettled(s, 0.99), 1) << "all that came is unshot, and what is black does not count";
  EXPECT_EQ(Unsettled(s, 1), 0);
  s.unshot.SetZero();
  EXPECT_EQ(Unsettled(s, 0), 0);
}

TEST(UnsettledAreaTest, IsTheShareOfTheNodesThatAreNot) {
  Solution s = AfterSteps(3);
  const auto area = NodeAreas(s.mesh, s.hidden);
  s.unshot.SetZero();
  double all = 0, some = 0;
  for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
    if (area[n] == 0 || s.total.Flux(n).sum() == 0) continue;
    all += area[n];
    if (n % 3 != 0) continue;
    some += area[n];
    // Shot too much of it: that counts as much as too little.
    for (int c = 0; c < 3; ++c) s.unshot.base(n)[c] = (n % 2 ? 0.1f : -0.1f) * s.total.base(n)[c];
  }
  EXPECT_NEAR(Unsettled(s, 0.09), some / all, 1e-12);
  EXPECT_EQ(Unsettled(s, 0.11), 0);
}

// The promise of the header, which makes it sensible to go on with plain sweeps until light is settled.
TEST(UnsettledAreaTest, APlainSweepNeverEnlargesTheLargestFraction) {
  double before = 1;
  for (int steps = 1; steps <= 8; ++steps) {
    const Solution s = AfterSteps(steps);
    double largest = 0;
    for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
      const double all = s.total.Flux(n).sum();
      if (all > 0) largest = std::max(largest, s.unshot.Flux(n).sum() / all);
    }
    constexpr double kFloat = 1e-5;
    EXPECT_LE(largest, before * (1 + kFloat)) << steps;
    before = largest;
  }
  EXPECT_LT(before, 0.5);
}

}  // namespace
}  // namespace lobe
