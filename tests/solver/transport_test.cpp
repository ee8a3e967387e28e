#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "solver/solver.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

constexpr double kPi = std::numbers::pi;

MetallicRoughness Metal(float roughness, float f0 = 0.9f) {
  MetallicRoughness r;
  r.base_color = Rgb::Constant(f0);
  r.metallic = 1;
  r.roughness = roughness;
  return r;
}

MetallicRoughness Varnish(float roughness) {
  MetallicRoughness r = Metal(roughness, 0.6f);
  r.metallic = 0;
  return r;
}

// Without a coat: reflects `rho`, lets `tau` through, both Lambertian.
MetallicRoughness Sheet(float rho, float tau) {
  MetallicRoughness r;
  r.metallic = 0;
  r.has_specular = true;
  r.specular = 0;
  r.diffuse_transmission = 0.5f;
  r.base_color = Rgb::Constant(2 * rho);
  r.diffuse_transmission_color = Rgb::Constant(2 * tau);
  return r;
}

double Power(const NodeLobes& lobes, const std::vector<double>& area) {
  double sum = 0;
  for (uint32_t n = 0; n < lobes.node_count(); ++n) sum += double(lobes.Flux(n).sum()) * area[n];
  return sum;
}

// Area-weighted mean of the absolute difference of fluxes over the mean flux.
double FluxDifference(const Solution& a, const Solution& b) {
  const auto area = NodeAreas(a.mesh, a.hidden);
  double sum = 0;
  for (uint32_t n = 0; n < a.mesh.node_count(); ++n) {
    sum += double((a.total.Flux(n) - b.total.Flux(n)).abs().sum()) * area[n];
  }
  return sum / Power(a.total, area);
}

bool SameBits(const NodeLobes& a, const NodeLobes& b) {
  for (uint32_t p = 0; p < a.patch_count(); ++p) {
    const auto x = a.patch_values(p), y = b.patch_values(p);
    if (x.size() != y.size() || std::memcmp(x.data(), y.data(), x.size_bytes()) != 0) return false;
  }
  return a.patch_count() == b.patch_count();
}

// Coloured walls, a metal block, a varnished one.
Scene GlossyRoom() {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {3, 3, 3}, b.AddLambert(Rgb(0.8f, 0.7f, 0.5f)), true);
  b.AddQuad({1, 2.9f, 1}, {2, 2.9f, 1}, {2, 2.9f, 2}, {1, 2.9f, 2}, b.AddEmitter(Rgb::Constant(10)));
  b.AddBox({0.4f, 0, 0.5f}, {1.3f, 1.5f, 1.4f}, b.AddMaterial("metal", Metal(0.45f)));
  b.AddBox({1.8f, 0, 1.5f}, {2.6f, 0.8f, 2.4f}, b.AddMaterial("varnish", Varnish(0.5f)));
  return b.Build();
}

// Mirrors, flat and curved, a sheet, and a hole in the roof.
Scene EverythingRoom() {
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb(0.7f, 0.6f, 0.5f));
  b.AddQuad({0, 0, 0}, {0, 0, 3}, {3, 0, 3}, {3, 0, 0}, grey);
  b.AddQuad({0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}, grey);
  b.AddQuad({0, 0, 0}, {0, 2, 0}, {0, 2, 3}, {0, 0, 3}, b.AddMaterial("mirror", Metal(0)));
  b.AddSphere({2.2f, 0.5f, 0.8f}, 0.4f, b.AddMaterial("varnished mirror", Varnish(0)), 8);
  b.AddBox({0.5f, 0, 0.5f}, {1.1f, 0.6f, 1.1f}, b.AddMaterial("metal", Metal(0.5f)));
  b.AddQuad({1, 1, 1}, {1, 1, 2}, {2, 1.1f, 2}, {2, 1.1f, 1},
            b.AddMaterial("sheet", Sheet(0.4f, 0.3f), Rgb::Zero(), true));
  b.AddQuad({1.4f, 1.9f, 1.4f}, {1.6f, 1.9f, 1.4f}, {1.6f, 1.9f, 1.6f}, {1.4f, 1.9f, 1.6f},
            b.AddEmitter(Rgb(9, 10, 11)));
  return b.Build();
}

SolveOptions Coarse() {
  SolveOptions o;
  o.mesh.max_edge = 0.5f;
  o.refine.error = 0;
  o.light_samples = 32;
  o.delta_areas = 256;
  return o;
}

TEST(TransportTest, LinksAndShootingReachTheSameSolution) {
  SolveOptions o = Coarse();
  o.residual = 1e-4;
  o.links = 2048;
  o.delta_areas = 512;
  const Solution links = Solve(GlossyRoom(), o);
  o.transport = Transport::kShooting;
  const Solution shooting = Solve(GlossyRoom(), o);
  ASSERT_EQ(links.mesh.node_count(), shooting.mesh.node_count());
  ASSERT_EQ(links.stop_reason, StopReason::kConverged);
  ASSERT_EQ(shooting.stop_reason, StopReason::kConverged);
  const auto area = NodeAreas(links.mesh, links.hidden);
  const double power = Power(links.total, area) / Power(shooting.total, area) - 1;
  const double spread = FluxDifference(links, shooting);
  // Measured: -0.4 %, and 1.1 % node by node.
  EXPECT_LT(std::abs(power), 0.01);
  EXPECT_LT(spread, 0.02);
}

// Shooting ahead changes the way, not where it ends. Links are the same in both solves, so their noise is
// too.
TEST(TransportTest, OvershootingReachesTheFixedPointOfPlainSweeps) {
  for (const Scene& scene : {GlossyRoom(), EverythingRoom()}) {
    SolveOptions o = Coarse();
    o.residual = 1e-7;
    o.thin_late_links = false;
    const Solution fast = Solve(scene, o);
    o.accelerate = false;
    const Solution plain = Solve(scene, o);
    ASSERT_EQ(fast.stop_reason, StopReason::kConverged);
    ASSERT_EQ(plain.stop_reason, StopReason::kConverged);
    const double difference = FluxDifference(plain, fast);
    EXPECT_LT(difference, 1e-4);
    EXPECT_LT(fast.history.size(), plain.history.size());
    o.accelerate = true;
    o.thin_late_links = true;
    const Solution thin = Solve(scene, o);
    // What thin links cost: 0.8e-3 and 1.4e-3 node by node, 4e-4 of the power at most.
    EXPECT_LT(FluxDifference(plain, thin), 4e-3);
    EXPECT_GT(FluxDifference(plain, thin), 1e-4) << "or they need no switch of their own";
    const auto area = NodeAreas(plain.mesh, plain.hidden);
    EXPECT_NEAR(Power(thin.total, area) / Power(plain.total, area), 1, 2e-3);
  }
}

struct Room {
  Solution solution;
  double mean = 0, worst = 0;  // radiance over emission, its own included
  size_t sweeps = 0;
};
// Closed; every wall emits 1.
Room SolveFurnace(const Reflectance& wall, bool accelerate, double residual, float edge) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {4, 3, 5}, b.AddMaterial("wall", wall, Rgb::Constant(1)), true);
  SolveOptions o = Coarse();
  o.mesh.max_edge = edge;
  o.residual = residual;
  o.accelerate = o.thin_late_links = accelerate;
  Room r{Solve(b.Build(), o)};
  const Solution& s = r.solution;
  const auto area = NodeAreas(s.mesh, s.hidden);
  double sum = 0;
  for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
    const double radiance = 1 + double(s.total.Flux(n)[1]) / kPi;
    r.mean += area[n] * radiance;
    sum += area[n];
    r.worst = std::max(r.worst, radiance);
  }
  r.mean /= sum;
  r.sweeps = s.history.size() - 1;
  return r;
}

// Of 1 / (1 - 0.98) = 50 the first sweeps bring one each.
TEST(TransportTest, AWhiteClosedRoomConvergesInAFewSweeps) {
  const Room fast = SolveFurnace(Lambert{Rgb::Constant(0.98f)}, true, 1e-3, 0.8f);
  EXPECT_EQ(fast.solution.stop_reason, StopReason::kConverged);
  EXPECT_LE(fast.sweeps, 8u) << "6 measured";
  EXPECT_NEAR(fast.mean, 50, 0.5);  // 50.02 measured
  EXPECT_LT(fast.solution.ledger.Closure(), 1e-5);
  const Room plain = SolveFurnace(Lambert{Rgb::Constant(0.98f)}, false, 1e-3, 0.8f);
  // 0.98^n = 1e-3 / 50 leaves less than a per mille; residual is unshot over emitted: 0.98^n = 1e-3, n = 342.
  EXPECT_NEAR(double(plain.sweeps), 342, 5);
  EXPECT_NEAR(plain.mean, 50 * (1 - 1e-3), 0.5);
}

// Lobes of degree 20 ring below zero here. Measured: 20 sweeps with overshooting, 157 without.
TEST(TransportTest, AClosedRoomOfBrightMetalConvergesWithSignedLobes) {
  const Reflectance metal = Metal(0.3f, 0.98f);
  const Room fast = SolveFurnace(metal, true, 1e-3, 2.5f), plain = SolveFurnace(metal, false, 1e-3, 2.5f);
  for (const Room* room : {&fast, &plain}) {
    EXPECT_EQ(room->solution.stop_reason, StopReason::kConverged);
    EXPECT_LT(room->solution.ledger.Closure(), 1e-5);
  }
  EXPECT_LE(fast.sweeps, 30u);
  EXPECT_LE(plain.sweeps, 180u);
  // Of what both still lack, a per mille of the emission, each bounce brings one of about 23.
  EXPECT_NEAR(fast.mean / plain.mean, 1, 0.015);
  EXPECT_GT(plain.mean, 20) << "albedo 0.957 in the mean";
}

TEST(TransportTest, GivesTheSameBitsForAnyNumberOfThreadsWithMirrorsAndSheets) {
  std::vector<Solution> solutions;
  SolveOptions o = Coarse();
  o.refine.error = 0.1;
  o.links = 128;
  for (const int threads : {1, 2, 7}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
    tbb::task_arena arena(threads);
    arena.execute([&] { solutions.push_back(Solve(EverythingRoom(), o)); });
  }
  for (int i = 1; i < 3; ++i) {
    EXPECT_TRUE(SameBits(solutions[0].total, solutions[i].total));
    EXPECT_TRUE(SameBits(solutions[0].direct, solutions[i].direct));
    EXPECT_TRUE(SameBits(solutions[0].unshot, solutions[i].unshot));
    EXPECT_EQ(solutions[0].ledger.absorbed, solutions[i].ledger.absorbed);
    EXPECT_EQ(solutions[0].ledger.escaped, solutions[i].ledger.escaped);
    EXPECT_EQ(solutions[0].history.size(), solutions[i].history.size());
  }
}

TEST(TransportTest, LedgerClosesWithMirrorsSheetsAndAnOpenSky) {
  for (const Transport transport : {Transport::kLinks, Transport::kShooting}) {
    for (const bool accelerate : {true, false}) {
      SolveOptions o = Coarse();
      o.transport = transport;
      o.accelerate = accelerate;
      const Ledger ledger = Solve(EverythingRoom(), o).ledger;
      EXPECT_LT(ledger.Closure(), 1e-5) << Name(transport);
      EXPECT_LT(ledger.RelativeImbalance(), 0.06) << Name(transport);
      EXPECT_GT(ledger.escaped[0], 0.1 * ledger.emitted[0]);
      EXPECT_GT(ledger.mirrored[0] + ledger.passed_on[0], 0.02 * ledger.emitted[0]);
    }
  }
}

// Lamp, sheet and black receiver are unit squares one above the other, half a metre apart: everything follows
// from form factors between the lamp, the sheet and the receiver.
TEST(TransportTest, ASheetBetweenLampAndReceiverPassesItsShare) {
  for (const auto& [rho, tau] : {std::pair{0.0f, 0.5f}, {0.3f, 0.4f}, {0.5f, 0.5f}}) {
    SceneBuilder b;
    const uint32_t black = b.AddLambert(Rgb::Zero());
    const uint32_t sheet = b.AddMaterial("sheet", Sheet(rho, tau), Rgb::Zero(), true);
    // The lamp reflects too, so that light comes back to the sheet's front.
    const float lamp_rho = 0.6f;
    b.AddQuad({0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1},
              b.AddMaterial("lamp", Lambert{Rgb::Constant(lamp_rho)}, Rgb::Constant(1)));
    b.AddQuad({0, 0.5f, 0}, {0, 0.5f, 1}, {1, 0.5f, 1}, {1, 0.5f, 0}, sheet);
    b.AddQuad({0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, black);
    SolveOptions o = Coarse();
    o.mesh.max_edge = 0.08f;
    o.residual = 1e-5;
    o.links = 256;
    for (const Transport transport : {Transport::kLinks, Transport::kShooting}) {
      o.transport = transport;
      const Solution s = Solve(b.Build(), o);
      const auto area = NodeAreas(s.mesh, s.hidden);
      double front = 0, back = 0, lamp = 0;  // power that leaves the sheet up and down, and the lamp
      for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
        const auto& patch = s.mesh.patches[s.mesh.node_patch[n]];
        const double power = double(s.total.Flux(n)[0]) * area[n];
        if (patch.material == sheet) (s.mesh.node_normal[n].y() > 0 ? front : back) += power;
        if (patch.material == sheet + 1) lamp += power;
      }
      // Parallel squares at half their side: F = 0.41525 (Howell C-11). Each square is taken as one patch,
      // which leaves out how light varies over it: 0.4 % of the sheet, 4 % of what comes back to the lamp.
      const double f = 0.41525, e = kPi;
      const double up = rho * f * e / (1 - lamp_rho * f * f * rho);
      EXPECT_NEAR(lamp, lamp_rho * f * up, 0.06 * up * lamp_rho * f + 1e-9)
          << "light is brightest in the middle";
      if (rho > 0) {
        EXPECT_NEAR(front / up, 1, 0.02);
        EXPECT_NEAR(back / front, tau / rho, 0.002) << "the receiver is black: nothing arrives from below";
      } else {
        EXPECT_EQ(front, 0);
        EXPECT_NEAR(back, tau * f * e, 0.01 * tau * f * e);
      }
      EXPECT_LT(s.ledger.Closure(), 1e-5);
    }
  }
}

// Walls of 0.5 that emit 1 shine 2 everywhere. A sheet in the room that loses nothing changes nothing; one
// that keeps rho + tau = 0.8 shows 2 x 0.8 less what it takes from the room.
TEST(TransportTest, ASheetThatLosesNothingIsNotSeenInAFurnace) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {4, 3, 5}, b.AddMaterial("wall", Lambert{Rgb::Constant(0.5f)}, Rgb::Constant(1)), true);
  const uint32_t sheet = b.AddMaterial("sheet", Sheet(0.3f, 0.5f), Rgb::Zero(), true);
  const uint32_t clear = b.AddMaterial("clear", Sheet(0.5f, 0.5f), Rgb::Zero(), true);
  b.AddQuad({1, 1, 1}, {1, 1, 3}, {3, 1.5f, 3}, {3, 1.5f, 1}, clear);
  const Scene room = b.Build();
  SolveOptions o = Coarse();
  o.residual = 1e-5;
  const Solution s = Solve(room, o);
  const auto area = NodeAreas(s.mesh, s.hidden);
  double walls = 0, sheets = 0, wall_area = 0, sheet_area = 0;
  for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
    const bool is_sheet = s.mesh.patches[s.mesh.node_patch[n]].material == clear;
    const double radiance = double(s.total.Flux(n)[0]) / kPi;
    (is_sheet ? sheets : walls) += radiance * area[n];
    (is_sheet ? sheet_area : wall_area) += area[n];
  }
  EXPECT_NEAR(1 + walls / wall_area, 2, 0.01);
  EXPECT_NEAR(sheets / sheet_area, 2, 0.01);
  // A black room: what arrives is the walls' 1, what leaves each side is rho + tau of it.
  SceneBuilder black;
  black.AddMaterial("wall", Lambert{Rgb::Zero()}, Rgb::Constant(1));
  black.AddMaterial(room.materials[sheet]);
  black.AddBox({0, 0, 0}, {4, 3, 5}, 0, true);
  black.AddQuad({1, 1, 1}, {1, 1, 3}, {3, 1.5f, 3}, {3, 1.5f, 1}, 1);
  const Solution t = Solve(black.Build(), o);
  double worst = 0;
  int nodes = 0;
  for (uint32_t n = 0; n < t.mesh.node_count(); ++n) {
    if (t.mesh.patches[t.mesh.node_patch[n]].material != 1) continue;
    worst = std::max(worst, std::abs(double(t.total.Flux(n)[0]) / kPi - 0.8));
    ++nodes;
  }
  EXPECT_GT(nodes, 20);
  EXPECT_LT(worst, 0.8 * 0.01);
}

}  // namespace
}  // namespace lobe
