// A room in two halves, one far brighter. What one half gains or loses for the other's sake is judged by its
// own brightness.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "solver/solver.h"
#include "tests/support/metal.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using namespace test;

constexpr float kWall = 3, kSize = 6, kHeight = 3;

struct Halves {
  float contrast = 1000;                           // of the lamps
  float under = 0.0005f, over = 0.0005f;           // the wall is so much short of floor and ceiling
  Reflectance dim = Lambert{Rgb::Constant(0.7f)};  // of the half beyond the wall
  float bright = 0.7f;                             // albedo of the other
  bool one_piece = true;                           // floor, ceiling and walls reach through both halves
};

// The bright lamp can be left out.
Scene Build(const Halves& h, bool bright_lamp = true) {
  SceneBuilder b;
  const uint32_t near = b.AddLambert(Rgb::Constant(h.bright)), far = b.AddMaterial("dim", h.dim);
  if (h.one_piece) {
    b.AddBox({0, 0, 0}, {kSize, kHeight, kSize}, far, /*inward=*/true);
  } else {
    b.AddBox({0, 0, 0}, {kSize, kHeight, kWall}, near, /*inward=*/true);
    b.AddBox({0, 0, kWall + 0.1f}, {kSize, kHeight, kSize}, far, /*inward=*/true);
  }
  const auto lamp = [&](float z, float radiance) {
    const uint32_t glow = b.AddEmitter(Rgb::Constant(radiance));
    b.AddQuad({2.5f, 2.9f, z}, {3.5f, 2.9f, z}, {3.5f, 2.9f, z + 0.5f}, {2.5f, 2.9f, z + 0.5f}, glow);
  };
  if (bright_lamp) lamp(1.25f, h.contrast);
  lamp(4.25f, 1);
  if (h.one_piece) b.AddBox({0, h.under, kWall}, {kSize, kHeight - h.over, kWall + 0.1f}, near);
  return b.Build();
}

SolveOptions Coarse() {
  SolveOptions o;
  o.mesh.max_edge = 0.75f;
  o.refine.rounds = 0;
  o.links = 256;
  o.light_samples = 16;
  o.thin_late_links = false;  // a few links see what leaks past the wall: an eighth of them would be noise
  return o;
}

// Plain sweeps to the end: what every solve on this mesh should come to.
SolveOptions Settled(SolveOptions o) {
  o.accelerate = false;
  o.residual = 1e-9;
  return o;
}

// Reflected in the dim half, watts.
double DimPower(const Solution& s) {
  const auto area = NodeAreas(s.mesh, s.hidden);
  double sum = 0;
  for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
    if (s.mesh.node_position[n].z() > kWall + 0.11f) sum += double(s.total.Flux(n).sum()) * area[n];
  }
  return sum;
}

// At 1.5 % of a place's light (solver.cpp, kMostLeft) a solve may end, and 0.7 / (1 - 0.7) of that is still to
// come.
constexpr double kUnsettled = 0.07;
constexpr double kTakenAway = 0.03;

void ExpectDimHalfIsRight(const Halves& h, const std::string& what) {
  const double alone = DimPower(Solve(Build(h, /*bright_lamp=*/false), Settled(Coarse())));
  const double settled = DimPower(Solve(Build(h), Settled(Coarse())));
  const Solution s = Solve(Build(h), Coarse());
  EXPECT_EQ(s.stop_reason, StopReason::kConverged) << what;
  const double got = DimPower(s);
  EXPECT_GT(got, (1 - kTakenAway) * alone) << what << ": light taken away";
  EXPECT_NEAR(got / settled, 1, kUnsettled) << what;
}

TEST(DimHalfTest, IsRightWhateverTheContrast) {
  for (const float contrast : {10.0f, 100.0f, 1e3f, 1e4f, 1e5f, 1e6f}) {
    Halves h;
    h.contrast = contrast;
    ExpectDimHalfIsRight(h, "contrast " + std::to_string(contrast));
  }
}

TEST(DimHalfTest, IsRightWhateverTheGap) {
  for (const float gap : {0.0f, 0.0001f, 0.001f, 0.005f}) {
    Halves h;
    h.under = h.over = gap;
    ExpectDimHalfIsRight(h, "gap " + std::to_string(gap));
  }
  Halves below, above;
  below.over = above.under = 0;
  ExpectDimHalfIsRight(below, "gap at the floor");
  ExpectDimHalfIsRight(above, "gap at the ceiling");
}

// The bright half settles in a few steps; its own end is not the end.
TEST(DimHalfTest, IsRightWhereItReflectsMoreThanTheBrightHalf) {
  Halves h;
  h.one_piece = false;
  h.bright = 0.3f;
  h.dim = Lambert{Rgb::Constant(0.9f)};
  ExpectDimHalfIsRight(h, "dim half of albedo 0.9 beside one of 0.3");
}

TEST(DimHalfTest, IsRightWhereItIsOfMetal) {
  Halves h;
  h.one_piece = false;
  h.dim = Metal(0.5f, Rgb::Constant(0.8f));
  ExpectDimHalfIsRight(h, "metal");
}

TEST(DimHalfTest, IsBlackWithoutLightOfItsOwn) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {kSize, kHeight, kSize}, b.AddLambert(Rgb::Constant(0.7f)), /*inward=*/true);
  b.AddBox({0, 0, kWall}, {kSize, kHeight, kWall + 0.1f}, b.AddLambert(Rgb::Constant(0.7f)));
  b.AddQuad({2.5f, 2.9f, 1}, {3.5f, 2.9f, 1}, {3.5f, 2.9f, 2}, {2.5f, 2.9f, 2},
            b.AddEmitter(Rgb::Constant(1000)));
  EXPECT_EQ(DimPower(Solve(b.Build(), Coarse())), 0);
}

}  // namespace
}  // namespace lobe
