#include "solver/resume.h"

#include <atomic>
#include <cstring>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "scene/input_error.h"
#include "solver/solver.h"
#include "tests/support/glass.h"
#include "tests/support/scene_builder.h"
#include "tests/support/scratch_folder.h"

namespace lobe {
namespace {

using test::SceneBuilder;
using test::ScratchFolder;

// A room with a lamp, a glossy block, a sphere whose nodes each have a frame of their own, a translucent
// sheet, and if wanted an ideal mirror on the wall.
Scene RoomOfEverything(bool mirror) {
  SceneBuilder b;
  MetallicRoughness brass;
  brass.base_color = Rgb(0.9f, 0.8f, 0.5f);
  brass.metallic = 1;
  brass.roughness = 0.45f;
  MetallicRoughness glazed;
  glazed.base_color = Rgb(0.2f, 0.5f, 0.7f);
  glazed.metallic = 0;
  glazed.roughness = 0.6f;
  MetallicRoughness paper = glazed;
  paper.diffuse_transmission = 0.4f;
  const uint32_t wall = b.AddLambert(Rgb(0.7f, 0.6f, 0.5f));
  const uint32_t lamp = b.AddEmitter(Rgb(10, 9, 7));
  const uint32_t block = b.AddMaterial("block", brass), ball = b.AddMaterial("ball", glazed);
  const uint32_t sheet = b.AddMaterial("sheet", paper, Rgb::Zero(), /*double_sided=*/true);
  b.AddBox({0, 0, 0}, {3, 3, 3}, wall, /*inward=*/true);
  b.AddQuad({1, 2.9f, 1}, {2, 2.9f, 1}, {2, 2.9f, 2}, {1, 2.9f, 2}, lamp);
  b.AddBox({0.3f, 0, 0.5f}, {1.1f, 1.2f, 1.3f}, block);
  b.AddSphere({2.2f, 0.5f, 1.6f}, 0.4f, ball, 6);
  b.AddQuad({1.6f, 1.2f, 0.6f}, {2.6f, 1.2f, 0.6f}, {2.6f, 1.3f, 1.4f}, {1.6f, 1.3f, 1.4f}, sheet);
  if (mirror) {
    brass.roughness = 0;
    const uint32_t silver = b.AddMaterial("silver", brass);
    b.AddQuad({0.01f, 0.5f, 1.5f}, {0.01f, 2, 1.5f}, {0.01f, 2, 2.5f}, {0.01f, 0.5f, 2.5f}, silver);
    MetallicRoughness bottle = test::ClearGlass(1.5f);
    bottle.attenuation_color = Rgb(0.3f, 0.9f, 0.4f);
    bottle.attenuation_distance = 0.2f;
    b.AddSphere({0.7f, 1.6f, 2.3f}, 0.3f, b.AddMaterial("bottle", bottle), 6);
  }
  return b.Build();
}

SolveOptions Coarse(Transport transport) {
  SolveOptions o;
  o.mesh.max_edge = 0.8f;
  o.lobes.l_max = 6;
  o.transport = transport;
  o.links = 64;
  o.light_samples = 8;
  o.delta_areas = 24;
  return o;
}

Solution SolveOnThreads(int threads, const std::function<Solution()>& solve) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
  Solution s;
  tbb::task_arena(threads).execute([&] { s = solve(); });
  return s;
}

Solution ThroughAFile(const Solution& s) {
  const ScratchFolder folder;
  WriteSolution(s, folder.File("s.glb"));
  return ReadSolution(folder.File("s.glb"));
}

bool SameBits(const NodeLobes& a, const NodeLobes& b) {
  for (uint32_t p = 0; p < a.patch_count(); ++p) {
    const auto x = a.patch_values(p), y = b.patch_values(p);
    if (x.size() != y.size() || std::memcmp(x.data(), y.data(), x.size_bytes()) != 0) return false;
  }
  return a.patch_count() == b.patch_count();
}

void ExpectSameBits(const Solution& a, const Solution& b) {
  EXPECT_TRUE(SameBits(a.total, b.total));
  EXPECT_TRUE(SameBits(a.direct, b.direct));
  EXPECT_TRUE(SameBits(a.unshot, b.unshot));
  EXPECT_EQ(a.hidden, b.hidden);
  EXPECT_EQ(a.received, b.received);
  EXPECT_EQ(a.stop_reason, b.stop_reason);
  EXPECT_EQ(a.material_kinds, b.material_kinds);
  EXPECT_EQ(a.material_errors, b.material_errors);
  static_assert(sizeof(Ledger) == 14 * sizeof(Ledger::Power));
  EXPECT_EQ(std::memcmp(&a.ledger, &b.ledger, sizeof(Ledger)), 0);
  ASSERT_EQ(a.history.size(), b.history.size());
  for (size_t i = 0; i < a.history.size(); ++i) {
    EXPECT_EQ(a.history[i].step, b.history[i].step);
    EXPECT_EQ(a.history[i].residual, b.history[i].residual);
    EXPECT_EQ(a.history[i].rays, b.history[i].rays);
    EXPECT_EQ(a.history[i].shooters, b.history[i].shooters);
  }
}

/// Stops after `steps`, goes through a file, and on to the end with another number of threads.
Solution SolveInTwoRuns(const Scene& scene, const SolveOptions& options, int steps) {
  SolveOptions first = options;
  first.max_steps = steps;
  Solution state = ThroughAFile(SolveOnThreads(1, [&] { return Solve(scene, first); }));
  EXPECT_EQ(state.stop_reason, StopReason::kStepLimit);
  state.options.max_steps = options.max_steps;
  return SolveOnThreads(3, [&] { return Resume(std::move(state)); });
}

TEST(ResumeTest, LinksGoOnToTheSameBits) {
  const Scene scene = RoomOfEverything(/*mirror=*/true);
  const SolveOptions o = Coarse(Transport::kLinks);
  const Solution whole = SolveOnThreads(2, [&] { return Solve(scene, o); });
  ASSERT_EQ(whole.stop_reason, StopReason::kConverged);
  ASSERT_GT(whole.history.size(), 4u);
  EXPECT_EQ(whole.resumed, 0);
  // From emission alone, before and after light is first shot ahead, and with thin links.
  for (const int steps : {0, 1, 2, int(whole.history.size()) - 2}) {
    SCOPED_TRACE(steps);
    const Solution resumed = SolveInTwoRuns(scene, o, steps);
    ExpectSameBits(whole, resumed);
    EXPECT_EQ(resumed.resumed, 1);
  }
}

TEST(ResumeTest, ShootingInPortionsGoesOnToTheSameBits) {
  const Scene scene = RoomOfEverything(/*mirror=*/false);
  SolveOptions o = Coarse(Transport::kShooting);
  o.step_fraction = 0.6;
  o.residual = 0.02;
  const Solution whole = SolveOnThreads(2, [&] { return Solve(scene, o); });
  ASSERT_EQ(whole.stop_reason, StopReason::kConverged);
  for (const int steps : {0, 3}) {
    SCOPED_TRACE(steps);
    ExpectSameBits(whole, SolveInTwoRuns(scene, o, steps));
  }
}

TEST(ResumeTest, EveryCheckpointLeadsToTheSameBits) {
  const Scene scene = RoomOfEverything(/*mirror=*/false);
  SolveOptions o = Coarse(Transport::kShooting);
  o.step_fraction = 0.2;
  o.residual = 0.01;
  std::vector<Solution> kept;
  SolveControl control;
  control.checkpoint_seconds = 1e-9;
  control.checkpoint = [&](const Solution& s) { kept.push_back(s); };
  const Solution whole = Solve(scene, o, control);
  // Taking checkpoints does not change what is solved.
  ExpectSameBits(Solve(scene, o), whole);
  ASSERT_GE(kept.size(), 2u);
  ASSERT_EQ(kept.front().history.size(), 1u) << "after emission";
  for (const Solution* s : {&kept.front(), &kept[kept.size() / 2], &kept.back()}) {
    EXPECT_EQ(s->stop_reason, StopReason::kUnfinished);
    EXPECT_LT(s->ledger.Closure(), 1e-5);
    const Solution read = ThroughAFile(*s);
    EXPECT_EQ(read.stop_reason, StopReason::kUnfinished);
    ExpectSameBits(whole, Resume(read));
  }
}

TEST(ResumeTest, CheckpointsTakeAtMostATenthOfTheTime) {
  SolveOptions o = Coarse(Transport::kShooting);
  o.step_fraction = 0.05;  // many short steps
  o.max_steps = 60;
  int calls = 0;
  SolveControl control;
  control.checkpoint_seconds = 1e-9;
  control.checkpoint = [&](const Solution&) {
    ++calls;
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
  };
  const Solution s = Solve(RoomOfEverything(false), o, control);
  EXPECT_GE(calls, 1);
  EXPECT_LE(calls, 1 + s.solve_seconds / 0.4);
}

TEST(ResumeTest, NoCheckpointsAreTakenWhenNoneAreWanted) {
  SolveControl control;
  control.checkpoint_seconds = 0;
  control.checkpoint = [](const Solution&) { FAIL(); };
  EXPECT_EQ(Solve(RoomOfEverything(false), Coarse(Transport::kLinks), control).stop_reason,
            StopReason::kConverged);
}

TEST(ResumeTest, AConvergedSolutionComesBackAtOnceUntouched) {
  const Scene scene = RoomOfEverything(true);
  const SolveOptions o = Coarse(Transport::kLinks);
  const Solution whole = Solve(scene, o);
  SolveControl control;
  control.progress = [](const Progress&) { ADD_FAILURE() << "nothing is to be done"; };
  const Solution again = Resume(ThroughAFile(whole), control);
  ExpectSameBits(whole, again);
  EXPECT_EQ(again.resumed, 0);
  EXPECT_EQ(again.solve_seconds, whole.solve_seconds);
}

TEST(ResumeTest, ALowerResidualGoesOnWhereItStopped) {
  const Scene scene = RoomOfEverything(true);
  SolveOptions o = Coarse(Transport::kLinks);
  o.residual = 1e-5;
  const Solution whole = Solve(scene, o);
  o.residual = 0.05;
  Solution rough = ThroughAFile(Solve(scene, o));
  ASSERT_LT(rough.history.size(), whole.history.size());
  rough.options.residual = 1e-5;
  ExpectSameBits(whole, Resume(std::move(rough)));
}

TEST(ResumeTest, StoppedBeforeEmissionStartsOverToTheSameBits) {
  const Scene scene = RoomOfEverything(true);
  SolveOptions o = Coarse(Transport::kLinks);
  const Solution whole = Solve(scene, o);
  o.max_seconds = 1e-9;
  Solution nothing = ThroughAFile(Solve(scene, o));
  EXPECT_EQ(nothing.stop_reason, StopReason::kTimeLimit);
  ASSERT_TRUE(nothing.history.empty());
  nothing.options.max_seconds = 0;
  ExpectSameBits(whole, Resume(std::move(nothing)));
}

TEST(ResumeTest, StoppedAgainWhileLinksAreTracedAnewIsAsGoodAsBefore) {
  const Scene scene = RoomOfEverything(true);
  SolveOptions o = Coarse(Transport::kLinks);
  const Solution whole = Solve(scene, o);
  o.max_steps = 2;
  Solution state = ThroughAFile(Solve(scene, o));
  state.options.max_steps = 1000;
  const std::atomic<bool> stop{true};
  SolveControl control;
  control.stop = &stop;
  Solution stopped = Resume(std::move(state), control);
  EXPECT_EQ(stopped.stop_reason, StopReason::kInterrupted);
  EXPECT_EQ(stopped.history.size(), 3u);
  EXPECT_LT(stopped.ledger.Closure(), 1e-5);
  ExpectSameBits(whole, Resume(ThroughAFile(stopped)));
}

TEST(ResumeTest, SecondsOfAllRunsAddUp) {
  SolveOptions o = Coarse(Transport::kLinks);
  o.max_steps = 1;
  Solution first = Solve(RoomOfEverything(false), o);
  first.solve_seconds = 1000;
  first.options.max_steps = 1000;
  first.options.max_seconds = 500;  // of the second run, which takes far less
  const Solution second = Resume(std::move(first));
  EXPECT_EQ(second.stop_reason, StopReason::kConverged);
  EXPECT_GT(second.solve_seconds, 1000);
  EXPECT_LT(second.solve_seconds, 1400);
  EXPECT_GT(second.history.back().seconds, 1000);
}

void ExpectRefused(Solution state, const std::string& word) {
  state.scene.path = "half.glb";
  try {
    Resume(std::move(state));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("half.glb"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
}

TEST(ResumeTest, WhatCannotGoOnIsRefusedInASentence) {
  SolveOptions o = Coarse(Transport::kShooting);
  o.max_steps = 1;
  Solution state = Solve(RoomOfEverything(false), o);
  state.options.max_steps = 10;
  Solution no_received = state;
  no_received.received.clear();
  ExpectRefused(no_received, "'received'");
  // As a table of lobes that was fitted otherwise would have it.
  Solution other_lobes = state;
  other_lobes.options.lobes.l_max = 3;
  ExpectRefused(other_lobes, "degree");
}

TEST(ResumeTest, DifferencesOfScenesAreNamed) {
  const Scene scene = RoomOfEverything(true);
  SolveOptions o = Coarse(Transport::kLinks);
  o.contact_distance = 0;
  o.max_seconds = 1e-9;
  const Scene solved = ThroughAFile(Solve(scene, o)).scene;
  EXPECT_EQ(DifferenceOfScenes(scene, solved), "");
  const auto expect = [&](const std::string& word, const std::function<void(Scene*)>& change) {
    Scene other = scene;
    change(&other);
    EXPECT_NE(DifferenceOfScenes(other, solved).find(word), std::string::npos)
        << DifferenceOfScenes(other, solved);
  };
  expect("triangles", [](Scene* s) { s->faces.pop_back(); });
  expect("materials", [](Scene* s) { s->materials.emplace_back(); });
  expect("material 1 ('lamp')", [](Scene* s) { s->materials[1].emission[2] += 1e-6f; });
  expect("material 4 ('sheet')", [](Scene* s) { s->materials[4].double_sided = false; });
  expect("triangle 3", [](Scene* s) { s->faces[3].material = 1; });
  expect("triangle 7", [](Scene* s) { s->positions[s->faces[7].vertex[2]].x() += 1e-4f; });
  expect("lies elsewhere", [](Scene* s) { s->normals.back() = -s->normals.back(); });
}

}  // namespace
}  // namespace lobe
