#include "scene/mesh_edges.h"

#include <map>

#include <gtest/gtest.h>

#include "scene/gltf_scene.h"
#include "scene/tessellate.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

TEST(MeshEdgesTest, ListsEveryEdgeOnceWithItsElements) {
  const Scene scene = ReadGltfScene(LOBE_TEST_DATA "/scenes/lampshade.glb");
  const Mesh mesh = Tessellate(scene, {.max_edge = 0.5f});
  std::map<std::array<uint32_t, 2>, std::vector<uint32_t>> expected;
  for (uint32_t e = 0; e < mesh.element_count(); ++e) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = mesh.elements[e][k], b = mesh.elements[e][(k + 1) % 3];
      expected[{std::min(a, b), std::max(a, b)}].push_back(e);
    }
  }
  const std::vector<MeshEdge> edges = MeshEdges(mesh);
  ASSERT_EQ(edges.size(), expected.size());
  auto next = expected.begin();
  size_t border = 0;
  for (const MeshEdge& edge : edges) {
    ASSERT_EQ(edge.node, next->first) << "in order of nodes";
    ASSERT_EQ(edge.element[0], next->second[0]);
    ASSERT_EQ(edge.element[1], next->second.size() == 2 ? next->second[1] : kNone);
    border += edge.element[1] == kNone;
    ++next;
  }
  EXPECT_GT(border, 0u);
}

TEST(MeshEdgesTest, AClosedSurfaceHasThreeEdgesToTwoElementsAndNoBorder) {
  test::SceneBuilder b;
  b.AddSphere({0, 0, 0}, 1, b.AddLambert(Rgb::Constant(0.5f)), 9);
  const Mesh mesh = Tessellate(b.Build(), {.max_edge = 0.2f});
  const std::vector<MeshEdge> edges = MeshEdges(mesh);
  EXPECT_EQ(2 * edges.size(), 3 * mesh.element_count());
  for (const MeshEdge& edge : edges) EXPECT_NE(edge.element[1], kNone);
}

TEST(MeshEdgesTest, AnEmptyMeshHasNone) { EXPECT_TRUE(MeshEdges(Mesh()).empty()); }

}  // namespace
}  // namespace lobe
