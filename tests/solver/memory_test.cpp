#include "solver/memory.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "scene/input_error.h"
#include "scene/tessellate.h"
#include "solver/links.h"
#include "solver/node_lobes.h"
#include "solver/solver.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

Scene GlossyRoom() {
  SceneBuilder b;
  MetallicRoughness brass;
  brass.metallic = 1;
  brass.roughness = 0.5f;
  b.AddBox({0, 0, 0}, {3, 2, 4}, b.AddLambert(Rgb::Constant(0.6f)), /*inward=*/true);
  b.AddBox({1, 0, 1}, {1.7f, 1.2f, 1.5f}, b.AddMaterial("block", brass));
  b.AddQuad({1, 1.9f, 2}, {2, 1.9f, 2}, {2, 1.9f, 3}, {1, 1.9f, 3}, b.AddEmitter(Rgb::Constant(10)));
  Scene scene = b.Build();
  scene.path = "room.glb";
  return scene;
}

std::vector<MaterialLobes> LobesOf(const Scene& scene, const SolveOptions& options) {
  TableCache cache;
  std::vector<MaterialLobes> lobes;
  for (const Material& m : scene.materials) lobes.emplace_back(m.reflectance, options.lobes, cache);
  return lobes;
}

std::vector<bool> Fronts(const Scene& scene) {
  std::vector<bool> sides(2 * scene.faces.size(), false);
  for (size_t f = 0; f < scene.faces.size(); ++f) sides[2 * f] = true;
  return sides;
}

SolveOptions Options(float edge) {
  SolveOptions o;
  o.mesh.max_edge = edge;
  o.lobes.l_max = 6;
  return o;
}

TEST(MemoryTest, CountsAreThoseOfTheMesh) {
  const Scene scene = GlossyRoom();
  const Mesh mesh = Tessellate(scene, Options(0.2f).mesh);
  const MeshCounts counts = CountsOf(mesh, scene.materials.size());
  EXPECT_EQ(counts.elements, double(mesh.element_count()));
  EXPECT_EQ(counts.all_nodes(), double(mesh.node_count()));
  ASSERT_EQ(counts.nodes.size(), 3u);
  for (uint32_t m = 0; m < 3; ++m) {
    double nodes = 0;
    for (const uint32_t p : mesh.node_patch) nodes += mesh.patches[p].material == m;
    EXPECT_EQ(counts.nodes[m], nodes);
  }
}

// RequireMemory relies on both sides of it: a scene is refused before it is cut only if it cannot fit, and
// the edge that it proposes does.
TEST(MemoryTest, ExpectedElementsAreAtMostThereAndAtLeastHalf) {
  const Scene scene = GlossyRoom();
  for (const float edge : {0.31f, 0.2f, 0.15f, 0.1f, 0.07f}) {
    const double found = double(Tessellate(scene, Options(edge).mesh, Fronts(scene)).element_count());
    const double expected = ExpectCounts(scene, Fronts(scene), edge).elements;
    EXPECT_LE(expected, found) << edge;
    EXPECT_GE(2.1 * expected, found) << edge;
  }
}

TEST(MemoryTest, WhatIsCountedIsInTheEstimate) {
  const Scene scene = GlossyRoom();
  const SolveOptions o = Options(0.1f);
  const auto lobes = LobesOf(scene, o);
  const Mesh mesh = Tessellate(scene, o.mesh);
  const MemoryNeed need = EstimateMemory(scene, CountsOf(mesh, 3), lobes, o);
  std::vector<PartDegrees> degrees;
  for (const auto& p : mesh.patches)
    degrees.push_back({lobes[p.material].base.l_max, lobes[p.material].gloss.l_max});
  const double field = double(NodeLobes(mesh, degrees).bytes());
  EXPECT_GT(need.lobes, 5 * field);
  EXPECT_LT(need.lobes, 5 * field + 40.0 * double(mesh.node_count()));
  double links = 0;
  for (const auto& p : mesh.patches) {
    links += 4.0 * Links::PatternOf(lobes[p.material], o.links).count() * (p.node_end - p.node_begin);
  }
  EXPECT_GE(need.links, links);
  EXPECT_LT(need.links, 1.2 * links) << "no mirrors, no chains";
}

TEST(MemoryTest, NodesOfTheDearestMaterialFitAsTheEstimateSays) {
  const Scene scene = GlossyRoom();
  const SolveOptions o = Options(0.1f);
  const auto lobes = LobesOf(scene, o);
  const MeshCounts counts = CountsOf(Tessellate(scene, o.mesh), 3);
  MeshCounts more = counts;
  more.nodes[1] += 100'000;  // the block's, with lobes
  more.elements += 200'000;
  const double need = EstimateMemory(scene, more, lobes, o).peak();
  EXPECT_NEAR(NodesThatFit(need, scene, counts, lobes, o), more.all_nodes(), 0.02 * more.all_nodes());
  EXPECT_EQ(NodesThatFit(1000, scene, counts, lobes, o), counts.all_nodes());
}

TEST(MemoryTest, ARefusalNamesAnEdgeThatFits) {
  const Scene scene = GlossyRoom();
  for (const double bytes : {40e6, 70e6, 200e6}) {
    SolveOptions o = Options(0.005f);
    o.refine.error = 0;
    o.links = 64;
    o.light_samples = 1;
    o.max_steps = 0;
    SolveControl control;
    control.max_memory = bytes;
    std::string sentence;
    try {
      Solve(scene, o, control);
      FAIL() << "takes too much";
    } catch (const InputError& e) {
      sentence = e.what();
    }
    for (const char* part : {"room.glb", "0.005 m", "elements", "expected at most"}) {
      EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
    }
    const size_t at = sentence.find("choose longer edges, ");
    ASSERT_NE(at, std::string::npos) << sentence;
    o.mesh.max_edge = std::stof(sentence.substr(at + 21));
    EXPECT_GT(o.mesh.max_edge, 0.005f);
    EXPECT_EQ(Solve(scene, o, control).stop_reason, StopReason::kStepLimit) << sentence;
  }
}

TEST(MemoryTest, AMeshIsRefinedOnlyAsFarAsItFits) {
  const Scene scene = GlossyRoom();
  SolveOptions o = Options(0.5f);
  o.links = 64;
  o.light_samples = 4;
  o.max_steps = 0;
  o.refine.error = 0.02;
  double told = 0;
  SolveControl control;
  control.memory = [&](const MemoryNeed& need) { told = need.peak(); };
  const Solution free = Solve(scene, o, control);
  EXPECT_TRUE(free.scene.warnings.empty());
  const double all = told;
  control.max_memory = 20e6 + 0.5 * (all - 20e6);
  const Solution fitted = Solve(scene, o, control);
  EXPECT_LE(told, control.max_memory);
  EXPECT_LT(fitted.mesh.node_count(), free.mesh.node_count());
  EXPECT_GT(fitted.mesh.node_count(), free.mesh.node_count() / 8);
  ASSERT_EQ(fitted.scene.warnings.size(), 1u);
  EXPECT_NE(fitted.scene.warnings[0].find("all that fit"), std::string::npos) << fitted.scene.warnings[0];
}

TEST(MemoryTest, GoingOnNeedsTheSame) {
  const Scene scene = GlossyRoom();
  SolveOptions o = Options(0.2f);
  o.max_steps = 0;
  o.refine.error = 0;
  double told = 0;
  SolveControl control;
  control.memory = [&](const MemoryNeed& need) { told = need.peak(); };
  Solution state = Solve(scene, o, control);
  const double first = told;
  state.options.max_steps = 1;
  told = 0;
  Resume(state, control);
  EXPECT_EQ(told, first);
  control.max_memory = first / 2;
  EXPECT_THROW(Resume(state, control), InputError);
}

TEST(MemoryTest, AmountsAreToldInTwoDigits) {
  EXPECT_EQ(MemoryText(1.234e9), "1.2 GB");
  EXPECT_EQ(MemoryText(12.34e9), "12 GB");
  EXPECT_EQ(MemoryText(345e6), "345 MB");
  EXPECT_EQ(MemoryText(5.6e12), "5.6 TB");
}

}  // namespace
}  // namespace lobe
