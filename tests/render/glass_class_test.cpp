// Classes of paths by way of glass (path_class_test.cpp says how these tests work): P straight through a
// pane, R through a body, refracted.

#include <gtest/gtest.h>

#include "tests/support/path_classes.h"

namespace lobe {
namespace {

using namespace test;

// Coloured within, so that ways of different length count.
MetallicRoughness Bottle() { return ColouredGlass(Rgb(0.9f, 0.7f, 0.5f), 0.4f); }

TEST(GlassClassTest, LPDE_LampsBehindPanesAreShot) {
  for (const float half : {0.05f, 0.8f}) {
    Stage b;
    b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
    b.Down(-half, half, -half, half, 1, b.lamp);
    const uint32_t pane = b.AddPane();
    b.Up(-3, 3, -3, 3, 0.5f, pane);
    b.Down(-3, 3, -3, 3, 0.7f, pane);  // facing either way
    ExpectReceiverAsTraced(b, "LPDE", kBoth, 0.01, 3000);
  }
}

// The lamp looks up, at a window that reflects some of its light.
TEST(GlassClassTest, LSDE_ReflectedByAPane) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.5f, -0.5f, -0.5f, 0.5f, 0.7f, b.lamp);
  b.Down(-4, 4, -4, 4, 1.6f, b.AddPane());
  ExpectReceiverAsTraced(b, "LSDE", kLinksOnly, 0.02, 100000, Options(Transport::kLinks, 2048));
}

TEST(GlassClassTest, LDPDE_DiffuseLightThroughAPane) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-0.3f, 0.3f, -0.3f, 0.3f, 1, b.lamp);
  b.Down(-1, 1, -1, 1, 2, b.AddLambert(Rgb(0.8f, 0.6f, 0.4f)));
  b.Up(-3, 3, -3, 3, 0.5f, b.AddPane());
  ExpectReceiverAsTraced(b, "LDPDE", kBoth, 0.02, 20000);
}

TEST(GlassClassTest, LRDE_ThroughACoatedSlab) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Down(-0.8f, 0.8f, -0.8f, 0.8f, 1.2f, b.lamp);
  b.AddBox({-3, 0.4f, -3}, {3, 0.8f, 3}, b.AddMaterial("bottle", Bottle()));
  ExpectReceiverAsTraced(b, "LRDE", kLinksOnly, 0.02, 20000);
}

TEST(GlassClassTest, LDRDE_DiffuseLightThroughABall) {
  Stage b;
  b.Up(-0.3f, 0.3f, -0.3f, 0.3f, 0, b.receiver);
  b.Up(-0.3f, 0.3f, -0.3f, 0.3f, 1.4f, b.lamp);
  b.Down(-1.2f, 1.2f, -1.2f, 1.2f, 2, b.AddLambert(Rgb(0.8f, 0.6f, 0.4f)));
  b.AddSphere({0, 0.7f, 0}, 0.5f, b.AddMaterial("bottle", Bottle()), 16);
  ExpectReceiverAsTraced(b, "LDRDE", kLinksOnly, 0.02, 30000);
}

// What is inside glass gets n^2 times the radiance, from a narrower cone.
TEST(GlassClassTest, LRDE_OntoAReceiverInsideABody) {
  Stage b;
  b.Up(-0.3f, 0.3f, -0.3f, 0.3f, 0.3f, b.receiver);
  b.Down(-2, 2, -2, 2, 1.5f, b.lamp);
  b.AddBox({-0.6f, 0, -0.6f}, {0.6f, 0.8f, 0.6f}, b.AddMaterial("bottle", Bottle()));
  ExpectReceiverAsTraced(b, "LRDE inside", kLinksOnly, 0.02, 20000);
}

// The lamp's image behind a mirror is aimed at; a pane in front of the mirror is passed twice.
TEST(GlassClassTest, LPSPDE_ASmallLampInAPlanarMirrorBehindAPane) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-0.2f, 0.2f, -0.2f, 0.2f, 0.6f, b.lamp);
  b.Down(-2, 2, -2, 2, 1.2f, b.AddMaterial("mirror", Metal(0, Rgb(0.9f, 0.8f, 0.7f))));
  b.Down(-4, 4, -4, 4, 0.9f, b.AddPane());
  ExpectReceiverAsTraced(b, "LPSPDE", kLinksOnly, 0.03, 30000);
}

// Half of what gets into the pane its base reflects, both ways.
TEST(GlassClassTest, LPDE_AndLDDE_ByAPaneWithABase) {
  MetallicRoughness half = Pane(1.5f, Rgb(0.9f, 0.8f, 0.7f));
  half.transmission = 0.5f;
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Down(-0.3f, 0.3f, -0.3f, 0.3f, 1, b.lamp);
  b.Up(-1.5f, 1.5f, -1.5f, 1.5f, 0.5f, b.AddPane(half));
  b.Up(-1.5f, 1.5f, -1.5f, 1.5f, -0.05f, b.AddLambert(Rgb::Constant(0.9f)));
  ExpectReceiverAsTraced(b, "LPDE and LDDE", kLinksOnly, 0.02, 20000);
}

// A room with a lamp behind a pane is about 1 - F as bright as without it.
TEST(GlassClassTest, ARoomWithALampBehindAPaneIsNotDark) {
  Stage b;
  b.AddBox({-1, 0, -1}, {1, 2, 1}, b.AddLambert(Rgb(0.7f, 0.6f, 0.5f)), true);
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0.2f, b.receiver);
  b.Down(-0.3f, 0.3f, -0.3f, 0.3f, 1.95f, b.lamp);
  const Scene open = b.Build();
  b.Down(-0.9f, 0.9f, -0.9f, 0.9f, 1.8f, b.AddPane(Pane(1.5f)));
  const Scene glazed = b.Build();
  const auto points = PointsOf(open, b.receiver, 8);
  const Estimate without = TracedIrradiance(open, points, 20000),
                 with = TracedIrradiance(glazed, points, 20000);
  for (int c = 0; c < 3; ++c) {
    // Most of what the pane reflects the ceiling sends back.
    EXPECT_LT(with.mean[c], 0.99 * without.mean[c]);
    EXPECT_GT(with.mean[c], 0.9 * without.mean[c]);
  }
  for (const Transport t : kBoth) {
    const Estimate got = OverSeeds(glazed, Options(t, 1024, 0.25f), IrradianceAt(points));
    // What panes reflect goes by links alone: shooting lacks some of 5 % of it.
    ExpectSame(got, with, t == Transport::kLinks ? 0.02 : 0.06, Name(t));
  }
}

}  // namespace
}  // namespace lobe
