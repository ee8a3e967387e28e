#include "render/curved_elements.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "render/compare.h"
#include "scene/gltf_scene.h"
#include "solver/solver.h"
#include "tests/support/metal.h"
#include "tests/support/path_classes.h"
#include "tests/support/scene_builder.h"
#include "tests/support/small_pictures.h"

namespace lobe {
namespace {

using namespace test;

// A lit room with a ball in its middle that fills the view. Facets around it: 2 * segments.
Scene Ball(const Reflectance& material, int segments, const Rgb& glow = Rgb::Zero()) {
  SceneBuilder b;
  b.AddBox({-2, -1.5f, -2}, {2, 1.5f, 2}, b.AddLambert(Rgb(0.7f, 0.6f, 0.5f)), /*inward=*/true);
  b.AddQuad({-0.4f, 1.4f, 0.6f}, {0.4f, 1.4f, 0.6f}, {0.4f, 1.4f, 1.2f}, {-0.4f, 1.4f, 1.2f},
            b.AddEmitter(Rgb::Constant(20)));
  b.AddSphere({0, 0, 0}, 0.5f, b.AddMaterial("ball", material, glow), segments);
  b.AddCamera("view", {0.6f, 0.4f, 1.8f}, {0, 0, 0}, Vec3::UnitY(), 0.5f);
  return b.Build();
}

Solution Solved(const Scene& scene) {
  SolveOptions o;
  o.mesh.max_edge = 0.5f;
  o.links = 256;
  return Solve(scene, o);
}

constexpr int kSize = 48;
Image Picture(const Solution& s, const NamedMode& mode, int samples, uint64_t seed, int gather = 4) {
  RenderOptions o = OptionsFor(mode, kSize, samples, seed);
  o.gather_samples = gather;
  return Renderer(s).Render(CameraView(s.scene.cameras[0], kSize, kSize), o, nullptr);
}

TEST(CurvedElementsTest, FlatSurfacesAndLampsHaveNone) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {3, 3, 3}, b.AddLambert(Rgb::Constant(0.7f)), true);
  b.AddBox({1, 1, 1}, {2, 2, 2}, b.AddMaterial("metal", Metal(0.4f)));
  b.AddQuad({1, 2.9f, 1}, {2, 2.9f, 1}, {2, 2.9f, 2}, {1, 2.9f, 2}, b.AddEmitter(Rgb::Constant(10)));
  EXPECT_TRUE(FindCurvedElements(Solved(b.Build())).empty());
  EXPECT_TRUE(FindCurvedElements(Solved(Ball(Metal(0.4f), 6, Rgb::Constant(1)))).empty());
}

// The sharper the lobe, the finer a ball must be to be read; with facets enough it is, whatever the lobe.
TEST(CurvedElementsTest, GlossIsTracedWhereElementsTurnFurtherThanLobesResolve) {
  const auto traced = [](float roughness, int segments) {
    const Solution s = Solved(Ball(Metal(roughness), segments));
    const auto found = FindCurvedElements(s);
    return std::count(found.begin(), found.end(), NotStored::kGloss);
  };
  EXPECT_GT(traced(0.4f, 6), 0);
  EXPECT_GT(traced(0.4f, 24), 0);
  EXPECT_EQ(traced(0.6f, 40), 0);
  EXPECT_EQ(traced(1, 24), 0);
}

TEST(CurvedElementsTest, StraightLightIsSampledOnCoarseFacetsOfDiffuseThings) {
  const auto sampled = [](int segments) {
    const auto found = FindCurvedElements(Solved(Ball(Lambert{Rgb::Constant(0.7f)}, segments)));
    return std::count(found.begin(), found.end(), NotStored::kStraightLight);
  };
  EXPECT_GT(sampled(6), 0);
  EXPECT_EQ(sampled(16), 0);
}

// Rays that a packet leaves to be traced one by one are all of the curved elements', and no others: pictures
// with layers trace every ray on its own.
TEST(CurvedElementsTest, PacketsAndSingleRaysAgreeOnThem) {
  for (const Reflectance& material : {Reflectance(Metal(0.4f)), Reflectance(Lambert{Rgb::Constant(0.7f)})}) {
    const Solution s = Solved(Ball(material, 6));
    ASSERT_FALSE(FindCurvedElements(s).empty());
    const CameraView view(s.scene.cameras[0], kSize, kSize);
    const RenderOptions o = OptionsFor(kAutoMode, kSize, 4);
    const Image packets = Renderer(s).Render(view, o, nullptr);
    LayerSet layers;
    layers.Add(Layer::kNormal);
    const Image rays = Renderer(s).Render(view, o, layers, nullptr).color;
    EXPECT_LT(Compare(packets, rays, nullptr, nullptr).pixel_error, 2e-3);
  }
}

// Few facets or many, dull or shining: within 2 % of gloss that is traced everywhere.
TEST(CurvedElementsTest, MetalBallsOfAnyFacetsShowInAutoWhatTracingShows) {
  for (const float roughness : {0.4f, 0.6f}) {
    for (const int segments : {3, 6, 12, 24}) {
      const Solution s = Solved(Ball(Metal(roughness), segments));
      const Image a = Picture(s, kGatherMode, 16, 2, 16), b = Picture(s, kGatherMode, 16, 3, 16);
      const double error = Compare(Picture(s, kAutoMode, 16, 1, 16), a, &b, nullptr).block_error;
      EXPECT_LT(error, 0.02) << "roughness " << roughness << ", " << 2 * segments << " facets";
    }
  }
}

// Files that failed, at the default settings, against the path tracer.
void ExpectAsTraced(const std::string& file) {
  const Scene scene = ReadGltfScene(LOBE_TEST_DATA "/scenes/" + file);
  const Solution s = Solve(scene, {});
  constexpr int kPixels = 96;
  const CameraView view(scene.cameras[0], kPixels, kPixels);
  const PathTracer paths(scene);
  const auto traced = [&](uint64_t seed) {
    return RenderPathTraced(paths, view, OptionsFor(kStoredMode, kPixels, 400, seed));
  };
  const Image a = traced(1), b = traced(2);
  const Image got = Renderer(s).Render(view, OptionsFor(kAutoMode, kPixels, 64), nullptr);
  EXPECT_LT(Compare(got, a, &b, nullptr).block_error, 0.02) << file;
}

TEST(SlowCurvedElementsTest, GlossOfTwelveFacetsIsAsTraced) {
  ExpectAsTraced("smooth_things_of_12_facets.glb");
}
TEST(SlowCurvedElementsTest, BevelsAreAsTracedFlatAndSmooth) {
  ExpectAsTraced("blender_bevel_smooth.glb");
  ExpectAsTraced("blender_bevel_flat.glb");
}

}  // namespace
}  // namespace lobe
