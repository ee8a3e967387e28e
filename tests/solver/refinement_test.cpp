#include "solver/refinement.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "scene/tessellate.h"
#include "solver/solver.h"
#include "tests/support/mesh_laws.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

constexpr size_t kAnyNumber = std::numeric_limits<size_t>::max();

// A square of side 2 in the plane y = 0.
Scene Floor() {
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {0, 0, 2}, {2, 0, 2}, {2, 0, 0}, b.AddLambert(Rgb::Constant(0.5f)));
  return b.Build();
}

// Diffuse light of the radiance given by a function of position.
NodeLobes Light(const Mesh& mesh, const std::function<double(const Vec3&)>& radiance) {
  NodeLobes out(mesh, std::vector<PartDegrees>(mesh.patches.size()));
  for (uint32_t n = 0; n < mesh.node_count(); ++n) {
    for (int c = 0; c < 3; ++c) {
      out.base(n)[c] = float(radiance(mesh.node_position[n]) * std::sqrt(2 * std::numbers::pi));
    }
  }
  return out;
}

std::vector<double> Areas(const Mesh& mesh) {
  return NodeAreas(mesh, std::vector<uint8_t>(mesh.node_count(), 0));
}

TEST(RoughnessTest, BetweenEndsIsTheLargestDifferenceOverTheBrightnessThereabouts) {
  const Scene scene = Floor();
  const Mesh mesh = Tessellate(scene, {.max_edge = 0.5f});
  const auto radiance = [](const Vec3& p) { return 1 + 0.5 * p.x() + 0.2 * p.z(); };
  const NodeLobes light = Light(mesh, radiance);
  const auto area = Areas(mesh);
  double mean = 0, whole = 0;
  for (uint32_t n = 0; n < mesh.node_count(); ++n) {
    mean += area[n] * radiance(mesh.node_position[n]);
    whole += area[n];
  }
  mean /= whole;
  const auto got = Roughness(mesh, light, area).BetweenEnds(0.02);
  for (uint32_t e = 0; e < mesh.element_count(); ++e) {
    double expected = 0;
    for (int k = 0; k < 3; ++k) {
      const double a = radiance(mesh.node_position[mesh.elements[e][k]]);
      const double b = radiance(mesh.node_position[mesh.elements[e][(k + 1) % 3]]);
      expected = std::max(expected, std::abs(a - b) / (0.5 * (0.5 * (a + b) + mean)));
    }
    EXPECT_NEAR(got[e], expected > 0.02 ? expected : 0, 1e-5);
  }
}

TEST(RoughnessTest, EvenLightIsNotRough) {
  const Scene scene = Floor();
  const Mesh mesh = Tessellate(scene, {.max_edge = 0.5f});
  const NodeLobes light = Light(mesh, [](const Vec3&) { return 3; });
  const auto area = Areas(mesh);
  for (const float e : Roughness(mesh, light, area).BetweenEnds(1e-5)) EXPECT_EQ(e, 0);
}

// Every element is cut once, then light is looked at in the new nodes.
struct Halved {
  Scene scene = Floor();
  Mesh before = Tessellate(scene, {.max_edge = 0.8f});
  Refinement refined =
      RefineMesh(scene, before, std::vector<float>(before.element_count(), 1.0f), {}, kAnyNumber);
};

TEST(RoughnessTest, AtMidpointsLinearLightStops) {
  const Halved h;
  const NodeLobes light = Light(h.refined.mesh, [](const Vec3& p) { return 1 + 3 * p.x() - 0.4 * p.z(); });
  const auto area = Areas(h.refined.mesh);
  ASSERT_FALSE(h.refined.made.empty());
  for (const float e : Roughness(h.refined.mesh, light, area).AtMidpoints(h.refined, 1e-5)) EXPECT_EQ(e, 0);
}

// Of q x^2 the middle of an edge of length d along x is off by q d^2 / 4.
TEST(RoughnessTest, AtMidpointsQuadraticLightIsOffByItsSecondDifference) {
  const Halved h;
  const Mesh& mesh = h.refined.mesh;
  const auto radiance = [](const Vec3& p) { return 2 + 0.7 * p.x() * p.x(); };
  const NodeLobes light = Light(mesh, radiance);
  const auto area = Areas(mesh);
  double mean = 0, whole = 0;
  for (uint32_t n = 0; n < mesh.node_count(); ++n) {
    mean += area[n] * radiance(mesh.node_position[n]);
    whole += area[n];
  }
  mean /= whole;
  std::vector<double> node_error(mesh.node_count(), 0.0);
  for (const uint32_t n : h.refined.made) {
    const Vec3 &a = mesh.node_position[h.refined.parents[n][0]],
               &b = mesh.node_position[h.refined.parents[n][1]];
    const double d = a.x() - b.x();
    node_error[n] = 0.7 * d * d / 4 / (0.5 * (0.5 * (radiance(a) + radiance(b)) + mean));
  }
  const auto got = Roughness(mesh, light, area).AtMidpoints(h.refined, 1e-3);
  double largest = 0;
  for (uint32_t e = 0; e < mesh.element_count(); ++e) {
    double expected = 0;
    for (const uint32_t n : mesh.elements[e]) expected = std::max(expected, node_error[n]);
    EXPECT_NEAR(got[e], expected > 1e-3 ? expected : 0, 2e-6);
    largest = std::max(largest, expected);
  }
  EXPECT_GT(largest, 0.01);
}

TEST(RoughnessTest, NodesWithoutAreaAreLeftOut) {
  const Scene scene = Floor();
  const Mesh mesh = Tessellate(scene, {.max_edge = 0.5f});
  const NodeLobes light = Light(mesh, [](const Vec3& p) { return p.x() > 0.9 ? 100.0 : 1.0; });
  auto area = Areas(mesh);
  for (uint32_t n = 0; n < mesh.node_count(); ++n) {
    if (mesh.node_position[n].x() > 0.9f) area[n] = 0;
  }
  for (const float e : Roughness(mesh, light, area).BetweenEnds(1e-3)) EXPECT_EQ(e, 0);
}

TEST(CarryOverTest, OldNodesKeepTheirLobesAndNewOnesStartFromZero) {
  const Halved h;
  const NodeLobes light = Light(h.before, [](const Vec3& p) { return 1 + p.x() + 10 * p.z(); });
  const NodeLobes carried = CarryOver(light, h.refined);
  ASSERT_EQ(carried.node_count(), h.refined.mesh.node_count());
  for (uint32_t n = 0; n < h.before.node_count(); ++n) {
    EXPECT_EQ(carried.base(h.refined.node_of_old[n])[1], light.base(n)[1]);
  }
  for (const uint32_t n : h.refined.made) EXPECT_EQ(carried.base(n)[0], 0);
}

// A big lamp lights the walls evenly; a small one, with a plate before it, throws a sharp shadow on the
// floor.
Scene RoomWithAShadow() {
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  b.AddQuad({0, 0, 0}, {0, 0, 4}, {4, 0, 4}, {4, 0, 0}, grey);
  b.AddQuad({1.97f, 4, 1.97f}, {2.03f, 4, 1.97f}, {2.03f, 4, 2.03f}, {1.97f, 4, 2.03f},
            b.AddEmitter(Rgb::Constant(5000)));
  b.AddQuad({1.5f, 2, 1.5f}, {1.5f, 2, 2.5f}, {2.5f, 2, 2.5f}, {2.5f, 2, 1.5f}, grey);
  return b.Build();
}

SolveOptions Options(double error) {
  SolveOptions o;
  o.mesh.max_edge = 0.7f;
  o.refine.error = error;
  o.refine.rounds = 6;
  o.max_steps = 0;
  return o;
}

// On the floor: does the element meet the border of the plate's shadow, the square from 1 to 3?
bool OnTheShadowsEdge(const Mesh& mesh, uint32_t element, float margin) {
  const auto& c = mesh.elements[element];
  float least = 100, most = 0;
  for (const uint32_t n : c) {
    const Vec3& p = mesh.node_position[n];
    const float r = std::max(std::abs(p.x() - 2), std::abs(p.z() - 2));
    least = std::min(least, r);
    most = std::max(most, r);
  }
  return least < 1 + margin && most > 1 - margin;
}

TEST(RefinedSolveTest, RefinesAtAShadowsEdgeAndNotElsewhere) {
  const Solution s = Solve(RoomWithAShadow(), Options(0.1));
  double smallest = 1e9, largest_at_edge = 0, smallest_away = 1e9;
  for (uint32_t e = 0; e < s.mesh.element_count(); ++e) {
    bool floor = true;
    for (const uint32_t n : s.mesh.elements[e]) floor = floor && s.mesh.node_position[n].y() == 0;
    if (!floor) continue;
    const double area = s.mesh.ElementArea(e);
    smallest = std::min(smallest, area);
    if (OnTheShadowsEdge(s.mesh, e, 0)) largest_at_edge = std::max(largest_at_edge, area);
    // Conforming cuts reach a little beyond; well inside and outside nothing bends.
    if (!OnTheShadowsEdge(s.mesh, e, 0.5f)) smallest_away = std::min(smallest_away, area);
  }
  EXPECT_LT(largest_at_edge, 0.25 * smallest_away);
  const Solution uniform = Solve(RoomWithAShadow(), Options(0));
  double coarsest = 0;
  for (uint32_t e = 0; e < uniform.mesh.element_count(); ++e) {
    coarsest = std::max(coarsest, double(uniform.mesh.ElementArea(e)));
  }
  EXPECT_LT(smallest, coarsest / 30) << "six rounds cut an area to a 64th";
  EXPECT_GT(smallest_away, coarsest / 9);
  EXPECT_EQ(test::CountTJunctions(s.mesh), 0u);
  test::ExpectMeshLayout(s.scene, s.mesh);
}

TEST(RefinedSolveTest, ErrorZeroLeavesTheMeshUniform) {
  const Solution s = Solve(RoomWithAShadow(), Options(0));
  std::vector<bool> sides;
  for (size_t i = 0; i < s.mesh.roots.size(); ++i) sides.push_back(s.mesh.roots[i] != kNone);
  test::ExpectSameMesh(s.mesh, Tessellate(s.scene, s.options.mesh, sides));
}

TEST(RefinedSolveTest, EvenlyLitWallsStayAsTheyAre) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {2, 2, 2}, b.AddMaterial("wall", Lambert{Rgb::Constant(0.5f)}, Rgb::Constant(1)), true);
  const Scene scene = b.Build();
  EXPECT_EQ(Solve(scene, Options(0.1)).mesh.node_count(), Solve(scene, Options(0)).mesh.node_count());
}

TEST(RefinedSolveTest, NeverHasMoreNodesThanAllowed) {
  const size_t uniform = Solve(RoomWithAShadow(), Options(0)).mesh.node_count();
  const size_t free = Solve(RoomWithAShadow(), Options(0.05)).mesh.node_count();
  SolveOptions o = Options(0.05);
  o.refine.max_nodes = (uniform + free) / 2;
  const Solution s = Solve(RoomWithAShadow(), o);
  EXPECT_LE(s.mesh.node_count(), o.refine.max_nodes);
  EXPECT_GT(s.mesh.node_count(), o.refine.max_nodes - 40) << "and uses what it may";
  EXPECT_EQ(test::CountTJunctions(s.mesh), 0u);
  o.refine.max_nodes = 1;
  EXPECT_EQ(Solve(RoomWithAShadow(), o).mesh.node_count(), uniform) << "the mesh asked for stays";
}

TEST(RefinedSolveTest, IsTheSameTwiceAndFinerForLessError) {
  const Solution a = Solve(RoomWithAShadow(), Options(0.1)), b = Solve(RoomWithAShadow(), Options(0.1));
  test::ExpectSameMesh(a.mesh, b.mesh);
  for (uint32_t p = 0; p < a.total.patch_count(); ++p) {
    const auto x = a.total.patch_values(p), y = b.total.patch_values(p);
    ASSERT_EQ(std::memcmp(x.data(), y.data(), x.size_bytes()), 0);
  }
  EXPECT_GT(Solve(RoomWithAShadow(), Options(0.03)).mesh.node_count(), a.mesh.node_count());
}

}  // namespace
}  // namespace lobe
