#include "solver/solver.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "scene/gltf_scene.h"
#include "scene/input_error.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

MetallicRoughness Metal(float roughness) {
  MetallicRoughness r;
  r.base_color = Rgb(0.9f, 0.9f, 0.9f);
  r.metallic = 1;
  r.roughness = roughness;
  return r;
}

// A closed room with a lamp under the ceiling and a block standing on the floor.
struct Room {
  Scene scene;
  uint32_t block, wall;
};
Room MakeRoom(const Reflectance& block_material) {
  SceneBuilder b;
  const uint32_t white = b.AddLambert(Rgb(0.7f, 0.6f, 0.5f));
  const uint32_t lamp = b.AddEmitter(Rgb::Constant(10));
  const uint32_t block = b.AddMaterial("block", block_material);
  b.AddBox({0, 0, 0}, {3, 3, 3}, white, true);
  b.AddQuad({1, 2.9f, 1}, {2, 2.9f, 1}, {2, 2.9f, 2}, {1, 2.9f, 2}, lamp);
  b.AddBox({0.5f, 0, 0.5f}, {1.5f, 1.5f, 1.5f}, block);
  return {b.Build(), block, white};
}

SolveOptions Coarse() {
  SolveOptions o;
  o.mesh.max_edge = 0.5f;
  o.light_samples = 32;
  o.delta_areas = 96;
  return o;
}

bool SameBits(const NodeLobes& a, const NodeLobes& b) {
  for (uint32_t p = 0; p < a.patch_count(); ++p) {
    const auto x = a.patch_values(p), y = b.patch_values(p);
    if (x.size() != y.size() || std::memcmp(x.data(), y.data(), x.size_bytes()) != 0) return false;
  }
  return a.patch_count() == b.patch_count();
}

TEST(SolverTest, GivesTheSameBitsForAnyNumberOfThreads) {
  const Scene scene = MakeRoom(Metal(0.4f)).scene;
  std::vector<Solution> solutions;
  for (const int threads : {1, 2, 7}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena(threads);
    arena.execute([&] { solutions.push_back(Solve(scene, Coarse())); });
  }
  for (int i = 1; i < 3; ++i) {
    EXPECT_TRUE(SameBits(solutions[0].total, solutions[i].total));
    EXPECT_TRUE(SameBits(solutions[0].unshot, solutions[i].unshot));
    EXPECT_EQ(solutions[0].ledger.absorbed, solutions[i].ledger.absorbed);
  }
}

TEST(SolverTest, ADiffuseSceneStoresThreeFloatsANodeAndNeverTouchesALobe) {
  TimeSplit work;
  SolveControl control;
  control.time_split = &work;
  const Solution s = Solve(MakeRoom(Lambert{Rgb::Constant(0.5f)}).scene, Coarse(), control);
  size_t floats = 0;
  for (uint32_t p = 0; p < s.total.patch_count(); ++p) floats += s.total.patch_values(p).size();
  EXPECT_EQ(floats, 3 * s.mesh.node_count());
  EXPECT_EQ(work.lobe_reads, 0u);
  EXPECT_EQ(work.lobe_writes, 0u);
  // And the counters can count:
  Solve(MakeRoom(Metal(0.5f)).scene, Coarse(), control);
  EXPECT_GT(work.lobe_reads, 0u);
  EXPECT_GT(work.lobe_writes, 0u);
}

// A lobe of degree 0 is a glossy node that happens to be constant: its albedo still depends on the angle.
TEST(SolverTest, DegreeZeroReducesToRadiosityWithTheSameEnergy) {
  const auto reflected = [](int l_max, const Reflectance& r) {
    SolveOptions o = Coarse();
    o.lobes.l_max = l_max;
    o.max_steps = 0;
    return Solve(MakeRoom(r).scene, o).ledger.reflected[0];
  };
  for (const float metallic : {0.0f, 1.0f}) {
    MetallicRoughness r = Metal(0.4f);
    r.metallic = metallic;
    EXPECT_NEAR(reflected(0, r), reflected(12, r), 0.01 * reflected(12, r));
  }
}

TEST(SolverTest, LedgerClosesAndImbalanceIsSmall) {
  for (const Reflectance& r : {Reflectance(Lambert{}), Reflectance(Metal(0.4f))}) {
    const Solution s = Solve(MakeRoom(r).scene, Coarse());
    EXPECT_LT(s.ledger.Closure(), 1e-5);
    EXPECT_LT(s.ledger.RelativeImbalance(), 0.05);
    double emitted = 0, truncated = 0;
    for (int c = 0; c < 3; ++c) {
      emitted += s.ledger.emitted[c];
      truncated += std::abs(s.ledger.truncated[c]);
      EXPECT_NEAR(s.ledger.emitted[c], std::numbers::pi * 10, 1e-4);
    }
    EXPECT_LT(truncated / emitted, 1e-4) << "the lobes' flux is the albedo's";
  }
}

TEST(SolverTest, ImbalanceFallsUnderRefinement) {
  const Scene scene = MakeRoom(Lambert{}).scene;
  double before = 1;
  for (const float edge : {1.0f, 0.25f}) {
    SolveOptions o;
    o.mesh.max_edge = edge;
    o.max_steps = 0;
    o.light_samples = 256;
    const double imbalance = Solve(scene, o).ledger.RelativeImbalance();
    EXPECT_LT(imbalance, before);
    before = imbalance;
  }
  EXPECT_LT(before, 0.01);
}

TEST(SolverTest, AnOpenSceneLosesWhatEscapes) {
  SceneBuilder b;
  const uint32_t lamp = b.AddEmitter(Rgb::Constant(1));
  const uint32_t floor = b.AddLambert(Rgb::Constant(0.5f));
  b.AddQuad({-0.5f, 1, -0.5f}, {0.5f, 1, -0.5f}, {0.5f, 1, 0.5f}, {-0.5f, 1, 0.5f}, lamp);  // looks down
  b.AddQuad({-0.5f, 0, -0.5f}, {-0.5f, 0, 0.5f}, {0.5f, 0, 0.5f}, {0.5f, 0, -0.5f}, floor);
  SolveOptions o;
  o.mesh.max_edge = 0.1f;
  const Solution s = Solve(b.Build(), o);
  // Form factor of parallel unit squares one metre apart: 0.19982 (Howell C-11); the lamp is black.
  EXPECT_NEAR(s.ledger.escaped[0], std::numbers::pi * ((1 - 0.19982) + 0.19982 * 0.5 * (1 - 0.19982)), 0.03);
  EXPECT_NEAR(s.ledger.delivered[0], std::numbers::pi * (0.19982 + 0.19982 * 0.5 * 0.19982), 0.01);
  EXPECT_LT(s.ledger.Closure(), 1e-5);
}

// One lamp in a closed room, one of another colour in the void: each channel's power is its own lamp's.
TEST(SolverTest, WhatEscapesHasTheColourOfItsLamp) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {2, 2, 2}, b.AddLambert(Rgb::Constant(0.5f)), true);
  b.AddQuad({0.5f, 1.9f, 0.5f}, {1.5f, 1.9f, 0.5f}, {1.5f, 1.9f, 1.5f}, {0.5f, 1.9f, 1.5f},
            b.AddEmitter(Rgb(1, 0, 0)));
  b.AddQuad({9, 1, 0}, {10, 1, 0}, {10, 1, 1}, {9, 1, 1}, b.AddEmitter(Rgb(0, 0, 1)));
  const Ledger ledger = Solve(b.Build(), Coarse()).ledger;
  EXPECT_EQ(ledger.escaped[0], 0);
  EXPECT_NEAR(ledger.escaped[2] + ledger.blocked[2], ledger.emitted[2], 1e-12) << "some meets the room";
  EXPECT_LT(ledger.RelativeImbalance(), 0.05);
}

// A mirror in a room whose walls emit 1: the mean of Schlick's Fresnel over projected solid angle is
// f0 + (1 - f0) / 21, and irradiance is pi.
TEST(SolverTest, LedgerCountsWhatMirrorsReflect) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {2, 2, 2}, b.AddEmitter(Rgb::Constant(1)), true);
  b.AddQuad({0.5f, 0.1f, 0.5f}, {0.5f, 0.1f, 1.5f}, {1.5f, 0.1f, 1.5f}, {1.5f, 0.1f, 0.5f},
            b.AddMaterial("mirror", Metal(0)));
  SolveOptions o = Coarse();
  o.light_samples = 256;
  const Scene scene = b.Build();
  const Ledger ledger = Solve(scene, o).ledger;
  // 0.2 %: directions stand for delta areas, and Fresnel is convex.
  EXPECT_NEAR(ledger.passed_on[0], std::numbers::pi * (0.9 + 0.1 / 21), 0.006);
  EXPECT_EQ(ledger.mirrored[0], 0);
  EXPECT_LT(ledger.Closure(), 1e-5);
  o.transport = Transport::kShooting;
  const Ledger stopped = Solve(scene, o).ledger;
  EXPECT_NEAR(stopped.mirrored[0], std::numbers::pi * (0.9 + 0.1 / 21), 0.006);
  EXPECT_EQ(stopped.passed_on[0], 0);
  EXPECT_LT(stopped.Closure(), 1e-5);
}

// Portions make the shot field patchy and delta areas stand for it less well: 1.2 % of the light is lost at
// 96 delta areas, 0.1 % at 1536 (docs/validation.md#step-fraction).
// Two rooms with one floor, one ceiling and two long walls, parted by a sheet without thickness.
TEST(SolverTest, NoLightGetsUnderAThinWall) {
  SceneBuilder b;
  const uint32_t white = b.AddLambert(Rgb::Constant(0.7f));
  b.AddBox({0, 0, 0}, {4, 2, 3}, white, true);
  constexpr float kSheet = 1.9f;
  b.AddQuad({kSheet, 0, 0}, {kSheet, 2, 0}, {kSheet, 2, 3}, {kSheet, 0, 3},
            b.AddMaterial("sheet", Lambert{Rgb::Constant(0.7f)}, Rgb::Zero(), true));
  b.AddQuad({0.5f, 1.9f, 1}, {1.5f, 1.9f, 1}, {1.5f, 1.9f, 2}, {0.5f, 1.9f, 2},
            b.AddEmitter(Rgb::Constant(10)));
  SolveOptions options = Coarse();
  const auto dark_and_light = [&] {
    const Solution s = Solve(b.Build(), options);
    double power[2] = {0, 0};
    const std::vector<uint8_t> none(s.hidden.size());
    const std::vector<double> area = NodeAreas(s.mesh, none);
    for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
      const float x = s.mesh.node_position[n].x();
      const bool dark = x > kSheet || (x == kSheet && s.mesh.node_sample_position[n].x() > kSheet);
      power[dark] += s.total.Flux(n).sum() * area[n];
    }
    return std::pair(power[1], power[0]);
  };
  const auto [dark, light] = dark_and_light();
  EXPECT_EQ(dark, 0);
  EXPECT_GT(light, 1);
  options.contact_distance = 0;
  EXPECT_GT(dark_and_light().first, 0) << "which it does over elements that lie in both rooms";
}

TEST(SolverTest, ShootingInPortionsReachesTheSameSolution) {
  const Scene scene = MakeRoom(Metal(0.5f)).scene;
  SolveOptions whole = Coarse();
  whole.transport = Transport::kShooting;
  whole.delta_areas = 1024;
  SolveOptions portions = whole;
  whole.residual = portions.residual = 1e-4;
  portions.step_fraction = 0.5;
  const Solution a = Solve(scene, whole), b = Solve(scene, portions);
  EXPECT_GT(b.history.size(), a.history.size());
  double sum = 0, difference = 0;
  const auto area = NodeAreas(a.mesh, a.hidden);
  for (uint32_t n = 0; n < a.mesh.node_count(); ++n) {
    sum += a.total.Flux(n).sum() * area[n];
    difference += (b.total.Flux(n).sum() - a.total.Flux(n).sum()) * area[n];
  }
  EXPECT_LT(std::abs(difference) / sum, 0.005);
}

TEST(SolverTest, DirectAndUnshotArePartsOfTheTotal) {
  SolveOptions o = Coarse();
  o.max_steps = 0;
  const Solution s = Solve(MakeRoom(Metal(0.5f)).scene, o);
  EXPECT_TRUE(SameBits(s.total, s.direct));
  EXPECT_TRUE(SameBits(s.total, s.unshot));
}

TEST(SolverTest, StopsWhenToldAndKeepsWholeSteps) {
  std::atomic<bool> stop{false};
  SolveControl control;
  control.stop = &stop;
  control.progress = [&](const Progress& p) {
    if (p.step == 2 && p.fraction_of_phase > 0.3 && p.fraction_of_phase < 1) stop = true;
  };
  SolveOptions o = Coarse();
  o.mesh.max_edge = 0.25f;
  const Solution stopped = Solve(MakeRoom(Metal(0.5f)).scene, o, control);
  EXPECT_EQ(stopped.stop_reason, StopReason::kInterrupted);
  const int steps = stopped.history.back().step;
  o.max_steps = steps;
  const Solution plain = Solve(MakeRoom(Metal(0.5f)).scene, o);
  EXPECT_TRUE(SameBits(stopped.total, plain.total));
  EXPECT_TRUE(SameBits(stopped.unshot, plain.unshot));
  EXPECT_LT(stopped.ledger.Closure(), 1e-5);
}

TEST(SolverTest, TimeLimitIsAResult) {
  SolveOptions o = Coarse();
  o.max_seconds = 1e-6;
  const Solution s = Solve(MakeRoom(Lambert{}).scene, o);
  EXPECT_EQ(s.stop_reason, StopReason::kTimeLimit);
  EXPECT_EQ(s.residual(), 1.0);
  EXPECT_LT(s.ledger.Closure(), 1e-5);
}

TEST(SolverTest, NoEmitterIsAnInputErrorNamingTheFile) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {1, 1, 1}, b.AddLambert(Rgb::Constant(0.5f)), true);
  Scene scene = b.Build();
  scene.path = "dark.glb";
  try {
    Solve(scene, Coarse());
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("dark.glb"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("no emitter"), std::string::npos);
  }
}

TEST(SolverTest, OptionsOutOfRangeSaySo) {
  SolveOptions o;
  o.mesh.max_edge = 0;
  EXPECT_NE(o.Validate(), "");
  EXPECT_THROW(Solve(Scene(), o), std::invalid_argument);
  EXPECT_EQ(SolveOptions().Validate(), "");
}

// Brushed metal throws the lamp's light up to the ceiling in a patch; a Lambertian of the same flux spreads
// it.
TEST(SolverTest, AMetalBlockThrowsAPatchOfLightOntoTheCeiling) {
  const auto solve = [](const Reflectance& r) {
    SceneBuilder b;
    const uint32_t black = b.AddLambert(Rgb::Zero()), ceiling = b.AddLambert(Rgb::Constant(0.5f));
    const uint32_t lamp = b.AddEmitter(Rgb::Constant(10)), block = b.AddMaterial("block", r);
    b.AddQuad({-3, 3, -3}, {3, 3, -3}, {3, 3, 3}, {-3, 3, 3}, ceiling);
    b.AddQuad({-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, black);
    b.AddQuad({-1.6f, 2.9f, -0.2f}, {-1.2f, 2.9f, -0.2f}, {-1.2f, 2.9f, 0.2f}, {-1.6f, 2.9f, 0.2f}, lamp);
    b.AddBox({-0.3f, 0.2f, -0.3f}, {0.3f, 1.0f, 0.3f}, block);
    SolveOptions o;
    o.mesh.max_edge = 0.3f;
    return Solve(b.Build(), o);
  };
  const Solution metal = solve(Metal(0.4f));
  // Equal albedo at the lamp's mean incidence on the top (35 degrees).
  TableCache cache;
  const Rgb albedo = MaterialLobes(Metal(0.4f), LobeOptions{}, cache).Albedo(std::cos(0.61f));
  const Solution matt = solve(Lambert{albedo});
  const auto ceiling_flux = [](const Solution& s, const Vec3& centre) {
    double sum = 0;
    const auto area = NodeAreas(s.mesh, s.hidden);
    for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
      const Vec3& p = s.mesh.node_position[n];
      if (p.y() < 2.99f || (p - centre).norm() > 0.7f) continue;
      sum += s.total.Flux(n)[0] * area[n];
    }
    return sum;
  };
  // The mirror image of the lamp in the block's top, seen on the ceiling: x from -1.4 to +1.4.
  const double patch_metal = ceiling_flux(metal, {1.3f, 3, 0}), patch_matt = ceiling_flux(matt, {1.3f, 3, 0});
  const double aside_metal = ceiling_flux(metal, {-1.3f, 3, 0}),
               aside_matt = ceiling_flux(matt, {-1.3f, 3, 0});
  EXPECT_GT(patch_metal, 3 * patch_matt);
  EXPECT_LT(aside_metal, 0.5 * aside_matt);
}

}  // namespace
}  // namespace lobe
