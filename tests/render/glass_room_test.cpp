#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "scene/gltf_scene.h"
#include "tests/support/glass_room.h"
#include "tests/support/path_classes.h"
#include "tests/support/scene_glb.h"

namespace lobe {
namespace {

using namespace test;

TEST(GlassRoomTest, TheSceneInTheFileIsTheOneOfTheCode) {
  const Scene made = GlassRoom();
  if (const char* folder = std::getenv("LOBE_WRITE_SCENES")) {
    WriteSceneGlb(made, std::string(folder) + "/glass_room.glb");
  }
  const Scene read = ReadGltfScene(LOBE_TEST_DATA "/scenes/glass_room.glb");
  EXPECT_EQ(read.warnings, std::vector<std::string>{});
  ASSERT_EQ(read.faces.size(), made.faces.size());
  for (size_t f = 0; f < made.faces.size(); ++f) {
    const auto a = made.Corners(made.faces[f]), b = read.Corners(read.faces[f]);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(a[k], b[k]) << f;
    const Material &x = made.material(made.faces[f]), &y = read.material(read.faces[f]);
    EXPECT_EQ(x.name, y.name);
    EXPECT_EQ(Describe(x.reflectance), Describe(y.reflectance));
    EXPECT_EQ(x.pane(), y.pane());
    EXPECT_EQ(x.body(), y.body());
  }
  EXPECT_EQ(read.FindCamera("view0").eye, made.FindCamera("view0").eye);
}

// What its walls reflect, against the path tracer. Caustics are sharper than the mesh, so only means agree.
TEST(GlassRoomTest, ItsWallsAreAsBrightAsTraced) {
  const Scene scene = GlassRoom();
  const PathTracer paths(scene);
  SolveOptions o = Options(Transport::kLinks, 1024, 0.12f);
  const Solution s = Solve(scene, o);
  EXPECT_LT(s.ledger.Closure(), 1e-4);
  EXPECT_GT(s.ledger.in_glass[0], s.ledger.in_glass[1]) << "green glass";
  for (const uint32_t material : {0u, 1u, 2u}) {
    const auto points = PointsOf(scene, material, 24);
    std::vector<Estimate> traced;
    Eigen::Array3d got = Eigen::Array3d::Zero();
    for (size_t i = 0; i < points.size(); ++i) {
      const Vec3 n = scene.GeometricNormal(scene.faces[points[i].face]);
      traced.push_back(paths.ExitantRadiance(points[i], n, 3000, i + 1));
      const auto where = s.mesh.Locate(points[i].face, Side::kFront, points[i].u, points[i].v);
      const NodeWeights w = Interpolate(s.mesh, s.hidden, where);
      for (int k = 0; k < w.count; ++k) {
        got += (w.weight[k] * s.total.Flux(w.node[k])).cast<double>() / (M_PI * double(points.size()));
      }
    }
    const Estimate want = MeanOf(traced);
    for (int c = 0; c < 3; ++c) {
      RecordProperty("off_" + std::to_string(material) + "_" + std::to_string(c),
                     std::to_string(got[c] / want.mean[c] - 1));
      EXPECT_NEAR(got[c], want.mean[c], 3 * want.standard_error[c] + 0.03 * want.mean[c])
          << "material " << material << ", channel " << c << ": off by " << got[c] / want.mean[c] - 1;
    }
  }
}

}  // namespace
}  // namespace lobe
