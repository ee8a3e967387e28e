// What the modes of rendering promise beside the classes of paths (mode_class_test.cpp): lobes and samples
// share the light without overlap, gathered gloss is the path tracer's, and bits do not depend on threads.

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "render/compare.h"
#include "scene/gltf_scene.h"
#include "tests/support/adaptive_albedo.h"
#include "tests/support/block_z_scores.h"
#include "tests/support/path_classes.h"
#include "tests/support/small_pictures.h"

namespace lobe {
namespace {

using namespace test;

MetallicRoughness Plastic(float roughness, const Rgb& colour) {
  MetallicRoughness m = Metal(roughness, colour);
  m.metallic = 0;
  return m;
}

CameraView ViewOf(const Scene& scene, int size) { return {scene.cameras.at(0), size, size}; }

// Light straight from lamps alone, layers and all.
TEST(RenderModesTest, WhereAllLightIsDirectTheIndirectLayerIsBlack) {
  for (const Reflectance& r :
       {Reflectance(Lambert{Rgb(0.2f, 0.5f, 0.8f)}), Reflectance(Metal(0.6f, Rgb(0.9f, 0.6f, 0.3f)))}) {
    Stage b;
    b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("floor", r));
    b.Down(-0.3f, 0.3f, -0.3f, 0.3f, 1, b.lamp);
    b.AddCamera("view", {0.8f, 0.8f, 0.8f}, {0, 0, 0});
    const Scene scene = b.Build();
    const Solution solution = Solve(scene, Options(Transport::kLinks));
    for (const NamedMode& mode : kAllModes) {
      const LayeredImage image =
          Renderer(solution).Render(ViewOf(scene, 16), OptionsFor(mode, 16, 4), LayerSet::All(), nullptr);
      const double whole = MeanOf(image.color).mean();
      ASSERT_GT(whole, 0.1);
      EXPECT_NEAR(MeanOf(image.layers.at(Layer::kDirect)).mean(), whole, 1e-4 * whole) << mode.name;
      EXPECT_NEAR(MeanOf(image.layers.at(Layer::kIndirect)).abs().maxCoeff(), 0, 1e-4 * whole) << mode.name;
      EXPECT_EQ(MeanOf(image.layers.at(Layer::kSpecular)).sum(), 0) << mode.name;
    }
  }
}

// A lamp small against the mirror is shot by way of its image, yet it is not straight emission.
TEST(RenderModesTest, EmissionByWayOfAMirrorIsIndirectAndReadFromLobes) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.1f, -0.9f, -0.1f, 0.1f, 1, b.lamp);
  b.Down(-2, 2, -2, 2, 2, b.AddMaterial("mirror", Metal(0)));
  b.AddCamera("view", {0.8f, 0.8f, 0.8f}, {0, 0, 0}, Vec3::UnitY(), 0.3f);
  const Scene scene = b.Build();
  const Solution solution = Solve(scene, Options(Transport::kLinks));
  const auto render = [&](const NamedMode& mode) {
    return Renderer(solution).Render(ViewOf(scene, 8), OptionsFor(mode, 8, 4), LayerSet::All(), nullptr);
  };
  const Image stored = render(kStoredMode).color;
  const LayeredImage direct = render(kDirectMode);
  EXPECT_GT(MeanOf(stored).minCoeff(), 1e-4);
  EXPECT_EQ(MeanOf(direct.layers.at(Layer::kDirect)).sum(), 0) << "no shadow ray gets there";
  for (size_t i = 0; i < stored.pixels.size(); ++i) {
    EXPECT_LT((direct.color.pixels[i] - stored.pixels[i]).abs().maxCoeff(), 1e-5) << "the same lobes";
  }
}

TEST(RenderModesTest, EveryModeHasTheSameMeanInTheGlossyCornellBox) {
  SolveOptions options;
  options.mesh.max_edge = 0.4f;
  const Solution solution =
      Solve(ReadGltfScene(std::string(LOBE_TEST_DATA) + "/scenes/cornell_glossy.glb"), options);
  for (const Camera& camera : solution.scene.cameras) {
    const CameraView view(camera, 64, 64);
    const auto mean = [&](const NamedMode& mode) {
      return MeanOf(Renderer(solution).Render(view, OptionsFor(mode, 64, 4), nullptr)).mean();
    };
    const double stored = mean(kStoredMode);
    for (const NamedMode& mode : kAllModes) {
      EXPECT_NEAR(mean(mode) / stored, 1, 0.02) << mode.name << ", " << camera.name;
    }
  }
}

// A shadow's edge falls between nodes a metre apart.
TEST(RenderModesTest, DirectShowsTheShadowsThatACoarseMeshBlurs) {
  Stage b;
  b.Up(-2, 2, -2, 2, 0, b.AddLambert(Rgb::Constant(0.5f)));
  b.Down(-0.05f, 0.05f, -0.05f, 0.05f, 2, b.lamp);
  b.Up(-0.4f, 0.3f, -0.3f, 0.35f, 1, b.AddLambert(Rgb::Zero()));
  b.AddCamera("view", {0.1f, 0.9f, 0.1f}, {0, 0, 0}, Vec3::UnitZ(), 2.0f);
  const Scene scene = b.Build();
  const Solution solution = Solve(scene, Options(Transport::kLinks, 64, 1.0f));
  RenderOptions o = OptionsFor(kStoredMode, 32, 256);
  const Image truth = RenderPathTraced(PathTracer(scene), ViewOf(scene, 32), o);
  const auto error = [&](const NamedMode& mode) {
    const Image image = Renderer(solution).Render(ViewOf(scene, 32), OptionsFor(mode, 32, 64), nullptr);
    return Compare(image, truth, nullptr, nullptr).pixel_error;
  };
  EXPECT_GT(error(kStoredMode), 0.2);
  EXPECT_LT(error(kDirectMode), 0.03);
}

// By reciprocity a convex block among walls that all emit 1 shows its directional albedo a(wo), whatever
// direction or lamp a sample took. The base is read from lobes, to within its table's error.
TEST(RenderModesTest, GatheredBlocksInAWhiteFurnaceShowTheirAlbedo) {
  const Rgb colour(0.9f, 0.6f, 0.3f);
  for (const float roughness : {0.05f, 0.2f, 0.6f}) {
    for (const MetallicRoughness& m : {Metal(roughness, colour), Plastic(roughness, colour)}) {
      Stage b;
      b.AddBox({-2, -2, -2}, {2, 2, 2}, b.AddEmitter(Rgb::Constant(1)), true);
      b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("plate", m));
      SolveOptions options = Options(Transport::kLinks, 64, 0.5f);
      options.light_samples = 512;
      const Solution solution = Solve(b.Build(), options);
      const Renderer renderer(solution);
      for (const float cosine : {0.9f, 0.4f}) {
        constexpr int kChannel = 1;
        const auto gloss = [&](const Vec3d& wi, const Vec3d& wo) {
          return double(EvaluateGloss(m, wi, wo)[kChannel]);
        };
        const auto base = [&](const Vec3d& wi, const Vec3d& wo) {
          return double(EvaluateBase(m, wi, wo)[kChannel]);
        };
        double want = test::AdaptiveAlbedo(gloss, cosine, double(roughness) * roughness);
        if (m.metallic == 0) want += test::AdaptiveAlbedo(base, cosine, 1);
        const Vec3 eye(std::sqrt(1 - cosine * cosine), cosine, 0);
        const Camera camera = LookAt(eye, {0, 0, 0}, Vec3(0.1f, 0.9f, 0.3f).normalized(), 0.01f);
        for (const NamedMode& mode : {kGatherMode, kGatherAllMode}) {
          const Estimate got = MeanOverSeeds(6, [&](uint64_t seed) {
            return renderer.Render(CameraView(camera, 4, 4), OptionsFor(mode, 4, 64, seed), nullptr);
          });
          EXPECT_LT(got.standard_error[kChannel], 0.01 * want);
          EXPECT_NEAR(got.mean[kChannel], want, 4 * got.standard_error[kChannel] + 0.005 * want)
              << mode.name << ", " << Describe(m) << ", cosine " << cosine;
        }
      }
    }
  }
}

// A plate before a wall that it mirrors beside the lamps: squares at a place, of half a side.
Scene PlateBeforeAWall(const MetallicRoughness& plate, const Reflectance& wall, const Rgb& glow,
                       const std::vector<std::pair<Vec3, float>>& lamps) {
  Stage b;
  b.Up(-1, 1, -1, 1, 0, b.AddMaterial("plate", plate));
  b.AddQuad({-1.2f, 0, -1.2f}, {1.2f, 0, -1.2f}, {1.2f, 2, -1.2f}, {-1.2f, 2, -1.2f},
            b.AddMaterial("wall", wall, glow));  // faces +z
  for (const auto& [at, half] : lamps) {
    // As much power from each.
    const uint32_t lamp = b.AddEmitter(Rgb(1.0f, 0.8f, 0.6f) / (half * half));
    b.Down(at.x() - half, at.x() + half, at.z() - half, at.z() + half, at.y(), lamp);
  }
  b.AddCamera("view", {0.2f, 1, 1.8f}, {0, 0, -0.1f}, Vec3::UnitY(), 0.25f);  // plate alone
  return b.Build();
}

// Pictures of two seeds each, in every block of 8 x 8 pixels.
void ExpectBlocksAsTraced(const Scene& scene, const NamedMode& mode, int samples, int paths_per_pixel,
                          const std::string& what) {
  constexpr int kSize = 64;
  const Solution solution = Solve(scene, Options(Transport::kLinks, 512, 0.1f));
  const Renderer renderer(solution);
  const PathTracer paths(scene);
  const CameraView view = ViewOf(scene, kSize);
  Image ours[2], theirs[2];
  for (const uint64_t seed : {1, 2}) {
    ours[seed - 1] = renderer.Render(view, OptionsFor(mode, kSize, samples, seed), nullptr);
    theirs[seed - 1] = RenderPathTraced(paths, view, OptionsFor(mode, kSize, paths_per_pixel, seed));
  }
  Mask none;
  none.width = none.height = kSize;
  none.set.assign(size_t(kSize) * kSize, false);
  const test::BlockZScores z(ours[0], ours[1], theirs[0], theirs[1], none);
  EXPECT_LT(z.worst, z.bound) << what << ", block " << z.worst_x << ", " << z.worst_y << " of " << z.blocks
                              << ", each known to " << 100 * z.relative_error << " %";
  EXPECT_LT(z.relative_error, 0.07) << what << ": too noisy to tell";
  EXPECT_LT(std::abs(z.mean_error), 4 * z.mean_standard_error + 0.01) << what << ", whole picture";
}

TEST(RenderModesTest, GatheredHighlightsAreThePathTracersInEveryBlock) {
  const Reflectance wall = Lambert{Rgb(0.8f, 0.4f, 0.2f)};
  const std::vector<std::pair<Vec3, float>> lamp = {{{0.2f, 0.6f, -0.8f}, 0.2f}};
  for (const float roughness : {0.05f, 0.15f, 0.3f}) {
    for (const MetallicRoughness& plate :
         {Metal(roughness, Rgb(0.9f, 0.8f, 0.7f)), Plastic(roughness, Rgb(0.2f, 0.3f, 0.5f))}) {
      // So few that noise hides the mesh of the wall, a hundredth, and nothing more.
      ExpectBlocksAsTraced(PlateBeforeAWall(plate, wall, Rgb::Zero(), lamp), kGatherMode, 4, 16,
                           Describe(plate));
    }
  }
}

// Both ways to meet a lamp are needed: of lamps this different, one is found by aiming, one by chance. The
// wall is one more; so all light is straight, and no lobe stands between pictures and truth.
TEST(RenderModesTest, LampsOfVeryDifferentSizesAreWeighedRight) {
  const std::vector<std::pair<Vec3, float>> lamps = {{{-0.3f, 0.6f, -0.8f}, 0.03f},
                                                     {{0.6f, 0.6f, -0.6f}, 0.5f}};
  for (const float roughness : {0.25f, 0.6f}) {
    const Scene scene = PlateBeforeAWall(Metal(roughness, Rgb(0.9f, 0.8f, 0.7f)), Lambert{Rgb::Zero()},
                                         Rgb(0.8f, 0.4f, 0.2f), lamps);
    for (const NamedMode& mode : {kGatherMode, kDirectMode}) {
      ExpectBlocksAsTraced(scene, mode, 16, 64,
                           std::string(mode.name) + ", roughness " + std::to_string(roughness));
    }
  }
}

// Lamps that went out after the solve leave what their light's reflections put in lobes.
TEST(RenderModesTest, WithoutLampsLobesAloneAreShown) {
  Stage b;
  b.Up(-1, 1, -1, 1, 0, b.AddLambert(Rgb::Constant(0.8f)));
  b.Down(-0.2f, 0.2f, -0.2f, 0.2f, 1.5f, b.lamp);
  b.AddQuad({-1, 0, -1}, {1, 0, -1}, {1, 1, -1}, {-1, 1, -1}, b.AddMaterial("metal", Metal(0.2f)));
  b.AddCamera("view", {0.2f, 1.0f, 1.8f}, {0, 0.3f, -0.5f});
  Solution solution = Solve(b.Build(), Options(Transport::kLinks));
  const Image lit =
      Renderer(solution)
          .Render(ViewOf(solution.scene, 16), OptionsFor(kStoredMode, 16, 4), LayerSet::All(), nullptr)
          .layers.at(Layer::kIndirect);
  solution.scene.materials[b.lamp].emission = Rgb::Zero();
  for (const NamedMode& mode : kAllModes) {
    const Image image =
        Renderer(solution).Render(ViewOf(solution.scene, 16), OptionsFor(mode, 16, 4), nullptr);
    for (const Rgb& p : image.pixels) ASSERT_TRUE(p.isFinite().all() && (p >= 0).all()) << mode.name;
    EXPECT_GT(MeanOf(image).mean(), 0.5 * MeanOf(lit).mean()) << mode.name;
  }
}

TEST(RenderModesTest, GrazingViewsOfSharpAndFacetedSurfacesAreFinite) {
  Stage b;
  b.Up(-1, 1, -1, 1, 0, b.AddMaterial("metal", Metal(0.05f)));
  b.AddSphere({0, 0.3f, 0}, 0.3f, b.AddMaterial("plastic", Plastic(0.1f, Rgb::Constant(0.5f))), 6);
  b.Down(-0.5f, 0.5f, -0.5f, 0.5f, 1, b.lamp);
  b.AddQuad({-1, 0, -0.9f}, {1, 0, -0.9f}, {1, 1e-3f, -0.9f}, {-1, 1e-3f, -0.9f}, b.lamp);
  // A millimetre above the plate, along it.
  b.AddCamera("view", {0, 1e-3f, 0.95f}, {0, 0, -1}, Vec3::UnitY(), 0.4f);
  const Scene scene = b.Build();
  const Solution solution = Solve(scene, Options(Transport::kLinks, 64, 0.3f));
  for (const NamedMode& mode : kAllModes) {
    const Image image = Renderer(solution).Render(ViewOf(scene, 48), OptionsFor(mode, 48, 16), nullptr);
    for (const Rgb& p : image.pixels) ASSERT_TRUE(p.isFinite().all() && (p >= 0).all()) << mode.name;
  }
}

// Everything at once: lobes, sharp gloss, a mirror, a pane, lamps of two sizes.
Solution MixedRoom() {
  Stage b;
  b.AddBox({-1, 0, -1}, {1, 2, 1}, b.AddLambert(Rgb(0.7f, 0.6f, 0.5f)), true);
  b.Up(-0.8f, 0, -0.8f, 0.8f, 0.2f, b.AddMaterial("sharp", Metal(0.2f)));
  b.Up(0.1f, 0.8f, -0.8f, 0.8f, 0.2f, b.AddMaterial("brushed", Metal(0.6f)));
  b.AddQuad({-0.8f, 0.4f, -0.9f}, {0.8f, 0.4f, -0.9f}, {0.8f, 1.5f, -0.9f}, {-0.8f, 1.5f, -0.9f},
            b.AddMaterial("mirror", Metal(0)));
  b.Down(-0.3f, 0.3f, -0.3f, 0.3f, 1.9f, b.lamp);
  b.Down(0.6f, 0.62f, 0.6f, 0.62f, 1.5f, b.AddEmitter(Rgb(100, 90, 80)));
  b.AddCamera("view", {0.3f, 1.2f, 0.9f}, {0, 0.4f, -0.5f}, Vec3::UnitY(), 1.0f);
  return Solve(b.Build(), Options(Transport::kLinks, 64, 0.5f));
}

bool SameBits(const Image& a, const Image& b) {
  return std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Rgb)) == 0;
}

TEST(RenderModesTest, GiveTheSameBitsForAnyNumberOfThreads) {
  const Solution solution = MixedRoom();
  for (const NamedMode& mode : kAllModes) {
    RenderOptions o = OptionsFor(mode, 50, 4);
    o.height = 30;
    std::vector<LayeredImage> images;
    std::vector<Image> plain;  // by packets
    for (const int threads : {1, 2, 7}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      tbb::task_arena arena(threads);
      arena.execute([&] {
        images.push_back(Renderer(solution).Render(CameraView(solution.scene.cameras[0], 50, 30), o,
                                                   LayerSet::All(), nullptr));
        plain.push_back(Renderer(solution).Render(CameraView(solution.scene.cameras[0], 50, 30), o, nullptr));
      });
    }
    for (int i = 1; i < 3; ++i) {
      EXPECT_TRUE(SameBits(images[0].color, images[i].color)) << mode.name;
      EXPECT_TRUE(SameBits(plain[0], plain[i])) << mode.name;
      for (const auto& [layer, image] : images[0].layers) {
        EXPECT_TRUE(SameBits(image, images[i].layers.at(layer))) << mode.name << ", " << LayerName(layer);
      }
    }
  }
}

TEST(RenderModesTest, APictureStoppedAsItsLastTileEndsIsComplete) {
  const Solution solution = MixedRoom();
  RenderReport report;
  Renderer(solution).Render(ViewOf(solution.scene, 8), OptionsFor(kAutoMode, 8, 1), &report,
                            [](double fraction) { return fraction < 1; });
  EXPECT_TRUE(report.complete);
}

TEST(RenderModesTest, SeedsChangeWhatIsSampledAndOnlyThat) {
  const Solution solution = MixedRoom();
  const CameraView view = ViewOf(solution.scene, 16);
  for (const NamedMode& mode : kAllModes) {
    const auto render = [&](uint64_t seed) {
      return Renderer(solution).Render(view, OptionsFor(mode, 16, 4, seed), nullptr);
    };
    const Image one = render(1);
    EXPECT_TRUE(SameBits(one, render(1))) << mode.name;
    const Image two = render(2);
    EXPECT_FALSE(SameBits(one, two)) << mode.name << ": at least the eye rays differ";
    EXPECT_NEAR(MeanOf(two).mean() / MeanOf(one).mean(), 1, 0.1) << mode.name;
  }
}

}  // namespace
}  // namespace lobe
