#include "scene/sample_points.h"

#include <gtest/gtest.h>

#include "scene/gltf_scene.h"
#include "scene/tessellate.h"
#include "tests/support/mesh_laws.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

TEST(SamplePointsTest, AreThoseOfTessellateWhenPlacedAgain) {
  for (const char* name : {"cornell_glossy", "lampshade"}) {
    const Scene scene = ReadGltfScene(std::string(LOBE_TEST_DATA "/scenes/") + name + ".glb");
    const TessellateOptions options{.max_edge = 0.3f, .border_inset = 0.05f};
    const Mesh mesh = Tessellate(scene, options);
    Mesh again = mesh;
    again.node_sample_position.clear();
    again.node_sample_normal.clear();
    PlaceSamplePoints(&again, options.border_inset);
    test::ExpectSameMesh(again, mesh);
    PlaceSamplePoints(&again, 0.02f);
    EXPECT_FALSE(test::SameBits(again.node_sample_position, mesh.node_sample_position));
  }
}

TEST(SamplePointsTest, BorderNodesGoTheInsetTowardsTheMeanCentroid) {
  test::SceneBuilder b;
  b.AddQuad({0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, b.AddLambert(Rgb::Constant(0.5f)));
  Mesh mesh = Tessellate(b.Build(), {.max_edge = 10});
  PlaceSamplePoints(&mesh, 0.5f);
  // Centroids (2, 1) and (1, 2): nodes on the diagonal go towards (1.5, 1.5), the others to their own.
  const auto sample_at = [&mesh](const Vec3& p) {
    for (size_t n = 0; n < mesh.node_count(); ++n) {
      if (mesh.node_position[n] == p) return mesh.node_sample_position[n];
    }
    return Vec3(-1, -1, -1);
  };
  EXPECT_LT((sample_at({0, 0, 0}) - Vec3(0.75f, 0.75f, 0)).norm(), 1e-6f);
  EXPECT_LT((sample_at({3, 3, 0}) - Vec3(2.25f, 2.25f, 0)).norm(), 1e-6f);
  EXPECT_LT((sample_at({3, 0, 0}) - Vec3(2.5f, 0.5f, 0)).norm(), 1e-6f);
  EXPECT_LT((sample_at({0, 3, 0}) - Vec3(0.5f, 2.5f, 0)).norm(), 1e-6f);
}

TEST(SamplePointsTest, NodesWithoutAreaAroundThemKeepTheirShadingNormal) {
  Mesh mesh;  // as a file by another hand may have it
  mesh.patches = {{0, 0, Side::kFront, true, 0, 4, 0, 1}};
  mesh.node_position = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
  mesh.node_normal.assign(4, Vec3::UnitY());
  mesh.elements = {{0, 1, 2}};
  PlaceSamplePoints(&mesh, 0.1f);
  for (int n = 0; n < 4; ++n) {
    EXPECT_EQ(mesh.node_sample_normal[n], Vec3::UnitY());
    EXPECT_TRUE(mesh.node_sample_position[n].allFinite());
  }
  EXPECT_EQ(mesh.node_sample_position[3], mesh.node_position[3]);
}

}  // namespace
}  // namespace lobe
