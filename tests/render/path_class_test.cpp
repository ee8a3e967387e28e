// One test for each class of light paths (Heckbert's letters: L lamp, D diffuse, G glossy, S mirror, T
// through a sheet, E eye). Each scene is made so that all light of its receiver is of one class: a class that
// transport leaves out, or carries twice, is off by 100 %, where a few per cent are allowed.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "solver/planar_mirrors.h"
#include "solver/solver.h"
#include "tests/support/path_classes.h"

namespace lobe {
namespace {

using namespace test;

TEST(PathClassTest, LE_IsSeenByTheEyeAndInNoLobe) {
  Stage b;
  const uint32_t glowing = b.AddMaterial("glowing", Lambert{Rgb::Constant(0.5f)}, Rgb(3, 2, 1));
  b.Up(0, 1, 0, 1, 0, glowing);  // alone in the void
  const Scene scene = b.Build();
  for (const Transport t : kBoth) {
    const Solution s = Solve(scene, Options(t));
    for (uint32_t p = 0; p < s.total.patch_count(); ++p) {
      for (const float v : s.total.patch_values(p)) ASSERT_EQ(v, 0);
    }
    const Rgb seen = Renderer(s).Radiance({{0.4f, 1, 0.3f}, 0, -Vec3::UnitY(), kInfinity});
    EXPECT_TRUE((seen == Rgb(3, 2, 1)).all());
  }
}

TEST(PathClassTest, LDE_StraightLight) {
  for (const float half : {0.05f, 0.8f}) {
    Stage b;
    b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
    b.Down(-half, half, -half, half, 1, b.lamp);
    ExpectReceiverAsLit(b, "LDE", kBoth, 0.01,
                        {{-half, 1, -half}, {half, 1, -half}, {half, 1, half}, {-half, 1, half}},
                        Options(Transport::kLinks));
  }
}

// The lamp looks up, so the floor sees its black back and nothing but the ceiling's light.
TEST(PathClassTest, LDDE_OverADiffuseCeiling) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-0.3f, 0.3f, -0.3f, 0.3f, 1, b.lamp);
  b.Down(-1, 1, -1, 1, 2, b.AddLambert(Rgb(0.8f, 0.6f, 0.4f)));
  ExpectReceiverAsTraced(b, "LDDE", kBoth, 0.02, 10000);
}

TEST(PathClassTest, LGDE_OverAGlossyCeiling) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.3f, -0.7f, -0.3f, 0.3f, 1, b.lamp);
  b.Down(-1.5f, 1.5f, -1, 1, 2, b.AddMaterial("brushed", Metal(0.5f, Rgb(0.9f, 0.7f, 0.5f))));
  ExpectReceiverAsTraced(b, "LGDE", kBoth, 0.03, 10000, Options(Transport::kLinks, 512, 0.2f));
}

TEST(PathClassTest, LDGE_ADiffuseCeilingInAGlossyFloor) {
  Stage b;
  const uint32_t floor = b.AddMaterial("brushed", Metal(0.5f, Rgb(0.9f, 0.7f, 0.5f)));
  b.Up(0, 1, -0.5f, 0.5f, 0, floor);
  b.Up(-1.3f, -0.7f, -0.3f, 0.3f, 1, b.lamp);
  b.Down(-1.5f, 1.5f, -1, 1, 2, b.AddLambert(Rgb(0.8f, 0.6f, 0.4f)));
  ExpectSeenAsTraced(b.Build(), floor, Vec3(0.4f, 0.9f, 0.2f).normalized(), "LDGE", kBoth, 0.04, 3000);
}

// Floor and lamp look up to a perfect mirror at y = 2: the floor sees the lamp's image at y = 3.
TEST(PathClassTest, LSDE_ASmallLampInAPlanarMirrorIsShotByItsImage) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.3f, -0.9f, -0.2f, 0.2f, 1, b.lamp);
  b.Down(-2, 2, -2, 2, 2, b.AddMaterial("mirror", Metal(0)));
  ExpectReceiverAsLit(b, "LSDE small", kLinksOnly, 0.01,
                      {{-1.3f, 3, -0.2f}, {-0.9f, 3, -0.2f}, {-0.9f, 3, 0.2f}, {-1.3f, 3, 0.2f}},
                      Options(Transport::kLinks));
}

// The lamp is no smaller than a twentieth of the mirror: links find it.
TEST(PathClassTest, LSDE_ALargeLampInAPlanarMirrorIsFoundByLinks) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.6f, -0.6f, -0.5f, 0.5f, 1, b.lamp);
  b.Down(-1.5f, 1.5f, -1, 1, 2, b.AddMaterial("mirror", Metal(0, Rgb(0.9f, 0.6f, 0.3f))));
  ExpectReceiverAsTraced(b, "LSDE large", kLinksOnly, 0.02, 16000, Options(Transport::kLinks, 2048, 0.25f));
}

TEST(PathClassTest, LSDE_ByACurvedMirror) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.9f, -0.5f, -0.8f, 0.8f, 0.8f, b.lamp);
  b.AddSphere({0, 1.8f, 0}, 0.8f, b.AddMaterial("ball", Metal(0, Rgb(0.9f, 0.6f, 0.3f))), 16);
  ExpectReceiverAsTraced(b, "LSDE sphere", kLinksOnly, 0.03, 15000, Options(Transport::kLinks, 2048, 0.25f));
}

// A periscope: up, to the right, down; the unfolded way is 1 + 2 + 1 long. The lamp lies aside in z: straight
// overhead the first ring of links sees it as a whole or not at all, and the noise is far greater.
TEST(PathClassTest, LSSDE_ByTwoMirrors) {
  Stage b;
  const uint32_t mirror = b.AddMaterial("mirror", Metal(0)), black = b.AddLambert(Rgb::Zero());
  b.Up(-0.2f, 0.2f, 0.6f, 1, 0, b.receiver);
  b.Up(-2.3f, -1.7f, -1.3f, -0.7f, 0, b.lamp);
  // Through (-2, 1), looking to (1, -1), and through (0, 1), looking to (-1, -1).
  b.AddQuad({-2.7f, 0.3f, 1.2f}, {-2.7f, 0.3f, -1.2f}, {-1.3f, 1.7f, -1.2f}, {-1.3f, 1.7f, 1.2f}, mirror);
  b.AddQuad({0.7f, 0.3f, -1.2f}, {0.7f, 0.3f, 1.2f}, {-0.7f, 1.7f, 1.2f}, {-0.7f, 1.7f, -1.2f}, mirror);
  // Between lamp and receiver.
  b.AddQuad({-1, -0.5f, -2}, {-1, -0.5f, 2}, {-1, 0.5f, 2}, {-1, 0.5f, -2}, black);
  ExpectReceiverAsLit(b, "LSSDE", kLinksOnly, 0.02,
                      {{-0.3f, 4, -1.3f}, {0.3f, 4, -1.3f}, {0.3f, 4, -0.7f}, {-0.3f, 4, -0.7f}},
                      Options(Transport::kLinks, 3000, 0.3f));
}

// The lamp lights a plate that the receiver sees in the ceiling's mirror only.
TEST(PathClassTest, LDSDE_DiffuseLightOverAMirrorOntoADiffuseSurface) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-2, -0.5f, -1, 1, 1, b.AddLambert(Rgb(0.8f, 0.6f, 0.4f)));
  b.Down(-1.8f, -1.3f, -0.4f, 0.4f, 1.4f, b.lamp);
  b.Down(-1.5f, 1, -1, 1, 2, b.AddMaterial("mirror", Metal(0, Rgb(0.9f, 0.8f, 0.7f))));
  ExpectReceiverAsTraced(b, "LDSDE", kLinksOnly, 0.03, 30000, Options(Transport::kLinks, 2048, 0.2f));
}

TEST(PathClassTest, LTDE_ThroughASheet) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Down(-0.5f, 0.5f, -0.5f, 0.5f, 2, b.lamp);
  b.Up(-2, 2, -2, 2, 1, b.AddMaterial("sheet", Sheet(0.3f, 0.45f), Rgb::Zero(), true));
  ExpectReceiverAsTraced(b, "LTDE", kBoth, 0.02, 4000, Options(Transport::kLinks, 512, 0.25f));
}

TEST(PathClassTest, LDTDE_DiffuseLightThroughASheet) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-0.3f, 0.3f, -0.3f, 0.3f, 1.5f, b.lamp);
  b.Down(-1, 1, -1, 1, 2.3f, b.AddLambert(Rgb(0.8f, 0.6f, 0.4f)));
  b.Up(-2.5f, 2.5f, -2.5f, 2.5f, 1, b.AddMaterial("sheet", Sheet(0.3f, 0.45f), Rgb::Zero(), true));
  ExpectReceiverAsTraced(b, "LDTDE", kBoth, 0.03, 8000, Options(Transport::kLinks, 512, 0.25f));
}

// A varnished mirror: the receiver gets what its base scatters and what its coat mirrors; an eye sees the
// base and, by the ray that goes on, the receiver.
TEST(PathClassTest, LSDE_AndLDDE_OverADielectricMirrorWithABase) {
  Stage b;
  MetallicRoughness varnish = Metal(0, Rgb(0.7f, 0.5f, 0.3f));
  varnish.metallic = 0;
  varnish.ior = 2.5f;  // a coat that matters: 18 %
  const uint32_t plate = b.AddMaterial("varnish", varnish);
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.3f, -0.7f, -0.3f, 0.3f, 1, b.lamp);
  b.Down(-1.5f, 1.5f, -1, 1, 2, plate);
  ExpectReceiverAsTraced(b, "varnish", kLinksOnly, 0.02, 12000, Options(Transport::kLinks, 1024, 0.2f));
  ExpectSeenAsTraced(b.Build(), plate, Vec3(0.2f, -1, 0.1f).normalized(), "varnish seen", kLinksOnly, 0.03,
                     4000, Options(Transport::kLinks, 1024, 0.2f));
}

// Without its mirrors every scene above is dark where it is looked at: what was measured is the class.
TEST(PathClassTest, TheReceiversOfMirrorScenesAreDarkWithoutMirrors) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.3f, -0.9f, -0.2f, 0.2f, 1, b.lamp);
  const uint32_t black = b.AddLambert(Rgb::Zero());
  b.Down(-2, 2, -2, 2, 2, black);
  const Scene scene = b.Build();
  for (const SurfacePoint& p : PointsOf(scene, b.receiver, 4)) {
    EXPECT_EQ(PathTracer(scene).Irradiance(p, 500).mean.sum(), 0);
  }
}

}  // namespace
}  // namespace lobe
