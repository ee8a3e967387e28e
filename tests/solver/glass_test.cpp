#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "scene/tessellate.h"
#include "solver/exposure.h"
#include "solver/links.h"
#include "solver/memory.h"
#include "solver/solver.h"
#include "tests/support/glass.h"
#include "tests/support/same_links.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::ClearGlass;
using test::ColouredGlass;
using test::Pane;
using test::SceneBuilder;

struct Linked {
  Scene scene;
  RayTracer tracer;
  Mesh mesh;
  std::vector<MaterialLobes> materials;

  Linked(Scene s, float max_edge) : scene(std::move(s)), tracer(scene) {
    mesh = Tessellate(scene, {.max_edge = max_edge}, FindLitSides(scene, tracer, 1));
    TableCache cache;
    for (const auto& m : scene.materials) materials.emplace_back(m.reflectance, LobeOptions{}, cache);
  }
  Links Trace(const Links::Options& options) const { return Links(scene, mesh, tracer, materials, options); }
};

// A grey room with a lamp, a ball, a block above the floor or down through it, and a pane.
Scene GlassRoom(const MetallicRoughness& body, const MetallicRoughness& pane, float block_bottom = 0.05f) {
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  b.AddBox({-1, 0, -1}, {1, 2, 1}, grey, true);
  b.AddQuad({-0.3f, 1.95f, -0.3f}, {0.3f, 1.95f, -0.3f}, {0.3f, 1.95f, 0.3f}, {-0.3f, 1.95f, 0.3f},
            b.AddEmitter(Rgb(5, 6, 7)));
  const uint32_t glass = b.AddMaterial("glass", body);
  b.AddSphere({-0.4f, 0.5f, 0}, 0.35f, glass, 12);
  b.AddBox({0.2f, block_bottom, -0.4f}, {0.7f, 0.6f, 0.3f}, glass);
  b.AddQuad({-0.9f, 1.2f, -0.9f}, {-0.9f, 1.2f, 0.9f}, {0.9f, 1.3f, 0.9f}, {0.9f, 1.3f, -0.9f},
            b.AddMaterial("pane", pane, Rgb::Zero(), true));
  return b.Build();
}

MetallicRoughness Bottle() { return ColouredGlass(Rgb(0.5f, 0.7f, 0.9f), 0.3f); }

// Of all that leaves a link, per channel, by its ends.
struct Ends {
  Rgb nodes = Rgb::Zero(), escaped = Rgb::Zero(), blocked = Rgb::Zero(), absorbed = Rgb::Zero();
  int hops = 0;
  Rgb sum() const { return nodes + escaped + blocked + absorbed; }
};
Ends EndsOf(const Links& links, uint32_t link) {
  Ends ends;
  if (!Links::IsChain(link)) {
    ends.hops = 0;
    (link == Links::kEscaped   ? ends.escaped
     : link == Links::kBlocked ? ends.blocked
                               : ends.nodes) = Rgb::Constant(1);
    return ends;
  }
  for (const Links::Hop* hop = links.chain(link);; ++hop) {
    ++ends.hops;
    const Rgb t = hop->Throughput();
    if (hop->node == Links::kEscaped) ends.escaped += t;
    if (hop->node == Links::kAbsorbed) ends.absorbed += t;
    if (hop->end && (hop->node == Links::kBlocked || hop->cut)) ends.blocked += t;
    if (Links::IsNode(hop->node)) ends.nodes += t;
    if (hop->last) return ends;
  }
}

TEST(GlassLinksTest, EveryChainThroughClearGlassKeepsAllOfItsPower) {
  const Linked room(GlassRoom(ClearGlass(1.5f), Pane(1.6f)), 0.4f);
  const Links links = room.Trace({.links = 256});
  size_t chains = 0, branched = 0, hops = 0;
  double lost = 0;
  for (uint32_t n = 0; n < room.mesh.node_count(); ++n) {
    for (const uint32_t link : links.of(n)) {
      if (!Links::IsChain(link)) continue;
      const Ends ends = EndsOf(links, link);
      ++chains;
      branched += ends.hops > 1;
      hops += size_t(ends.hops);
      lost += ends.blocked[0] + ends.absorbed[0];
      EXPECT_LT((ends.sum() - 1).abs().maxCoeff(), 2e-3) << "node " << n;
    }
  }
  EXPECT_GT(chains, 1000u);
  EXPECT_GT(branched, 100u) << "where both ways carry much, both are followed";
  RecordProperty("hops_a_chain", std::to_string(double(hops) / double(chains)));
  EXPECT_LT(double(hops) / double(chains), 3.5) << "and where not, one";
  EXPECT_LT(lost / double(chains), 0.01) << "cut off, or hidden";
}

TEST(GlassLinksTest, WhatColouredGlassKeepsIsAbsorbedOnAverage) {
  SceneBuilder b;  // a ball in the void above a floor: all that is not absorbed ends somewhere
  b.AddQuad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, b.AddEmitter(Rgb::Constant(1)));
  b.AddBox({-0.5f, 0.3f, -0.5f}, {0.5f, 0.7f, 0.5f}, b.AddMaterial("bottle", Bottle()));
  const Linked open(b.Build(), 0.3f);
  const Links links = open.Trace({.links = 1024});
  Eigen::Array3d sum = Eigen::Array3d::Zero(), absorbed = sum;
  double chains = 0;
  for (uint32_t n = 0; n < open.mesh.node_count(); ++n) {
    for (const uint32_t link : links.of(n)) {
      if (!Links::IsChain(link)) continue;
      const Ends ends = EndsOf(links, link);
      ++chains;
      sum += ends.sum().cast<double>();
      absorbed += ends.absorbed.cast<double>();
    }
  }
  EXPECT_GT(chains, 3000);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / chains, 1, 0.01) << c;
  // More of red than of blue, and about 1 - a^(0.4 m / 0.3 m) of what goes straight through.
  EXPECT_GT(absorbed[0], 1.5 * absorbed[2]);
  EXPECT_NEAR(absorbed[0] / chains, 1 - std::pow(0.5, 0.45 / 0.3), 0.12);
}

TEST(GlassLinksTest, AreTheSameBitsForAnyNumberOfThreads) {
  const Linked room(GlassRoom(Bottle(), Pane(1.5f)), 0.4f);
  std::vector<std::unique_ptr<Links>> all;
  for (const int threads : {1, 2, 7}) {
    tbb::task_arena arena(threads);
    arena.execute([&] { all.push_back(std::make_unique<Links>(room.Trace({.links = 128}))); });
  }
  for (int i = 1; i < 3; ++i) test::ExpectSameLinks(*all[0], *all[i], room.mesh.node_count());
}

TEST(GlassLinksTest, FloorInsideAGlassBlockIsNotHidden) {
  const Linked room(GlassRoom(ClearGlass(1.5f), Pane(1.5f), -0.3f), 0.15f);
  const Links links = room.Trace({.links = 256});
  int inside = 0;
  for (uint32_t n = 0; n < room.mesh.node_count(); ++n) {
    const Vec3& p = room.mesh.node_position[n];
    if (p.y() == 0 && p.x() > 0.25f && p.x() < 0.65f && p.z() > -0.35f && p.z() < 0.25f) {
      ++inside;
      EXPECT_FALSE(links.hidden()[n]);
    }
  }
  EXPECT_GT(inside, 5);
}

TEST(GlassLinksTest, ProbesOfShootingPassPanesAlone) {
  const Linked room(GlassRoom(ClearGlass(1.5f), Pane(1.5f)), 0.4f);
  const Links links = room.Trace({.links = 128, .follow_mirrors = false});
  double passed = 0, blocked = 0;
  for (uint32_t n = 0; n < room.mesh.node_count(); ++n) {
    for (const uint32_t link : links.of(n)) {
      if (!Links::IsChain(link)) continue;
      const Ends ends = EndsOf(links, link);
      passed += ends.nodes[0];
      blocked += ends.blocked[0];
    }
  }
  EXPECT_GT(passed, 100);
  EXPECT_GT(blocked, 100);
}

TEST(HopTest, ThroughputAboveOneKeepsItsDigits) {
  Links::Hop hop{};
  for (const Rgb& t : {Rgb(0.5f, 0.25f, 1), Rgb(2.25f, 1, 0.1f), Rgb(30, 0, 3)}) {
    hop.SetThroughput(t);
    EXPECT_LT((hop.Throughput() - t).abs().maxCoeff(), t.maxCoeff() / 65535);
  }
  hop.SetThroughput(Rgb(1e9f, 1, 1));
  EXPECT_EQ(hop.Throughput()[0], 32768);
}

TEST(GlassExposureTest, OnlySidesOfGlassThatStoreLightHaveNodes) {
  MetallicRoughness half = Pane(1.5f);
  half.transmission = 0.5f;
  MetallicRoughness milky = ClearGlass(1.5f);
  milky.transmission = 0.7f;
  const auto nodes = [](const Scene& scene, uint32_t material, Side side) {
    const RayTracer tracer(scene);
    const Mesh mesh = Tessellate(scene, {.max_edge = 0.4f}, FindLitSides(scene, tracer, 1));
    size_t count = 0;
    for (const auto& p : mesh.patches) {
      if (p.material == material && p.side == side) count += p.node_end - p.node_begin;
    }
    return count;
  };
  const Scene clear = GlassRoom(ClearGlass(1.5f), Pane(1.5f)), based = GlassRoom(milky, half);
  for (const Side side : {Side::kFront, Side::kBack}) {
    EXPECT_EQ(nodes(clear, 2, side), 0u);
    EXPECT_EQ(nodes(clear, 3, side), 0u);
    EXPECT_GT(nodes(based, 3, side), 0u) << "both sides of a pane have a base";
    EXPECT_GT(nodes(clear, 0, Side::kFront), 0u);
  }
  EXPECT_GT(nodes(based, 2, Side::kFront), 0u);
  EXPECT_EQ(nodes(based, 2, Side::kBack), 0u) << "the inside of a body has none";
}

TEST(GlassExposureTest, WhatLiesInAGlassCaseIsLit) {
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  b.AddQuad({-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}, b.AddEmitter(Rgb::Constant(1)));
  b.AddBox({-0.1f, 0, -0.1f}, {0.1f, 0.2f, 0.1f}, grey);
  b.AddSphere({0, 0, 0}, 0.5f, b.AddMaterial("glass", ClearGlass(1.5f)), 8);
  const Scene scene = b.Build();
  const RayTracer tracer(scene);
  const auto lit = FindLitSides(scene, tracer, 3);
  bool any = false;
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    if (scene.faces[f].material == grey) any |= lit[2 * f];
  }
  EXPECT_TRUE(any);
}

// A lamp under a coloured pane without a coat, in the open: what passes escapes, the rest stays in the glass.
TEST(GlassExposureTest, EmissionLostInGlassIsOneMinusItsColour) {
  MetallicRoughness red = Pane(1.5f, Rgb(0.9f, 0.5f, 0.1f));
  red.has_specular = true;
  red.specular = 0;
  SceneBuilder b;
  b.AddQuad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, b.AddEmitter(Rgb::Constant(1)));
  b.AddQuad({-1e4f, 1, -1e4f}, {-1e4f, 1, 1e4f}, {1e4f, 1, 1e4f}, {1e4f, 1, -1e4f},
            b.AddMaterial("red", red, Rgb::Zero(), true));
  const Linked open(b.Build(), 10.0f);
  const EmissionLoss loss = FindEmissionLoss(open.scene, open.mesh, open.tracer, {nullptr, nullptr}, 1);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(loss.escaped[c], red.base_color[c], 1e-3);
    EXPECT_NEAR(loss.in_glass[c], 1 - red.base_color[c], 1e-3);
    EXPECT_NEAR(loss.blocked[c], 0, 1e-3);
  }
}

SolveOptions Quick() {
  SolveOptions o;
  o.mesh.max_edge = 0.25f;
  o.refine.rounds = 0;
  o.links = 512;
  o.residual = 1e-4;
  return o;
}

// Walls emit 1 and reflect half: 1 is reflected everywhere, with clear glass in the room or without.
TEST(GlassFurnaceTest, ClearGlassDoesNotChangeTheLightOfAFurnace) {
  SceneBuilder b;
  b.AddBox({-1, 0, -1}, {1, 2, 1}, b.AddMaterial("wall", Lambert{Rgb::Constant(0.5f)}, Rgb::Constant(1)),
           true);
  b.AddSphere({-0.4f, 0.6f, 0}, 0.4f, b.AddMaterial("ball", ClearGlass(1.5f)), 12);
  b.AddQuad({0.1f, 0.3f, -0.7f}, {0.8f, 0.3f, -0.7f}, {0.8f, 1.5f, -0.5f}, {0.1f, 1.5f, -0.5f},
            b.AddMaterial("pane", Pane(1.5f), Rgb::Zero(), true));
  const Solution s = Solve(b.Build(), Quick());
  const auto area = NodeAreas(s.mesh, s.hidden);
  double sum = 0, all = 0, worst = 0;
  for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
    if (area[n] == 0) continue;
    const double radiance = s.total.Flux(n)[1] / std::numbers::pi;
    sum += area[n] * radiance;
    all += area[n];
    worst = std::max(worst, std::abs(radiance - 1));
  }
  EXPECT_NEAR(sum / all, 1, 0.01);
  EXPECT_LT(worst, 0.1);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(s.ledger.in_glass[c] / s.ledger.emitted[c], 0, 1e-4);
}

TEST(GlassLedgerTest, ClosesAndSaysWhatColouredGlassAbsorbs) {
  MetallicRoughness half = Pane(1.5f, Rgb(0.9f, 0.8f, 0.7f));
  half.transmission = 0.6f;
  const Scene scene = GlassRoom(Bottle(), half);
  for (const Transport t : {Transport::kLinks, Transport::kShooting}) {
    SolveOptions o = Quick();
    o.transport = t;
    const Solution s = Solve(scene, o);
    EXPECT_LT(s.ledger.Closure(), 1e-4) << Name(t);
    EXPECT_LT(s.ledger.RelativeImbalance(), 0.05) << Name(t);
    if (t == Transport::kShooting) continue;  // it does not enter bodies
    EXPECT_GT(s.ledger.in_glass[0], 0.01 * s.ledger.emitted[0]);
    EXPECT_GT(s.ledger.in_glass[0] / s.ledger.emitted[0], 2 * s.ledger.in_glass[2] / s.ledger.emitted[2]);
  }
}

TEST(GlassMemoryTest, TheEstimateOfLinksIsThatOfTheLinksMade) {
  const Linked room(GlassRoom(Bottle(), Pane(1.5f)), 0.2f);
  SolveOptions o;
  const Links links = room.Trace({.links = o.links});
  MeshCounts counts = CountsOf(room.mesh, room.scene.materials.size());
  const double estimate = EstimateMemory(room.scene, counts, room.materials, o).links;
  // Hops are copied once while blocks are joined.
  const double hops = double(links.bytes()) - 4.0 * double(links.count());
  const double need = double(links.bytes()) + hops;
  EXPECT_GT(estimate, 0.8 * need);
  EXPECT_LT(estimate, 2.5 * need);
}

}  // namespace
}  // namespace lobe
