#include "scene/refine.h"

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "scene/gltf_scene.h"
#include "tests/support/mesh_laws.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::ExpectMeshLayout;
using test::ExpectSameMesh;
using test::SceneBuilder;

constexpr size_t kAnyNumber = std::numeric_limits<size_t>::max();
constexpr float kUncut = 1e4f;  // a longest edge that leaves faces as they are

uint32_t Grey(SceneBuilder* b, bool double_sided = false) {
  return b->AddMaterial("grey", Lambert{Rgb::Constant(0.5f)}, Rgb::Zero(), double_sided);
}

Scene CornellBox() { return ReadGltfScene(LOBE_TEST_DATA "/scenes/cornell_diffuse.glb"); }

/// Open, with smooth normals, tilted so that coordinates are no round numbers.
Scene Cylinder() {
  constexpr int kColumns = 24;
  SceneBuilder b;
  std::vector<Vec3> positions, normals;
  std::vector<std::array<uint32_t, 3>> triangles;
  const Eigen::Matrix3f tilt = Eigen::AngleAxisf(0.4f, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (uint32_t j = 0; j < kColumns; ++j) {
    const float phi = 2 * std::numbers::pi_v<float> * float(j) / kColumns;
    const Vec3 n(std::cos(phi), 0, -std::sin(phi));
    for (const float y : {0.0f, 1.3f}) {
      positions.push_back(tilt * (n + y * Vec3::UnitY()));
      normals.push_back(tilt * n);
    }
    const uint32_t i = 2 * j, next = 2 * ((j + 1) % kColumns);
    triangles.push_back({i, next, next + 1});
    triangles.push_back({i, next + 1, i + 1});
  }
  b.AddMesh(positions, normals, triangles, Grey(&b));
  return b.Build();
}

/// Thin triangles around one hub: the longest ways for propagation, all edges nearly equal.
Scene Fan() {
  constexpr uint32_t kBlades = 60;
  SceneBuilder b;
  std::vector<Vec3> positions = {Vec3::Zero()};
  std::vector<std::array<uint32_t, 3>> triangles;
  for (uint32_t j = 0; j <= kBlades; ++j) {
    const float phi = 5.5f * float(j) / kBlades, r = 1 + 0.002f * float(j);
    positions.push_back({r * std::cos(phi), r * std::sin(phi), 0});
    if (j > 0) triangles.push_back({0, j, j + 1});
  }
  b.AddMesh(positions, std::vector<Vec3>(positions.size(), Vec3::UnitZ()), triangles, Grey(&b));
  return b.Build();
}

/// A bent sheet of 2 x `n` quads and a flat one, both seen from both sides.
Scene Sheets(int n = 5) {
  SceneBuilder b;
  MetallicRoughness sheet;
  sheet.metallic = 0;
  sheet.diffuse_transmission = 0.5f;
  const uint32_t paper = b.AddMaterial("paper", sheet, Rgb::Zero(), true);
  std::vector<Vec3> positions, normals;
  std::vector<std::array<uint32_t, 3>> triangles;
  for (int i = 0; i <= n; ++i) {
    const float phi = 0.3f * float(i);
    for (const float y : {0.0f, 0.7f, 1.1f}) {
      positions.push_back({std::sin(phi), y, std::cos(phi)});
      normals.push_back({std::sin(phi), 0, std::cos(phi)});
    }
    for (uint32_t k = 0; i > 0 && k < 2; ++k) {
      const uint32_t q = 3 * uint32_t(i - 1) + k;
      triangles.push_back({q, q + 3, q + 4});
      triangles.push_back({q, q + 4, q + 1});
    }
  }
  b.AddMesh(positions, normals, triangles, paper);
  b.AddQuad({3, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}, paper);
  return b.Build();
}

Mesh WithEdge(const Scene& scene, float max_edge) { return Tessellate(scene, {.max_edge = max_edge}); }

Refinement Refine(const Scene& scene, const Mesh& mesh, const std::vector<float>& priority,
                  size_t max_nodes = kAnyNumber) {
  return RefineMesh(scene, mesh, priority, {}, max_nodes);
}

std::vector<float> RandomPriority(const Mesh& mesh, double share, std::mt19937* bits) {
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<float> priority(mesh.element_count());
  for (float& p : priority) p = uniform(*bits) < share ? 0.1f + uniform(*bits) : 0;
  return priority;
}

std::vector<float> Ask(const Mesh& mesh, uint32_t element) {
  std::vector<float> priority(mesh.element_count(), 0.0f);
  priority[element] = 1;
  return priority;
}

/// Elements of the new mesh that were in the old one, by old number; kNone for those that were cut.
std::vector<uint32_t> UncutElements(const Mesh& old, const Refinement& r) {
  std::map<std::array<uint32_t, 3>, uint32_t> by_corners;
  for (uint32_t e = 0; e < r.mesh.element_count(); ++e) by_corners[r.mesh.elements[e]] = e;
  std::vector<uint32_t> uncut;
  for (const auto& [a, b, c] : old.elements) {
    const auto found = by_corners.find({r.node_of_old[a], r.node_of_old[b], r.node_of_old[c]});
    uncut.push_back(found == by_corners.end() ? kNone : found->second);
  }
  return uncut;
}

TEST(RefineTest, RandomRefinementKeepsTheLawsOfAMesh) {
  const std::pair<const char*, Scene> scenes[] = {
      {"box", CornellBox()}, {"cylinder", Cylinder()}, {"fan", Fan()}, {"sheets", Sheets()}};
  for (const auto& [name, scene] : scenes) {
    SCOPED_TRACE(name);
    std::mt19937 bits(11);
    Mesh mesh = WithEdge(scene, kUncut);
    const double border = test::BorderLength(mesh), angle = test::SmallestAngle(mesh);
    const std::vector<Mesh::Patch> patches = mesh.patches;
    for (int round = 0; round < 8; ++round) {
      SCOPED_TRACE(round);
      const std::vector<float> priority = RandomPriority(mesh, round < 2 ? 0.6 : 0.2, &bits);
      const Refinement r = Refine(scene, mesh, priority);
      ExpectMeshLayout(scene, r.mesh);
      if (HasFatalFailure()) return;
      EXPECT_EQ(test::CountTJunctions(r.mesh), 0u);
      EXPECT_NEAR(test::BorderLength(r.mesh), border, 1e-5 * border);
      EXPECT_GE(test::SmallestAngle(r.mesh), 0.499 * angle);
      test::ExpectLocateGivesThePoint(scene, r.mesh, 30);
      EXPECT_FALSE(r.out_of_nodes);
      EXPECT_EQ(r.left_too_small, 0u);

      const std::vector<uint32_t> uncut = UncutElements(mesh, r);
      size_t asked = 0;
      for (size_t e = 0; e < priority.size(); ++e) {
        if (priority[e] == 0) continue;
        ++asked;
        EXPECT_EQ(uncut[e], kNone) << "what is asked for is cut";
      }
      EXPECT_EQ(r.asked, asked);
      ASSERT_EQ(r.mesh.patches.size(), patches.size());
      for (size_t p = 0; p < patches.size(); ++p) {
        EXPECT_EQ(r.mesh.patches[p].planar, patches[p].planar);
        EXPECT_EQ(r.mesh.patches[p].material, patches[p].material);
      }
      mesh = r.mesh;
    }
    EXPECT_GT(mesh.element_count(), 500u);
  }
}

// The checker itself: cut by hand on one side only.
TEST(RefineTest, CountTJunctionsFindsAnEdgeCutOnOneSideOnly) {
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, Grey(&b));
  Mesh mesh = WithEdge(b.Build(), kUncut);
  ASSERT_EQ(mesh.elements[0], (std::array<uint32_t, 3>{0, 1, 2}));  // the diagonal is 2-0
  EXPECT_EQ(test::CountTJunctions(mesh), 0u);
  mesh.node_position.push_back({0.5f, 0.5f, 0});
  mesh.elements = {{1, 2, 4}, {1, 4, 0}, mesh.elements[1]};
  mesh.patches[0].node_end = 5;
  mesh.patches[0].element_end = 3;
  EXPECT_GE(test::CountTJunctions(mesh), 1u);
}

TEST(RefineTest, CutsWhatIsAskedForAndItsPropagationPathOnly) {
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, Grey(&b));
  const Scene scene = b.Build();
  const Mesh square = WithEdge(scene, kUncut);
  // The diagonal is the longest edge of both triangles.
  const Refinement four = Refine(scene, square, Ask(square, 0));
  EXPECT_EQ(four.mesh.element_count(), 4u);
  EXPECT_EQ(four.mesh.node_count(), 5u);
  // Then the longest edges are the square's own, on its border.
  const Refinement five = Refine(scene, four.mesh, Ask(four.mesh, 2));
  EXPECT_EQ(five.mesh.element_count(), 5u);
  EXPECT_EQ(five.mesh.node_count(), 6u);
  // The small triangle's longest edge is a short one of its uncut neighbour, which goes first: at the border,
  // one node more, and one for the edge between.
  uint32_t small = kNone;
  for (uint32_t e = 0; e < 5; ++e) {
    const bool has_middle = std::ranges::count(five.mesh.elements[e], five.made[0]) > 0;
    if (!has_middle) continue;
    const Refinement r = Refine(scene, five.mesh, Ask(five.mesh, e));
    EXPECT_EQ(r.mesh.element_count(), 8u);
    EXPECT_EQ(r.mesh.node_count(), 8u);
    small = e;
  }
  EXPECT_NE(small, kNone);
}

TEST(RefineTest, RefiningAllOfASquareIsTessellatingItFiner) {
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, Grey(&b));
  const Scene scene = b.Build();
  Mesh mesh = WithEdge(scene, kUncut);
  for (double hypotenuse = 1; hypotenuse > 0.05; hypotenuse /= std::numbers::sqrt2) {
    mesh = Refine(scene, mesh, std::vector<float>(mesh.element_count(), 1.0f)).mesh;
    ExpectSameMesh(mesh, WithEdge(scene, static_cast<float>(hypotenuse)));
  }
}

TEST(RefineTest, NothingAskedForLeavesEveryBit) {
  for (const Scene& scene : {CornellBox(), Cylinder(), Sheets()}) {
    const Mesh mesh = WithEdge(scene, 0.3f);
    const Refinement r = Refine(scene, mesh, std::vector<float>(mesh.element_count(), 0.0f));
    ExpectSameMesh(r.mesh, mesh);
    EXPECT_EQ(r.mesh.roots, mesh.roots);
    EXPECT_EQ(r.made.size(), 0u);
    for (uint32_t n = 0; n < mesh.node_count(); ++n) {
      EXPECT_EQ(r.node_of_old[n], n);
      EXPECT_EQ(r.parents[n], (std::array<uint32_t, 2>{n, n}));
    }
  }
}

TEST(RefineTest, LinearFunctionsAreCarriedOverByParents) {
  for (const Scene& scene : {CornellBox(), Cylinder()}) {
    std::mt19937 bits(2);
    const Mesh mesh = WithEdge(scene, 0.8f);
    const Refinement r = Refine(scene, mesh, RandomPriority(mesh, 0.5, &bits));
    ASSERT_EQ(r.parents.size(), r.mesh.node_count());
    ASSERT_EQ(r.made.size(), r.mesh.node_count() - mesh.node_count());
    const auto linear = [](const Vec3& p) { return 0.3 * p.x() - 1.7 * p.y() + 0.9 * p.z() + 2; };
    std::vector<double> value(r.mesh.node_count(), std::nan(""));
    for (size_t n = 0; n < mesh.node_count(); ++n) {
      const uint32_t m = r.node_of_old[n];
      EXPECT_EQ(mesh.node_position[n], r.mesh.node_position[m]);
      EXPECT_EQ(mesh.node_normal[n], r.mesh.node_normal[m]);
      EXPECT_EQ(r.parents[m], (std::array<uint32_t, 2>{m, m}));
      value[m] = linear(mesh.node_position[n]);
    }
    for (const uint32_t m : r.made) {
      const auto& [a, b] = r.parents[m];
      const Vec3 &p = r.mesh.node_position[a], &q = r.mesh.node_position[b];
      EXPECT_EQ(r.mesh.node_position[m], Vec3((p + q) * 0.5f));
      EXPECT_LT((r.mesh.node_normal[m] - (r.mesh.node_normal[a] + r.mesh.node_normal[b]).normalized()).norm(),
                1e-6f);
      value[m] = 0.5 * (value[a] + value[b]);
      // Parents come first, or their values were not known. Positions round by 2^-24 of 5 m and less, a few
      // times over.
      EXPECT_NEAR(value[m], linear(r.mesh.node_position[m]), 5e-6);
    }
  }
}

TEST(RefineTest, TwoRequestsInOneCallOrTwoGiveTheSameMesh) {
  for (const Scene& scene : {CornellBox(), Cylinder(), Fan(), Sheets()}) {
    std::mt19937 bits(17);
    const Mesh mesh = WithEdge(scene, 0.9f);
    const std::vector<float> first = RandomPriority(mesh, 0.2, &bits),
                             second = RandomPriority(mesh, 0.2, &bits);
    std::vector<float> both = first;
    for (size_t e = 0; e < both.size(); ++e) both[e] = std::max(both[e], second[e]);
    const Refinement at_once = Refine(scene, mesh, both);

    const Refinement once = Refine(scene, mesh, first);
    const std::vector<uint32_t> uncut = UncutElements(mesh, once);
    std::vector<float> rest(once.mesh.element_count(), 0.0f);
    for (size_t e = 0; e < second.size(); ++e) {
      if (uncut[e] != kNone) rest[uncut[e]] = second[e];
    }
    ExpectSameMesh(at_once.mesh, Refine(scene, once.mesh, rest).mesh);
  }
}

TEST(RefineTest, PrioritiesDecideNothingWhileThereAreNodesEnough) {
  const Scene scene = Cylinder();
  std::mt19937 bits(23);
  const Mesh mesh = WithEdge(scene, 0.2f);
  std::vector<float> priority = RandomPriority(mesh, 0.3, &bits);
  const Refinement a = Refine(scene, mesh, priority);
  for (float& p : priority) p = p > 0 ? 1.0f / p : p;
  ExpectSameMesh(a.mesh, Refine(scene, mesh, priority).mesh);
}

TEST(RefineTest, NeverHasMoreThanMaxNodes) {
  for (const Scene& scene : {CornellBox(), Sheets()}) {
    std::mt19937 bits(29);
    const Mesh mesh = WithEdge(scene, 0.9f);
    const std::vector<float> priority = RandomPriority(mesh, 0.5, &bits);
    const Refinement all = Refine(scene, mesh, priority);
    EXPECT_FALSE(Refine(scene, mesh, priority, all.mesh.node_count()).out_of_nodes);
    const size_t before = mesh.node_count(), made = all.made.size();
    for (const size_t more : {size_t{0}, size_t{1}, made / 7, made / 2, made - 1}) {
      const Refinement r = Refine(scene, mesh, priority, before + more);
      EXPECT_TRUE(r.out_of_nodes);
      EXPECT_LE(r.mesh.node_count(), before + more);
      ExpectMeshLayout(scene, r.mesh);
      EXPECT_EQ(test::CountTJunctions(r.mesh), 0u);
      // Only the request that did not fit can leave nodes unused, and its path is not long here.
      EXPECT_GE(r.mesh.node_count() + 20, before + more);
      // Everything cut has a higher priority than the highest that was not, or was on somebody's path: to
      // refine for those above it alone gives the same.
      const std::vector<uint32_t> uncut = UncutElements(mesh, r);
      float refused = 0;
      for (size_t e = 0; e < priority.size(); ++e) {
        if (uncut[e] != kNone) refused = std::max(refused, priority[e]);
      }
      std::vector<float> granted = priority;
      for (float& p : granted) p = p > refused ? p : 0;
      ExpectSameMesh(r.mesh, Refine(scene, mesh, granted).mesh);
    }
    ExpectSameMesh(Refine(scene, mesh, priority, 0).mesh, mesh);
  }
}

/// Is every tree of a front the flip of its back's?
bool SidesAreAlike(const Mesh& mesh) {
  for (size_t f = 0; f < mesh.roots.size() / 2; ++f) {
    std::vector<std::pair<uint32_t, uint32_t>> open = {{mesh.roots[2 * f], mesh.roots[2 * f + 1]}};
    while (!open.empty()) {
      const Mesh::Cell &a = mesh.cells[open.back().first], &b = mesh.cells[open.back().second];
      open.pop_back();
      if ((a.child == kNone) != (b.child == kNone)) return false;
      if (a.child == kNone) {
        const auto &p = mesh.elements[a.element], &q = mesh.elements[b.element];
        for (int k = 0; k < 3; ++k) {
          if (mesh.node_position[p[k]] != mesh.node_position[q[(3 - k) % 3]]) return false;
        }
      } else {
        if (b.apex != (3 - a.apex) % 3) return false;
        open.insert(open.end(), {{a.child, b.child + 1}, {a.child + 1, b.child}});
      }
    }
  }
  return true;
}

TEST(RefineTest, BothSidesOfASheetAreCutAlike) {
  const Scene scene = Sheets();
  Mesh mesh = WithEdge(scene, kUncut);
  ASSERT_TRUE(SidesAreAlike(mesh));
  std::mt19937 bits(31);
  for (int round = 0; round < 6; ++round) {
    // One side asks here, the other there, and the last rounds run out of nodes.
    const size_t max_nodes = round < 4 ? kAnyNumber : mesh.node_count() + 31;
    const Refinement r = Refine(scene, mesh, RandomPriority(mesh, 0.2, &bits), max_nodes);
    EXPECT_EQ(r.out_of_nodes, round >= 4);
    EXPECT_TRUE(SidesAreAlike(r.mesh)) << "round " << round;
    EXPECT_GT(r.mesh.node_count(), mesh.node_count());
    mesh = r.mesh;
  }
}

TEST(RefineTest, ElementsTooSmallForTheirCoordinatesAreLeft) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  b.AddTriangle({1e6f, 0, 0}, {1e6f + 1, 0, 0}, {1e6f, 1, 0}, grey);  // steps of 1/16
  b.AddTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, grey);
  const Scene scene = b.Build();
  Mesh mesh = WithEdge(scene, kUncut);
  const Refinement r = Refine(scene, mesh, {1, 1});
  EXPECT_EQ(r.left_too_small, 1u);
  EXPECT_FALSE(r.out_of_nodes);
  EXPECT_EQ(r.mesh.element_count(), 3u);
  // However often one asks, it comes to an end, and no node comes to lie on another.
  mesh = r.mesh;
  for (int i = 0; i < 60; ++i) {
    uint32_t corner = kNone;  // always the element at the corner (1, 0, 0)
    for (uint32_t e = 0; e < mesh.element_count(); ++e) {
      for (const uint32_t n : mesh.elements[e]) {
        if (mesh.node_position[n] == Vec3(1, 0, 0)) corner = e;
      }
    }
    ASSERT_NE(corner, kNone);
    mesh = Refine(scene, mesh, Ask(mesh, corner)).mesh;
  }
  EXPECT_EQ(Refine(scene, mesh, std::vector<float>(mesh.element_count(), 1)).mesh.patches.size(), 2u);
  std::set<std::array<float, 3>> positions;
  for (const Vec3& p : mesh.node_position) positions.insert({p.x(), p.y(), p.z()});
  EXPECT_EQ(positions.size(), mesh.node_count());
  EXPECT_LT(mesh.node_count(), 200u);
}

TEST(RefineTest, NormalsThatOpposeEachOtherGiveWayToTheGeometry) {
  // Shading normals at the ends of the longest edge that cancel out in its middle.
  const Vec3 n = Vec3(0.999f, 0, std::sqrt(1 - 0.999f * 0.999f));
  SceneBuilder b;
  b.AddMesh({{0, 0, 0}, {1, 0, 0}, {0.5f, 0.1f, 0}}, {n, Vec3(-n.x(), 0, n.z()), Vec3::UnitZ()}, {{0, 1, 2}},
            Grey(&b));
  const Scene scene = b.Build();
  Mesh mesh = WithEdge(scene, kUncut);
  mesh.node_normal[1] = -mesh.node_normal[0];  // as only a file by another hand would have it
  const Refinement r = Refine(scene, mesh, {1});
  ASSERT_EQ(r.made.size(), 1u);
  EXPECT_EQ(r.mesh.node_normal[r.made[0]], Vec3(0, 0, 1));
}

TEST(RefineTest, MeshesByAnotherHandThatAreNoManifoldAreRefinedInPieces) {
  // Three elements on one edge, one of them wound the wrong way, one with a corner twice, an unused node.
  SceneBuilder b;
  b.AddMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3f, 1.2f, 0}, {0.5f, -1, 0}, {1, 1, 0}},
            std::vector<Vec3>(6, Vec3::UnitZ()), {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {1, 5, 2}}, Grey(&b));
  const Scene scene = b.Build();
  Mesh mesh;
  mesh.patches = {{0, 0, Side::kFront, true, 0, 7, 0, 4}};
  mesh.node_position = scene.positions;
  mesh.node_position.push_back({7, 7, 7});
  mesh.node_normal.assign(7, Vec3::UnitZ());
  mesh.node_patch.assign(7, 0);
  mesh.element_patch.assign(4, 0);
  mesh.elements = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {1, 1, 2}};
  mesh.roots.assign(8, kNone);
  for (uint32_t f = 0; f < 4; ++f) {
    mesh.roots[2 * f] = f;
    mesh.cells.push_back({kNone, f, 0});
  }
  const Refinement r = Refine(scene, mesh, {1, 1, 1, 1});
  EXPECT_GE(r.mesh.element_count(), 8u);
  EXPECT_EQ(r.mesh.node_count(), mesh.node_count() + r.made.size());
  std::vector<bool> known(r.mesh.node_count(), false);
  for (const uint32_t n : r.node_of_old) known[n] = true;
  for (const uint32_t n : r.made) {
    const auto& [a, c] = r.parents[n];
    EXPECT_TRUE(known[a] && known[c]);
    EXPECT_EQ(r.mesh.node_position[n], Vec3((r.mesh.node_position[a] + r.mesh.node_position[c]) * 0.5f));
    known[n] = true;
  }
  for (uint32_t f = 0; f < 4; ++f) {
    const Mesh::Location where = r.mesh.Locate(f, Side::kFront, 0.3f, 0.4f);
    EXPECT_LT(where.element, r.mesh.element_count());
  }
}

TEST(RefineTest, RefusesWhatDoesNotFitTogether) {
  const Scene scene = Cylinder();
  const Mesh mesh = WithEdge(scene, 1);
  EXPECT_THROW(Refine(scene, mesh, {1}), std::invalid_argument);
  EXPECT_THROW(Refine(Fan(), mesh, std::vector<float>(mesh.element_count(), 1)), std::invalid_argument);
}

TEST(RefineTest, AHundredThousandElementsAreConforming) {
  const Scene scene = CornellBox();
  const Mesh mesh = WithEdge(scene, 0.15f);
  std::mt19937 bits(3);
  const Refinement r = Refine(scene, mesh, RandomPriority(mesh, 0.3, &bits));
  EXPECT_GT(r.mesh.element_count(), 100'000u);
  ExpectMeshLayout(scene, r.mesh);
  EXPECT_EQ(test::CountTJunctions(r.mesh), 0u);
}

}  // namespace
}  // namespace lobe
