#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/solver.h"
#include "tests/support/gloss_furnace.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

// Closed room in which every wall emits 1 and reflects rho: radiance is the series 1 + rho + rho^2 + ...
Scene Furnace(float albedo, bool with_block = false) {
  SceneBuilder b;
  const uint32_t wall = b.AddMaterial("wall", Lambert{Rgb::Constant(albedo)}, Rgb::Constant(1));
  b.AddBox({0, 0, 0}, {4, 3, 5}, wall, /*inward=*/true);
  if (with_block) b.AddBox({1, 1, 1}, {2, 2, 2}, wall);
  return b.Build();
}

struct Radiance {
  double mean = 0, worst = 0;  // worst: largest deviation of a node from `expected`
};
Radiance MeanRadiance(const Solution& s, double expected) {
  const auto area = NodeAreas(s.mesh, s.hidden);
  Radiance out;
  double sum = 0;
  for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
    const double radiance = 1 + s.total.Flux(n)[1] / std::numbers::pi;
    out.mean += area[n] * radiance;
    sum += area[n];
    out.worst = std::max(out.worst, std::abs(radiance - expected));
  }
  out.mean /= sum;
  return out;
}

SolveOptions Coarse() {
  SolveOptions o;
  o.mesh.max_edge = 0.6f;
  o.residual = 1e-5;
  return o;
}

TEST(FurnaceTest, ClosedRoomReachesEmissionOverOneMinusAlbedo) {
  const auto r = MeanRadiance(Solve(Furnace(0.5f), Coarse()), 2);
  EXPECT_NEAR(r.mean, 2, 0.002);
  EXPECT_LT(r.worst, 0.02) << "corners are the hard part";
}

TEST(FurnaceTest, OccludersDoNotTakeLightAway) {
  const auto r = MeanRadiance(Solve(Furnace(0.5f, true), Coarse()), 2);
  EXPECT_NEAR(r.mean, 2, 0.01);
}

TEST(FurnaceTest, KStepsEqualKTermsOfTheSeries) {
  double expected = 1, term = 1;
  for (int k = 0; k <= 4; ++k) {
    expected += term *= 0.7;
    SolveOptions o = Coarse();
    o.mesh.max_edge = 1;
    o.accelerate = false;
    o.max_steps = k;
    o.residual = 1e-9;
    const Solution s = Solve(Furnace(0.7f), o);
    EXPECT_EQ(s.stop_reason, StopReason::kStepLimit);
    EXPECT_NEAR(MeanRadiance(s, 0).mean, expected, 0.004 * expected) << k << " steps";
  }
}

TEST(FurnaceTest, AWhiteClosedRoomStopsAndSaysWhy) {
  SolveOptions o = Coarse();
  o.mesh.max_edge = 2;
  const Solution s = Solve(Furnace(1.0f), o);
  EXPECT_EQ(s.stop_reason, StopReason::kNotConverging);
}

void ExpectGlossFurnace(const Reflectance& reflectance, const char* name) {
  const test::GlossFurnace furnace(reflectance);
  EXPECT_GT(furnace.worst, 0) << "the block has nodes";
  EXPECT_LT(furnace.worst, furnace.stated) << name;
}

TEST(FurnaceTest, GlossyBlockShowsItsDirectionalAlbedo) {
  for (const float roughness : {1.0f, 0.5f, 0.3f}) {
    MetallicRoughness r;
    r.base_color = Rgb(0.9f, 0.8f, 0.7f);
    r.metallic = 1;
    r.roughness = roughness;
    ExpectGlossFurnace(r, "metal");
    r.metallic = 0;
    r.base_color = Rgb::Constant(0.5f);
    ExpectGlossFurnace(r, "dielectric");
  }
  ExpectGlossFurnace(Phong{Rgb::Constant(0.8f), 20}, "phong 20");
}

}  // namespace
}  // namespace lobe
