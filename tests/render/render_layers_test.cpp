// Layers as Renderer fills them; exr_layers_test.cpp has them in files.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "scene/gltf_scene.h"
#include "tests/support/path_classes.h"
#include "tests/support/small_pictures.h"

namespace lobe {
namespace {

using namespace test;

TEST(RenderLayersTest, DirectIndirectAndSpecularSumToTheColourInEveryMode) {
  SolveOptions options;
  options.mesh.max_edge = 0.8f;
  options.links = 128;
  for (const char* name : {"cornell_glossy", "furnace_glossy"}) {  // with sharp gloss; with a mirror, a sheet
    const Solution solution =
        Solve(ReadGltfScene(std::string(LOBE_TEST_DATA) + "/scenes/" + name + ".glb"), options);
    const CameraView view(solution.scene.cameras.at(0), 32, 32);
    for (const NamedMode& mode : kAllModes) {
      const RenderOptions o = OptionsFor(mode, 32, 4);
      const LayeredImage image = Renderer(solution).Render(view, o, LayerSet::All(), nullptr);
      const Image alone = Renderer(solution).Render(view, o, nullptr);
      Eigen::Array3d specular = Eigen::Array3d::Zero();
      for (size_t i = 0; i < alone.pixels.size(); ++i) {
        const auto at = [&](Layer layer) { return image.layers.at(layer).pixels[i]; };
        const Rgb colour = image.color.pixels[i];
        const float tolerance = 1e-5f * (1 + colour.maxCoeff());
        const Rgb sum = at(Layer::kDirect) + at(Layer::kIndirect) + at(Layer::kSpecular);
        ASSERT_LT((sum - colour).abs().maxCoeff(), tolerance) << mode.name;
        ASSERT_LT((alone.pixels[i] - colour).abs().maxCoeff(), tolerance) << "layers change no colour";
        specular += at(Layer::kSpecular).cast<double>();
      }
      EXPECT_EQ(specular.sum() > 0, std::string(name) == "furnace_glossy") << mode.name;
    }
  }
}

// A quad of known place and colour before nothing, seen aslant, its left half alone in the picture.
TEST(RenderLayersTest, GeometryAndAlbedoOfAQuadAreItsOwn) {
  const MetallicRoughness gold = Metal(0.3f, Rgb(0.9f, 0.7f, 0.2f));
  Stage b;
  const uint32_t material = b.AddMaterial("gold", gold);
  b.AddQuad({-9, -9, 0}, {0, -9, 0}, {0, 9, 0}, {-9, 9, 0}, material);  // faces +z, ends at x = 0
  b.Down(-1, 0, 1, 2, 8, b.lamp);
  b.AddCamera("view", {0, 3, 4}, {0, 0, 0});
  const Solution solution = Solve(b.Build(), Options(Transport::kLinks, 64, 5));
  constexpr int kSize = 16;
  const Camera& camera = solution.scene.cameras[0];
  const CameraView view(camera, kSize, kSize);
  const LayeredImage image =
      Renderer(solution).Render(view, OptionsFor(kStoredMode, kSize, 16), LayerSet::All(), nullptr);
  const Rgb albedo = NormalAlbedo(gold);
  EXPECT_LT((albedo - Rgb(0.9f, 0.7f, 0.2f)).abs().maxCoeff(), 1e-5);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const auto at = [&](Layer layer) { return image.layers.at(layer).at(x, y); };
      if (x >= kSize / 2) {  // nothing there
        for (const Layer layer : {Layer::kAlbedo, Layer::kNormal, Layer::kPosition, Layer::kDirect,
                                  Layer::kIndirect, Layer::kSpecular, Layer::kClamped}) {
          EXPECT_TRUE((at(layer) == 0).all()) << LayerName(layer);
        }
        EXPECT_TRUE(std::isinf(at(Layer::kDepth)[0]) && at(Layer::kDepth)[0] > 0);
        continue;
      }
      EXPECT_LT((at(Layer::kAlbedo) - albedo).abs().maxCoeff(), 1e-5);
      EXPECT_LT((at(Layer::kNormal) - Rgb(0, 0, 1)).abs().maxCoeff(), 1e-5);
      // Where the pixel's centre meets z = 0; its rays average to within their jitter, which strata of a
      // fourth of a pixel keep to a twentieth of one.
      const Ray ray = view.EyeRay(float(x) + 0.5f, float(y) + 0.5f);
      const float t = -ray.origin.z() / ray.direction.z();
      const Vec3 place = ray.origin + t * ray.direction;
      const float pixel = 2 * t * std::tan(0.35f) / kSize;
      EXPECT_LT((at(Layer::kPosition) - place.array()).abs().maxCoeff(), 0.15f * pixel);
      // The nearest of the pixel's rays along the viewing direction, at most half a pixel nearer.
      const float depth = -t * ray.direction.dot(camera.back);
      EXPECT_LT(at(Layer::kDepth)[0], depth);
      EXPECT_GT(at(Layer::kDepth)[0], depth - pixel);
    }
  }
}

TEST(RenderLayersTest, NormalsAreOnTheEyesSideAndShorterWhereRaysPassBy) {
  Stage b;
  b.AddQuad({-9, -9, 0}, {0, -9, 0}, {0, 9, 0}, {-9, 9, 0},
            b.AddMaterial("paper", Lambert{Rgb::Constant(0.5f)}, Rgb::Zero(), /*double_sided=*/true));
  b.Down(-1, 0, -2, -1, 8, b.lamp);
  b.AddCamera("view", {0, 0, -4}, {0, 0, 0});  // from behind, the edge in the middle of the odd picture
  const Solution solution = Solve(b.Build(), Options(Transport::kLinks, 64, 5));
  constexpr int kSize = 9;
  const LayeredImage image =
      Renderer(solution).Render(CameraView(solution.scene.cameras[0], kSize, kSize),
                                OptionsFor(kStoredMode, kSize, 16), LayerSet::All(), nullptr);
  const Image& normal = image.layers.at(Layer::kNormal);
  const Image& depth = image.layers.at(Layer::kDepth);
  // Seen from behind, x runs to the left.
  EXPECT_LT((normal.at(kSize - 1, 4) - Rgb(0, 0, -1)).abs().maxCoeff(), 1e-5);
  EXPECT_LT((normal.at(kSize / 2, 4) - Rgb(0, 0, -0.5f)).abs().maxCoeff(), 1e-5) << "half of its strata hit";
  EXPECT_NEAR(depth.at(kSize / 2, 4)[0], 4, 1e-4) << "of those that hit, not an average";
}

// A lamp's own light is direct, in a mirror specular.
TEST(RenderLayersTest, EmissionSeenIsDirectAndInAMirrorSpecular) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.lamp);
  b.Down(-3, 3, -3, 3, 2, b.AddMaterial("mirror", Metal(0, Rgb::Constant(0.8f))));
  b.AddCamera("lamp", {0.3f, 1.5f, 0.2f}, {0, 0, 0}, Vec3::UnitX(), 0.1f);
  b.AddCamera("mirror", {0.8f, 0.5f, 0}, {0.34f, 2, 0}, Vec3::UnitX(), 0.05f);
  const Solution solution = Solve(b.Build(), Options(Transport::kLinks, 64, 5));
  for (const NamedMode& mode : kAllModes) {
    for (const Camera& camera : solution.scene.cameras) {
      const LayeredImage image = Renderer(solution).Render(CameraView(camera, 4, 4), OptionsFor(mode, 4, 4),
                                                           LayerSet::All(), nullptr);
      const auto mean = [&](Layer layer) { return MeanOf(image.layers.at(layer)); };
      const bool by_mirror = camera.name == "mirror";
      const Eigen::Array3d seen = mean(by_mirror ? Layer::kSpecular : Layer::kDirect);
      EXPECT_NEAR(seen[0], by_mirror ? 8 : 10, by_mirror ? 0.2 : 1e-4) << mode.name << ", " << camera.name;
      EXPECT_EQ(mean(by_mirror ? Layer::kDirect : Layer::kSpecular).sum(), 0) << mode.name;
      EXPECT_EQ(mean(Layer::kIndirect).sum(), 0) << mode.name;
    }
  }
}

}  // namespace
}  // namespace lobe
