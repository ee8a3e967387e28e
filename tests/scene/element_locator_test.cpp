#include "scene/element_locator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/gltf_scene.h"
#include "scene/refine.h"
#include "scene/tessellate.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

// Every front and every back, wanted or not: hits on sides without nodes are part of life.
std::vector<RayHit> RandomHits(const Scene& scene, int per_side) {
  std::mt19937 bits(3);
  std::uniform_real_distribution<float> uniform;
  std::vector<RayHit> hits;
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    for (int i = 0; i < 2 * per_side; ++i) {
      RayHit hit;
      hit.face = f;
      hit.side = i % 2 ? Side::kBack : Side::kFront;
      hit.u = uniform(bits);
      hit.v = uniform(bits);
      if (hit.u + hit.v > 1) hit.u = 1 - hit.u, hit.v = 1 - hit.v;
      if (i % 11 == 0) hit.u = 0;
      if (i % 13 == 0) hit.v = 0.5f * (1 - hit.u);
      hits.push_back(hit);
      if (i % 5 == 0) hits.push_back(RayHit{});  // a miss between them
    }
  }
  return hits;
}

Vec3 PointOf(const Mesh& mesh, const Mesh::Location& where) {
  Vec3 out = Vec3::Zero();
  for (int k = 0; k < 3; ++k) out += where.weight[k] * mesh.node_position[mesh.elements[where.element][k]];
  return out;
}

struct Counts {
  int same = 0, on_edge = 0, nowhere = 0, missed = 0;
};

// Against Mesh::Locate: the same element, or both on the edge between the two elements; the same point.
Counts ExpectAgreesWithMesh(const Scene& scene, const Mesh& mesh, int per_side) {
  const ElementLocator locator(mesh);
  const std::vector<RayHit> hits = RandomHits(scene, per_side);
  std::vector<Mesh::Location> found(hits.size());
  locator.Locate(hits, found);
  const float size = scene.Bounds().diagonal().norm();
  Counts counts;
  for (size_t i = 0; i < hits.size(); ++i) {
    const RayHit& hit = hits[i];
    const Mesh::Location& got = found[i];
    const Mesh::Location one = locator.Locate(hit);
    EXPECT_EQ(one.element, got.element) << "one at a time is as many at once";
    if (!hit.hit()) {
      EXPECT_EQ(got.element, kNone);
      ++counts.missed;
      continue;
    }
    const Mesh::Location want = mesh.Locate(hit.face, hit.side, hit.u, hit.v);
    if (want.element == kNone) {
      EXPECT_EQ(got.element, kNone);
      ++counts.nowhere;
      continue;
    }
    if (got.element == kNone) {
      ADD_FAILURE() << "no element at face " << hit.face;
      continue;
    }
    EXPECT_TRUE(std::equal(one.weight, one.weight + 3, got.weight));
    EXPECT_NEAR(got.weight[0] + got.weight[1] + got.weight[2], 1, 3e-7);
    EXPECT_GE(std::min({got.weight[0], got.weight[1], got.weight[2]}), 0);
    // Barycentrics of a face round by 2^-24; an element's weights by that times face over element, in length.
    const auto p = scene.Corners(scene.faces[hit.face]);
    const float longest = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
    const float height = 2 * mesh.ElementArea(got.element) / longest;  // a lower bound
    const float rounding = 1e-7f * longest / height;                   // 0.65 of it measured
    EXPECT_LT((PointOf(mesh, got) - PointOf(mesh, want)).norm(), 2e-6f * size);
    if (got.element == want.element) {
      ++counts.same;
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(got.weight[k], want.weight[k], rounding);
    } else {
      ++counts.on_edge;
      EXPECT_LT(*std::min_element(got.weight, got.weight + 3), rounding);
      EXPECT_LT(*std::min_element(want.weight, want.weight + 3), rounding);
    }
  }
  return counts;
}

TEST(ElementLocatorTest, FindsTheElementsOfMeshLocateInABoxOfBoxes) {
  for (const char* name : {"cornell_glossy", "lampshade"}) {
    const Scene scene = ReadGltfScene(std::string(LOBE_TEST_DATA "/scenes/") + name + ".glb");
    for (const float edge : {2.0f, 0.5f, 0.07f}) {
      const Counts counts = ExpectAgreesWithMesh(scene, Tessellate(scene, {.max_edge = edge}), 60);
      EXPECT_GT(counts.same, 20 * std::max(counts.on_edge, 1)) << name;
      EXPECT_GT(counts.missed, 0);
    }
  }
}

Scene BallInARoom(bool double_sided) {
  SceneBuilder b;
  const uint32_t grey = b.AddMaterial("grey", Lambert{}, Rgb::Zero(), double_sided);
  b.AddBox({-2, 0, -2}, {2, 3, 2}, grey, true);
  b.AddSphere({0.3f, 1.1f, 0.2f}, 0.7f, grey, 10);
  return b.Build();
}

TEST(ElementLocatorTest, FindsElementsOfBothSidesOfACurvedMesh) {
  const Scene scene = BallInARoom(true);
  const Counts counts = ExpectAgreesWithMesh(scene, Tessellate(scene, {.max_edge = 0.1f}), 40);
  EXPECT_EQ(counts.nowhere, 0);
  EXPECT_GT(counts.same, 10000);
}

TEST(ElementLocatorTest, SidesWithoutNodesHaveNoElement) {
  const Scene scene = BallInARoom(false);
  const Counts counts = ExpectAgreesWithMesh(scene, Tessellate(scene, {.max_edge = 0.2f}), 20);
  EXPECT_EQ(counts.nowhere, int(20 * scene.faces.size())) << "every back";
}

// Trees of very different depth side by side, as refinement makes them.
TEST(ElementLocatorTest, FindsTheElementsOfARefinedMesh) {
  const Scene scene = BallInARoom(true);
  Mesh mesh = Tessellate(scene, {.max_edge = 0.8f});
  const size_t before = mesh.element_count();
  for (int round = 0; round < 14; ++round) {
    std::vector<float> priority(mesh.element_count(), 0.0f);
    for (uint32_t e = 0; e < priority.size(); ++e) {
      const auto& c = mesh.elements[e];
      const Vec3 at = (mesh.node_position[c[0]] + mesh.node_position[c[1]] + mesh.node_position[c[2]]) / 3.0f;
      if ((at - Vec3(0.5f, 0, 0.4f)).norm() < std::pow(0.8f, float(round))) priority[e] = 1;
    }
    mesh = RefineMesh(scene, mesh, priority, {}, std::numeric_limits<size_t>::max()).mesh;
  }
  EXPECT_GT(mesh.element_count(), before + 200);
  const Counts counts = ExpectAgreesWithMesh(scene, mesh, 300);
  EXPECT_GT(counts.same, 20 * std::max(counts.on_edge, 1));
}

TEST(ElementLocatorTest, CountsThatAreNoMultipleOfTheBatchAreFilled) {
  const Scene scene = BallInARoom(true);
  const Mesh mesh = Tessellate(scene, {.max_edge = 0.3f});
  const ElementLocator locator(mesh);
  const std::vector<RayHit> hits = RandomHits(scene, 2);
  for (const size_t count : {size_t(0), size_t(1), size_t(15), size_t(16), size_t(17), size_t(33)}) {
    std::vector<Mesh::Location> found(count + 1, {12345u, {9, 9, 9}});
    locator.Locate({hits.data(), count}, {found.data(), count});
    for (size_t i = 0; i < count; ++i) EXPECT_EQ(found[i].element, locator.Locate(hits[i]).element);
    EXPECT_EQ(found[count].element, 12345u);
  }
}

}  // namespace
}  // namespace lobe
