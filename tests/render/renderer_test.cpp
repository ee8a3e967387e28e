#include "render/renderer.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "solver/solver.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

MetallicRoughness Mirror(float metallic, const Rgb& colour) {
  MetallicRoughness r;
  r.base_color = colour;
  r.metallic = metallic;
  r.roughness = 0;
  return r;
}

Ray RayTo(const Vec3& from, const Vec3& to) {
  return {from, 0, (to - from).normalized(), std::numeric_limits<float>::infinity()};
}

// A black room whose walls emit 1, with a mirror on the floor.
Solution MirrorRoom(const Reflectance& mirror) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {2, 2, 2}, b.AddEmitter(Rgb::Constant(1)), true);
  b.AddQuad({0.5f, 0.1f, 0.5f}, {0.5f, 0.1f, 1.5f}, {1.5f, 0.1f, 1.5f}, {1.5f, 0.1f, 0.5f},
            b.AddMaterial("mirror", mirror));
  SolveOptions o;
  o.mesh.max_edge = 0.5f;
  return Solve(b.Build(), o);
}

TEST(RendererTest, AMetalMirrorShowsFresnelTimesWhatItReflects) {
  const Rgb colour(0.9f, 0.6f, 0.3f);
  const Solution s = MirrorRoom(Mirror(1, colour));
  const Renderer renderer(s);
  for (const float x : {0.9f, 0.3f, 0.05f}) {
    const Vec3 eye(x, 1.2f, 1.0f), at(1, 0.1f, 1);
    const float cosine = (eye - at).normalized().y();
    const Rgb expected = std::get<MetallicRoughness>(Reflectance(Mirror(1, colour))).Fresnel(cosine);
    const Rgb got = renderer.Radiance(RayTo(eye, at));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], expected[c], 1e-4);
  }
}

// A dielectric mirror keeps its diffuse base: both together are the base's albedo in a furnace, plus Fresnel.
TEST(RendererTest, ADielectricMirrorShowsItsBaseToo) {
  const Reflectance glazed = Mirror(0, Rgb::Constant(0.5f));
  const Solution s = MirrorRoom(glazed);
  const Renderer renderer(s);
  const Vec3 eye(1, 1.5f, 1.001f), at(1, 0.1f, 1);
  TableCache cache;
  const MaterialLobes material(glazed, LobeOptions{}, cache);
  const float expected = material.base.Albedo(1)[0] + material.SentOn(1)[0];
  EXPECT_NEAR(renderer.Radiance(RayTo(eye, at))[0], expected, 0.01f * expected);
}

TEST(RendererTest, DepthOfMirrorsIsLimitedAndTheLossReported) {
  SceneBuilder b;
  const uint32_t mirror = b.AddMaterial("mirror", Mirror(1, Rgb::Constant(0.9f)));
  b.AddQuad({0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, mirror);  // two mirrors face to face
  b.AddQuad({1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}, mirror);
  b.AddQuad({0, 2, 0}, {1, 2, 0}, {1, 2, 1}, {0, 2, 1}, b.AddEmitter(Rgb::Constant(1)));
  b.AddCamera("view", {0.5f, 0.5f, 0.5f}, {1, 0.5f, 0.5f}, Vec3::UnitY(), 0.1f);
  const Solution s = Solve(b.Build(), SolveOptions{});
  RenderOptions o;
  o.width = o.height = 8;
  o.samples_per_pixel = 1;
  o.max_mirror_depth = 4;
  RenderReport report;
  Renderer(s).Render(CameraView(s.scene.cameras[0], 8, 8), o, &report);
  EXPECT_NEAR(report.cut_off, std::pow(0.9, 5), 0.02) << "five reflections, then cut";
}

TEST(RendererTest, ShowsEmittersBacksAndNothing) {
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, b.AddEmitter(Rgb(1, 2, 3)));  // faces +z
  const Solution s = Solve(b.Build(), SolveOptions{});
  const Renderer renderer(s);
  EXPECT_LT((renderer.Radiance(RayTo({0.5f, 0.5f, 1}, {0.5f, 0.5f, 0})) - Rgb(1, 2, 3)).abs().maxCoeff(),
            1e-6);
  EXPECT_EQ(renderer.Radiance(RayTo({0.5f, 0.5f, -1}, {0.5f, 0.5f, 0})).sum(), 0) << "a back is black";
  EXPECT_EQ(renderer.Radiance(RayTo({0.5f, 0.5f, 1}, {0.5f, 0.5f, 2})).sum(), 0) << "so is the void";
}

TEST(RendererTest, GivesTheSameBitsForAnyNumberOfThreads) {
  SceneBuilder b;
  const uint32_t white = b.AddLambert(Rgb::Constant(0.6f));
  b.AddBox({0, 0, 0}, {2, 2, 2}, white, true);
  b.AddQuad({0.5f, 1.9f, 0.5f}, {1.5f, 1.9f, 0.5f}, {1.5f, 1.9f, 1.5f}, {0.5f, 1.9f, 1.5f},
            b.AddEmitter(Rgb::Constant(5)));
  b.AddCamera("view", {1, 1, 1.9f}, {1, 0.8f, 0});
  SolveOptions so;
  so.mesh.max_edge = 0.5f;
  const Solution s = Solve(b.Build(), so);
  RenderOptions o;
  o.width = 50;
  o.height = 30;
  o.samples_per_pixel = 4;
  std::vector<Image> images;
  for (const int threads : {1, 2, 7}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena(threads);
    arena.execute(
        [&] { images.push_back(Renderer(s).Render(CameraView(s.scene.cameras[0], 50, 30), o, nullptr)); });
  }
  for (int i = 1; i < 3; ++i) {
    EXPECT_EQ(
        std::memcmp(images[0].pixels.data(), images[i].pixels.data(), images[0].pixels.size() * sizeof(Rgb)),
        0);
  }
}

TEST(RendererTest, FiltersKeepAConstantPictureConstant) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {2, 2, 2}, b.AddEmitter(Rgb::Constant(1)), true);
  b.AddCamera("view", {1, 1, 1.5f}, {1, 1, 0});
  SolveOptions so;
  so.mesh.max_edge = 1;
  const Solution s = Solve(b.Build(), so);
  for (const auto filter : {PixelFilter::kBox, PixelFilter::kBlackmanHarris}) {
    RenderOptions o;
    o.width = o.height = 16;
    o.filter = filter;
    const Image image = Renderer(s).Render(CameraView(s.scene.cameras[0], 16, 16), o, nullptr);
    for (const Rgb& p : image.pixels) EXPECT_NEAR(p[0], 1, 1e-5);
  }
}

// A bright half-plane ends between pixels 7 and 8. Pixel 8 is dark for the box; the window's tail from half a
// pixel on, over its integral of 3 a0: (a0 - sqrt(3) / 2 (3 a1 / 2 pi + 3 a2 / 4 pi)) / 3 a0 = 0.1186.
TEST(RendererTest, FiltersReachAsFarAsTheySay) {
  SceneBuilder b;
  b.AddQuad({-3, -3, 0}, {0, -3, 0}, {0, 3, 0}, {-3, 3, 0}, b.AddEmitter(Rgb::Constant(1)));  // faces +z
  b.AddCamera("view", {0, 0, 5}, {0, 0, 0});
  const Solution s = Solve(b.Build(), SolveOptions{});
  RenderOptions o;
  o.width = o.height = 16;
  o.samples_per_pixel = 1024;
  for (const auto& [filter, tail] :
       {std::pair{PixelFilter::kBox, 0.0}, {PixelFilter::kBlackmanHarris, 0.1186}}) {
    o.filter = filter;
    const Image image = Renderer(s).Render(CameraView(s.scene.cameras[0], 16, 16), o, nullptr);
    // One of 32 strata holds the edge, in 32 rows: standard deviation 0.5 / 32 / sqrt(32) = 0.003.
    EXPECT_NEAR(image.at(8, 8)[0], tail, 0.01);
    EXPECT_NEAR(image.at(7, 8)[0], 1 - tail, 0.01);
    EXPECT_EQ(image.at(10, 8)[0], 0) << "beyond one and a half pixels";
  }
}

TEST(RendererTest, OptionsOutOfRangeSaySo) {
  RenderOptions o;
  EXPECT_EQ(o.Validate(), "");
  o.width = -5;
  EXPECT_NE(o.Validate().find("-5"), std::string::npos);
}

}  // namespace
}  // namespace lobe
