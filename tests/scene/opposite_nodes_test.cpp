#include "scene/opposite_nodes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "scene/gltf_scene.h"
#include "scene/tessellate.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

uint32_t Paper(SceneBuilder* b) {
  MetallicRoughness m;
  m.metallic = 0;
  m.diffuse_transmission = 0.5f;
  return b->AddMaterial("paper", m, Rgb::Zero(), /*double_sided=*/true);
}

// A truncated cone without floor or lid, with smooth normals; cells of uneven height.
void AddShade(SceneBuilder* b, uint32_t material, int columns = 12) {
  const float rings[] = {0, 0.1f, 0.45f, 0.5f};
  std::vector<Vec3> positions, normals;
  std::vector<std::array<uint32_t, 3>> triangles;
  const float lean = 0.3f;
  for (const float y : rings) {
    for (int j = 0; j < columns; ++j) {
      const float phi = 2 * std::numbers::pi_v<float> * float(j) / float(columns);
      const Vec3 out(std::cos(phi), 0, std::sin(phi));
      positions.push_back(out * (0.4f - lean * y) + Vec3(3, y, 1));
      normals.push_back((out + Vec3(0, lean, 0)).normalized());
    }
  }
  for (int i = 0; i + 1 < int(std::size(rings)); ++i) {
    for (int j = 0; j < columns; ++j) {
      const uint32_t a = i * columns + j, c = i * columns + (j + 1) % columns;
      const uint32_t d = a + columns, e = c + columns;
      triangles.push_back({a, d, c});
      triangles.push_back({c, d, e});
    }
  }
  b->AddMesh(positions, normals, triangles, material);
}

// Sheets of every shape beside opaque things: flat, creased, closed, curved, three on an edge, and some that
// only touch in a corner.
Scene Sheets() {
  SceneBuilder b;
  const uint32_t paper = Paper(&b);
  const uint32_t grey = b.AddMaterial("grey", Lambert{}, Rgb::Zero(), /*double_sided=*/true);
  b.AddQuad({-1, -1, -1}, {-1, -1, 2}, {4, -1, 2}, {4, -1, -1}, grey);
  b.AddQuad({0, 0, 0}, {1, 0, 0}, {1.1f, 0.8f, 0}, {0, 1, 0}, paper);
  b.AddBox({0, 0, 1}, {0.5f, 0.4f, 1.3f}, paper);
  b.AddSphere({2, 0.5f, 0}, 0.4f, paper, 6);
  AddShade(&b, paper);
  const std::vector<Vec3> fan = {{0, 2, 0}, {0, 3, 0}, {1, 2, 0}, {-1, 2, 0.5f}, {0, 2.1f, -1}, {0, 1.5f, 1}};
  const Vec3 up = Vec3(0.1f, 0.2f, 1).normalized();
  b.AddMesh(fan, std::vector<Vec3>(fan.size(), up), {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {0, 5, 3}}, paper);
  return b.Build();
}

void ExpectMirrorImages(const Scene& scene, const Mesh& mesh) {
  const auto opposite = OppositeNodes(mesh, scene);
  ASSERT_EQ(opposite.size(), mesh.node_count());
  size_t pairs = 0;
  for (uint32_t n = 0; n < mesh.node_count(); ++n) {
    const Mesh::Patch& patch = mesh.patches[mesh.node_patch[n]];
    const uint32_t m = opposite[n];
    if (!scene.materials[patch.material].transmits()) {
      ASSERT_EQ(m, kNone);
      continue;
    }
    ASSERT_LT(m, mesh.node_count()) << "node " << n << " of a sheet has nobody on the other side";
    ++pairs;
    ASSERT_EQ(opposite[m], n);
    const Mesh::Patch& other = mesh.patches[mesh.node_patch[m]];
    ASSERT_NE(other.side, patch.side);
    ASSERT_EQ(other.surface, patch.surface);
    ASSERT_EQ(mesh.node_position[m], mesh.node_position[n]);
    // Normals interpolated alike, but averages of neighbours add up in another order.
    ASSERT_LT((mesh.node_normal[m] + mesh.node_normal[n]).norm(), 1e-6f);
  }
  ASSERT_GT(pairs, 0u);
}

TEST(OppositeNodesTest, AreMirrorImagesOnSheetsOfEveryShapeAndEdge) {
  const Scene scene = Sheets();
  for (const float edge : {10.0f, 0.4f, 0.13f, 0.05f}) {
    SCOPED_TRACE(edge);
    ExpectMirrorImages(scene, Tessellate(scene, {.max_edge = edge}));
  }
}

TEST(OppositeNodesTest, AreMirrorImagesOnALampshadeAsReadFromAFile) {
  const Scene scene = ReadGltfScene(LOBE_TEST_DATA "/scenes/lampshade.glb");
  for (const float edge : {0.4f, 0.1f}) ExpectMirrorImages(scene, Tessellate(scene, {.max_edge = edge}));
}

// One side asked for gives both, and only where it was asked for.
TEST(OppositeNodesTest, AreThereWhicheverSideWasWanted) {
  const Scene scene = Sheets();
  std::vector<bool> sides(2 * scene.faces.size());
  for (size_t f = 0; f < scene.faces.size(); ++f) sides[2 * f + f % 2] = f % 5 != 0;
  const Mesh mesh = Tessellate(scene, {.max_edge = 0.2f}, sides);
  ExpectMirrorImages(scene, mesh);
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    const bool both = scene.material(scene.faces[f]).transmits();
    for (const size_t side : {0, 1}) {
      EXPECT_EQ(mesh.roots[2 * f + side] != kNone, f % 5 != 0 && (both || side == f % 2));
    }
  }
}

// A mesh read from a damaged or foreign file: what is not cut alike has no partner, and nothing breaks.
TEST(OppositeNodesTest, MeshesNotCutAlikeGiveNoFalsePairs) {
  const Scene scene = Sheets();
  const Mesh good = Tessellate(scene, {.max_edge = 0.2f});
  const auto all = OppositeNodes(good, scene);
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    if (!scene.material(scene.faces[f]).transmits()) continue;
    Mesh::Cell back = good.cells[good.roots[2 * f + 1]];
    if (back.child == kNone) continue;
    Mesh turned = good;
    turned.cells[good.roots[2 * f + 1]].apex = uint8_t((back.apex + 1) % 3);
    Mesh one_sided = good;
    one_sided.roots[2 * f + 1] = kNone;
    Mesh shallow = good;  // a leaf on one side, cut on the other
    uint32_t leaf = back.child;
    while (good.cells[leaf].child != kNone) leaf = good.cells[leaf].child;
    shallow.cells[good.roots[2 * f + 1]] = good.cells[leaf];
    for (const Mesh& mesh : {turned, one_sided, shallow}) {
      const auto opposite = OppositeNodes(mesh, scene);
      for (uint32_t n = 0; n < opposite.size(); ++n) {
        if (opposite[n] != kNone) {
          ASSERT_EQ(opposite[n], all[n]);
        }
      }
      EXPECT_LT(std::count(all.begin(), all.end(), kNone),
                std::count(opposite.begin(), opposite.end(), kNone));
    }
    return;
  }
  FAIL() << "no face was cut";
}

}  // namespace
}  // namespace lobe
