// Every class of light paths (path_class_test.cpp has the letters; P, R: through a pane, a body of glass) as
// seen in every mode of rendering, against the path tracer. Each scene shows light of one class, so that one
// left out, or brought both by lobes and by samples, is off by 100 % where a few are allowed.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/glass.h"
#include "tests/support/path_classes.h"
#include "tests/support/small_pictures.h"

namespace lobe {
namespace {

using namespace test;

const std::vector<NamedMode> kEveryMode(std::begin(kAllModes), std::end(kAllModes));
// What a lobe beyond its tolerance is not shown by.
const std::vector<NamedMode> kSharpModes = {kGatherMode, kGatherAllMode, kAutoMode};

const Rgb kWarm(0.8f, 0.6f, 0.4f), kBrass(0.9f, 0.7f, 0.5f);

// A small picture of what `eye` sees about `target`, all of it one surface.
struct View {
  Vec3 eye, target;
  float fov = 0.1f;
};

void ExpectModesAsTraced(Stage stage, const View& view, const std::string& what,
                         const std::vector<NamedMode>& modes, double discretisation) {
  constexpr int kSize = 8, kSeeds = 8;
  stage.AddCamera("view", view.eye, view.target, Vec3(0.1f, 1, 0.2f).normalized(), view.fov);
  const Scene scene = stage.Build();
  const CameraView camera(scene.cameras[0], kSize, kSize);
  const PathTracer paths(scene);
  const Estimate want = MeanOverSeeds(kSeeds, [&](uint64_t seed) {
    return RenderPathTraced(paths, camera, OptionsFor(kStoredMode, kSize, 400, seed));
  });
  const Solution solution = Solve(scene, Options(Transport::kLinks));
  const Renderer renderer(solution);
  for (const NamedMode& mode : modes) {
    const Estimate got = MeanOverSeeds(kSeeds, [&](uint64_t seed) {
      return renderer.Render(camera, OptionsFor(mode, kSize, 64, seed), nullptr);
    });
    ExpectSame(got, want, discretisation, what + " in mode " + mode.name);
  }
}

// A lobe within tolerance for every mode, and one too sharp for that.
void ExpectGlossAsTraced(const std::function<Stage(const MetallicRoughness&)>& stage, const View& view,
                         const std::string& what, double stored, double sharp) {
  ExpectModesAsTraced(stage(Metal(0.6f, kBrass)), view, what, kEveryMode, stored);
  ExpectModesAsTraced(stage(Metal(0.2f, kBrass)), view, what + ", sharp,", kSharpModes, sharp);
}

const View kFloor{{1.8f, 0.8f, 1.2f}, {0, 0, 0}};
// By way of a mirror at y = 2 above (1.143, 0) to the floor at (0, 0).
const View kFloorInCeiling{{2, 0.5f, 0.1f}, {1.143f, 2, 0.05f}};

TEST(ModeClassTest, LE_IsTheLampsOwnRadianceInEveryMode) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("glowing", Metal(0.2f, Rgb::Constant(0.5f)), Rgb(3, 2, 1)));
  b.AddCamera("view", kFloor.eye, kFloor.target, Vec3::UnitY(), kFloor.fov);
  const Scene scene = b.Build();
  const Solution solution = Solve(scene, Options(Transport::kLinks));
  for (const NamedMode& mode : kAllModes) {
    const Image image =
        Renderer(solution).Render(CameraView(scene.cameras[0], 8, 8), OptionsFor(mode, 8, 4), nullptr);
    for (const Rgb& p : image.pixels) EXPECT_LT((p - Rgb(3, 2, 1)).abs().maxCoeff(), 1e-5) << mode.name;
  }
}

TEST(ModeClassTest, LDE_StraightLight) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Down(-0.3f, 0.3f, -0.3f, 0.3f, 1, b.lamp);
  ExpectModesAsTraced(b, kFloor, "LDE", kEveryMode, 0.01);
}

// The eye looks along the lamp's reflection.
TEST(ModeClassTest, LGE_AHighlight) {
  ExpectGlossAsTraced(
      [](const MetallicRoughness& gloss) {
        Stage b;
        b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("brass", gloss));
        b.Down(-1.3f, -0.5f, -1, -0.2f, 1.2f, b.lamp);
        return b;
      },
      {{1.1f, 1.5f, 0.7f}, {0, 0, 0}, 0.1f}, "LGE", 0.05, 0.01);
}

TEST(ModeClassTest, LDDE_OverADiffuseCeiling) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-0.3f, 0.3f, -0.3f, 0.3f, 1, b.lamp);
  b.Down(-1, 1, -1, 1, 2, b.AddLambert(kWarm));
  ExpectModesAsTraced(b, kFloor, "LDDE", kEveryMode, 0.02);
}

TEST(ModeClassTest, LGDE_OverAGlossyCeiling) {
  ExpectGlossAsTraced(
      [](const MetallicRoughness& gloss) {
        Stage b;
        b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
        b.Up(-1.6f, -0.8f, -0.4f, 0.4f, 1, b.lamp);
        b.Down(-1.8f, 1.2f, -1, 1, 2, b.AddMaterial("brass", gloss));
        return b;
      },
      kFloor, "LGDE", 0.03, 0.04);
}

TEST(ModeClassTest, LDGE_ADiffuseCeilingInAGlossyFloor) {
  ExpectGlossAsTraced(
      [](const MetallicRoughness& gloss) {
        Stage b;
        b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("brass", gloss));
        b.Up(-1.3f, -0.7f, -1.3f, -0.7f, 1.4f, b.lamp);
        b.Down(-2.5f, 1, -2, 1, 2, b.AddLambert(kWarm));
        return b;
      },
      {{1.2f, 1, 0.8f}, {0, 0, 0}, 0.1f}, "LDGE", 0.04, 0.02);
}

TEST(ModeClassTest, LSDE_ALampInAMirrorLightsADiffuseFloor) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.6f, -0.6f, -0.5f, 0.5f, 1, b.lamp);
  b.Down(-1.5f, 1.5f, -1, 1, 2, b.AddMaterial("mirror", Metal(0, kBrass)));
  ExpectModesAsTraced(b, kFloor, "LSDE", kEveryMode, 0.03);
}

TEST(ModeClassTest, LSGE_ALampInAMirrorAboveAGlossyFloor) {
  ExpectGlossAsTraced(
      [](const MetallicRoughness& gloss) {
        Stage b;
        b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("brass", gloss));
        b.Up(-1.6f, -0.6f, -1.2f, -0.2f, 0.8f, b.lamp);
        b.Down(-1.5f, 1.5f, -1, 1, 1.6f, b.AddMaterial("mirror", Metal(0, Rgb(0.9f, 0.8f, 0.7f))));
        return b;
      },
      {{0.6f, 1.2f, 0.4f}, {0, 0, 0}, 0.1f}, "LSGE", 0.06, 0.02);
}

TEST(ModeClassTest, LDSE_ADiffuseFloorSeenInAMirror) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Down(-0.3f, 0.3f, -0.3f, 0.3f, 1, b.lamp);
  b.Down(0.6f, 1.7f, -0.5f, 0.5f, 2, b.AddMaterial("mirror", Metal(0, kBrass)));
  ExpectModesAsTraced(b, kFloorInCeiling, "LDSE", kEveryMode, 0.01);
}

TEST(ModeClassTest, LGSE_AHighlightSeenInAMirror) {
  ExpectGlossAsTraced(
      [](const MetallicRoughness& gloss) {
        Stage b;
        b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("brass", gloss));
        b.Down(-0.7f, -0.1f, -0.3f, 0.3f, 0.8f, b.lamp);
        b.Down(0.6f, 1.7f, -0.5f, 0.5f, 2, b.AddMaterial("mirror", Metal(0, Rgb(0.9f, 0.8f, 0.7f))));
        return b;
      },
      kFloorInCeiling, "LGSE", 0.05, 0.01);
}

TEST(ModeClassTest, LSGSE_ALampInAMirrorInAGlossyFloorInAMirror) {
  ExpectGlossAsTraced(
      [](const MetallicRoughness& gloss) {
        Stage b;
        b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("brass", gloss));
        b.Up(-1.9f, -0.9f, -0.5f, 0.5f, 1, b.lamp);
        b.Down(-2, 2, -1, 1, 2, b.AddMaterial("mirror", Metal(0, Rgb(0.9f, 0.8f, 0.7f))));
        return b;
      },
      kFloorInCeiling, "LSGSE", 0.06, 0.03);
}

TEST(ModeClassTest, LTDE_ThroughASheetOntoAFloor) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Down(-0.5f, 0.5f, -0.5f, 0.5f, 2, b.lamp);
  b.Up(-2, 2, -2, 2, 1, b.AddMaterial("sheet", Sheet(0.3f, 0.45f), Rgb::Zero(), true));
  ExpectModesAsTraced(b, kFloor, "LTDE", kEveryMode, 0.02);
}

TEST(ModeClassTest, LTE_ASheetSeenFromItsDarkSide) {
  Stage b;
  b.Down(-0.5f, 0.5f, -0.5f, 0.5f, 0.7f, b.lamp);
  b.Up(-0.7f, 0.7f, -0.7f, 0.7f, 0, b.AddMaterial("sheet", Sheet(0.3f, 0.45f), Rgb::Zero(), true));
  ExpectModesAsTraced(b, {{1, -1.2f, 0.5f}, {0, 0, 0}}, "LTE", kEveryMode, 0.01);
}

TEST(ModeClassTest, LPDE_ALampBehindAPane) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Down(-0.3f, 0.3f, -0.3f, 0.3f, 1.2f, b.lamp);
  b.Up(-3, 3, -3, 3, 1, b.AddPane());
  ExpectModesAsTraced(b, kFloor, "LPDE", kEveryMode, 0.015);
}

TEST(ModeClassTest, LPGE_AHighlightThroughAPane) {
  ExpectGlossAsTraced(
      [](const MetallicRoughness& gloss) {
        Stage b;
        b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("brass", gloss));
        b.Down(-1.5f, -0.5f, -1.2f, -0.2f, 1.2f, b.lamp);
        b.Up(-3, 3, -3, 3, 1, b.AddPane());
        return b;
      },
      {{0.7f, 0.8f, 0.5f}, {0, 0, 0}, 0.1f}, "LPGE", 0.05, 0.015);
}

// Clear within but coloured, so that ways of different length count.
MetallicRoughness Bottle() { return ColouredGlass(Rgb(0.9f, 0.7f, 0.5f), 0.4f); }

TEST(ModeClassTest, LRDE_ALampBehindASlab) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Down(-0.8f, 0.8f, -0.8f, 0.8f, 1.6f, b.lamp);
  b.AddBox({-3, 1, -3}, {3, 1.4f, 3}, b.AddMaterial("bottle", Bottle()));
  ExpectModesAsTraced(b, kFloor, "LRDE", kEveryMode, 0.03);
}

TEST(ModeClassTest, LDRE_ADiffuseFloorSeenThroughASlab) {
  Stage b;
  b.Up(-0.5f, 0.2f, -0.5f, 0.5f, 0, b.receiver);
  b.AddQuad({-1, 0, 0.5f}, {-1, 0, -0.5f}, {-1, 0.5f, -0.5f}, {-1, 0.5f, 0.5f}, b.lamp);
  b.AddBox({0.3f, -0.3f, -3}, {0.6f, 3, 3}, b.AddMaterial("bottle", Bottle()));
  ExpectModesAsTraced(b, kFloor, "LDRE", kEveryMode, 0.03);
}

// Bases under ideal coats: samples that draw the coat's own reflection leave that to the ray which follows
// it.
TEST(ModeClassTest, LDE_AndLDSE_OverAVarnishedFloor) {
  MetallicRoughness varnish = Metal(0, kWarm);
  varnish.metallic = 0;
  varnish.ior = 2.5f;  // a coat that matters: 18 %
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("varnish", varnish));
  b.Down(-0.3f, 0.3f, -0.3f, 0.3f, 1.2f, b.lamp);
  // Seen in the coat, and lit by the same lamp.
  b.AddQuad({-1, 0, 2}, {-1, 0, -2}, {-1, 1, -2}, {-1, 1, 2}, b.AddLambert(kWarm));
  ExpectModesAsTraced(b, kFloor, "varnish", kEveryMode, 0.015);
}

TEST(ModeClassTest, LDE_AndLPDE_ByAPaneWithABase) {
  MetallicRoughness half = Pane(1.5f, Rgb(0.9f, 0.8f, 0.7f));
  half.transmission = 0.5f;
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("half", half, Rgb::Zero(), /*double_sided=*/true));
  b.Up(-1.5f, 1.5f, -1.5f, 1.5f, -0.3f, b.AddLambert(kWarm));
  b.Down(-0.3f, 0.3f, -0.3f, 0.3f, 1.2f, b.lamp);
  ExpectModesAsTraced(b, {{0.9f, 0.9f, 0.6f}, {0, 0, 0}}, "half a pane", kEveryMode, 0.02);
}

// A pane that glows itself is met by shadow rays and by directions, and hides nothing.
TEST(ModeClassTest, LGE_AGlowingPane) {
  for (const float roughness : {0.6f, 0.25f}) {
    Stage b;
    b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("brass", Metal(roughness, kBrass)));
    b.Down(-1.3f, 1.3f, -1.3f, 1.3f, 1,
           b.AddMaterial("glowing pane", Pane(1.5f, Rgb::Constant(1)), Rgb(3, 2, 1), /*double_sided=*/true));
    ExpectModesAsTraced(b, {{0.7f, 0.8f, 0.5f}, {0, 0, 0}, 0.1f}, "a glowing pane",
                        roughness < 0.3f ? kSharpModes : kEveryMode, 0.04);
    ExpectModesAsTraced(b, {{0.7f, 0.8f, 0.5f}, {0, 0, 0}, 0.1f}, "a glowing pane", {kDirectMode}, 0.04);
  }
}

// The inside of solid glass does not emit, whatever doubleSided says, for any of the engines.
TEST(ModeClassTest, LDE_AGlowingBodyOfGlassGlowsOnItsOutside) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.AddBox({-0.3f, 0.6f, -0.3f}, {0.3f, 1.2f, 0.3f},
           b.AddMaterial("glowing glass", ClearGlass(1.5f), Rgb(3, 2, 1), /*double_sided=*/true));
  ExpectModesAsTraced(b, kFloor, "LDE by glowing glass", kEveryMode, 0.02);
}

// What gathering shows of a stage, by options that a test varies.
class Gathering {
 public:
  Gathering(Stage stage, const View& view)
      : scene_(Built(std::move(stage), view)), solution_(Solve(scene_, Options(Transport::kLinks))) {}

  double Mean(const std::function<void(RenderOptions&)>& vary) const {
    RenderOptions o = OptionsFor(kGatherMode, 8, 64);
    vary(o);
    return MeanOf(renderer_.Render(CameraView(scene_.cameras[0], 8, 8), o, nullptr)).mean();
  }

 private:
  static Scene Built(Stage stage, const View& view) {
    stage.AddCamera("view", view.eye, view.target, Vec3::UnitY(), view.fov);
    return stage.Build();
  }
  const Scene scene_;
  const Solution solution_;
  const Renderer renderer_{solution_};
};

// Whether faint ways are followed does not depend on how many share the light.
TEST(ModeClassTest, LSGE_AnyNumberOfGatheredDirectionsFindsTheLampInTheMirror) {
  MetallicRoughness plastic = Metal(0.2f, Rgb::Constant(0.02f));
  plastic.metallic = 0;
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("plastic", plastic));
  b.Up(-1.8f, -0.6f, -0.6f, 0.6f, 0.5f, b.lamp);
  b.Down(-3, 3, -3, 3, 1.5f, b.AddMaterial("mirror", Metal(0)));
  const Gathering gathering(b, {{1, 1, 0}, {0, 0, 0}});
  const auto mean = [&](int samples) {
    return gathering.Mean([&](RenderOptions& o) { o.gather_samples = samples; });
  };
  const double few = mean(1);
  ASSERT_GT(few, 0.01);
  EXPECT_NEAR(mean(16) / few, 1, 0.03);
  EXPECT_NEAR(mean(256) / few, 1, 0.03);
}

// Shadow rays go through panes whatever the depth of mirrors; so do the directions that share with them.
TEST(ModeClassTest, LPGE_DoesNotDependOnTheDepthOfMirrors) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.AddMaterial("brass", Metal(0.2f, kBrass)));
  b.Down(-1.5f, -0.5f, -1.2f, -0.2f, 1.2f, b.lamp);
  b.Up(-3, 3, -3, 3, 1, b.AddPane());
  const Gathering gathering(b, {{0.7f, 0.8f, 0.5f}, {0, 0, 0}});
  const auto mean = [&](int depth) {
    return gathering.Mean([&](RenderOptions& o) { o.max_mirror_depth = depth; });
  };
  const double deep = mean(16);
  ASSERT_GT(deep, 0.1);
  EXPECT_NEAR(mean(0) / deep, 1, 0.01);
}

}  // namespace
}  // namespace lobe
