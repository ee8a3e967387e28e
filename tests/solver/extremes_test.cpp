// Solving where numbers run out: docs/validation.md#extremes.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/input_error.h"
#include "scene/precision.h"
#include "solver/form_factor.h"
#include "solver/solver.h"
#include "tests/support/scene_builder.h"
#include "tests/support/two_rooms.h"

namespace lobe {
namespace {

using test::SceneBuilder;

SolveOptions Coarse(float max_edge, double residual = 1e-5) {
  SolveOptions o;
  o.mesh.max_edge = max_edge;
  o.refine.error = 0;
  o.residual = residual;
  return o;
}

bool AllFinite(const Solution& s) {
  bool finite = std::isfinite(s.residual());
  for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
    for (const float v : s.total.all(n)) finite &= std::isfinite(v);
  }
  return finite;
}

// Power that leaves the nodes of a surface by reflection, over its area: mean radiosity of the green channel.
double MeanRadiosity(const Solution& s, uint32_t surface) {
  const auto area = NodeAreas(s.mesh, s.hidden);
  double power = 0, whole = 0;
  for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
    if (s.mesh.patches[s.mesh.node_patch[n]].surface != surface) continue;
    power += area[n] * s.total.Flux(n)[1];
    whole += area[n];
  }
  EXPECT_GT(whole, 0) << "surface " << surface << " has nodes";
  return power / whole;
}

// --- albedo --------------------------------------------------------------------------------------------

Scene Furnace(float albedo, float radiance = 1) {
  SceneBuilder b;
  const uint32_t wall = b.AddMaterial("wall", Lambert{Rgb::Constant(albedo)}, Rgb::Constant(radiance));
  b.AddBox({0, 0, 0}, {4, 3, 5}, wall, /*inward=*/true);
  return b.Build();
}

TEST(ExtremesTest, AClosedRoomOfAlbedoNextToOneEndsWithAReason) {
  for (const float albedo : {1.0f, 1.0f - 1e-7f}) {
    for (const bool accelerate : {false, true}) {
      SolveOptions o = Coarse(2);
      o.accelerate = accelerate;
      const Solution s = Solve(Furnace(albedo), o);
      EXPECT_EQ(s.stop_reason, StopReason::kNotConverging) << albedo;
      EXPECT_TRUE(AllFinite(s));
      EXPECT_LT(s.history.size(), 200u);
    }
  }
}

TEST(ExtremesTest, BlackRoomsAreDoneAfterTheFirstStep) {
  const Solution s = Solve(Furnace(0), Coarse(2));
  EXPECT_EQ(s.stop_reason, StopReason::kConverged);
  EXPECT_EQ(s.history.size(), 1u);
  EXPECT_EQ(MeanRadiosity(s, 0), 0);
}

// --- radiance ------------------------------------------------------------------------------------------

// Light is linear: with both lamps at 1 every surface shows what it should show here, scaled. What is left is
// the noise of other samples of the same lamps.
TEST(ExtremesTest, RadianceFromTrillionthsToTrillionsIsRightInEveryRoom) {
  for (const bool glossy : {false, true}) {
    const test::TwoRooms even = test::MakeTwoRooms(1, 1, glossy),
                         rooms = test::MakeTwoRooms(1e12f, 1e-12f, glossy);
    const Solution expected = Solve(even.scene, Coarse(0.8f)), s = Solve(rooms.scene, Coarse(0.8f));
    EXPECT_EQ(s.stop_reason, StopReason::kConverged);
    EXPECT_TRUE(AllFinite(s));
    ASSERT_EQ(s.mesh.node_count(), expected.mesh.node_count());
    EXPECT_NEAR(MeanRadiosity(s, rooms.bright_walls) / MeanRadiosity(expected, even.bright_walls), 1e12, 1e9);
    EXPECT_NEAR(MeanRadiosity(s, rooms.dim_walls) / MeanRadiosity(expected, even.dim_walls), 1e-12, 1e-15);
    EXPECT_NEAR(MeanRadiosity(s, rooms.dim_thing) / MeanRadiosity(expected, even.dim_thing), 1e-12, 1e-15);
    EXPECT_LT(s.ledger.Closure(), 1e-5);
  }
}

TEST(ExtremesTest, ByShootingAloneADimRoomIsAsRight) {
  const test::TwoRooms even = test::MakeTwoRooms(1, 1), rooms = test::MakeTwoRooms(1e12f, 1e-12f);
  SolveOptions o = Coarse(1.5f);
  o.transport = Transport::kShooting;
  const Solution expected = Solve(even.scene, o), s = Solve(rooms.scene, o);
  EXPECT_TRUE(AllFinite(s));
  // Shot delta areas are noisier than links.
  EXPECT_NEAR(MeanRadiosity(s, rooms.dim_walls) / MeanRadiosity(expected, even.dim_walls), 1e-12, 1e-14);
}

// --- sums ----------------------------------------------------------------------------------------------

// A floor under a lamp that is taken by two million points: what arrives is the form factor, whatever their
// number.
TEST(ExtremesTest, AMillionRaysToOneNodeLoseNothing) {
  for (const bool glossy : {false, true}) {
    SceneBuilder b;
    const uint32_t floor =
        glossy ? b.AddMaterial("plastic", Phong{Rgb::Constant(0.5f), 1}) : b.AddLambert(Rgb::Constant(0.5f));
    b.AddTriangle({-1, 0, -1}, {0, 0, 1}, {1, 0, -1}, floor);
    b.AddTriangle({-0.5f, 2, 0}, {0.5f, 2, 0}, {0, 2, 1}, b.AddEmitter(Rgb::Constant(0.7f)));
    SolveOptions o = Coarse(4);
    o.light_samples = 1000000;
    o.max_steps = 0;
    const Solution s = Solve(b.Build(), o);
    ASSERT_EQ(s.mesh.node_count(), 6u) << "three of them the lamp's";
    EXPECT_GT(s.history[0].rays, 3000000u);
    double expected = 0, delivered = 0;
    const auto area = NodeAreas(s.mesh, s.hidden);
    for (uint32_t n = 0; n < 3; ++n) {
      expected += area[n] * 0.7 *
                  ExactTriangleLight(s.mesh.node_sample_position[n], Vec3::UnitY(),
                                     {Vec3(-0.5f, 2, 0), Vec3(0.5f, 2, 0), Vec3(0, 2, 1)})
                      .irradiance;
    }
    delivered = s.ledger.delivered[1];
    EXPECT_NEAR(delivered / expected, 1, 1e-5) << (glossy ? "glossy" : "diffuse");
    EXPECT_LT(s.ledger.Closure(), 1e-5);
    EXPECT_NEAR(s.ledger.truncated[1] / delivered, 0, 1e-5);
  }
}

// --- sizes and places ----------------------------------------------------------------------------------

struct Room {
  Scene scene;
  uint32_t walls, thing, lamp;
};

// A room with a lamp and a box in it, all corners multiples of 1/4, moved by `by`.
Room MakeRoom(const Vec3& by) {
  SceneBuilder b;
  const uint32_t wall = b.AddLambert(Rgb::Constant(0.5f));
  const auto at = [&](float x, float y, float z) { return Vec3(by + Vec3(x, y, z)); };
  Room out;
  out.walls = b.AddBox(at(0, 0, 0), at(4, 3, 4), wall, /*inward=*/true);
  out.thing = b.AddBox(at(1, 0.5f, 1), at(2, 1.25f, 2), wall);
  out.lamp = b.AddQuad(at(1.5f, 2.75f, 1.5f), at(2.5f, 2.75f, 1.5f), at(2.5f, 2.75f, 2.5f),
                       at(1.5f, 2.75f, 2.5f), b.AddEmitter(Rgb::Constant(10)));
  out.scene = b.Build();
  return out;
}

double WorstAgainst(const Room& room, const Solution& s, const Room& home, const Solution& expected) {
  double worst = 0;
  for (const auto& [here, there] : {std::pair{room.walls, home.walls}, {room.thing, home.thing}}) {
    worst = std::max(worst, std::abs(MeanRadiosity(s, here) / MeanRadiosity(expected, there) - 1));
  }
  return worst;
}

// All corners are floats here as there, so what differs is the rounding of the way, lifts of 0.05 m at 1e5 m
// above all: measured 3e-5 at 1e3 m, 7e-4 at 1e4 m, 8e-3 at 1e5 m.
TEST(ExtremesTest, FarFromTheOriginARoomIsAsBrightAndItsWarningTellsTheStep) {
  const Room home = MakeRoom(Vec3::Zero());
  const SolveOptions o = Coarse(1);
  const Solution expected = Solve(home.scene, o);
  for (const auto& [metres, tolerance] : {std::pair{1e3f, 1e-3}, {1e4f, 3e-3}, {1e5f, 2e-2}}) {
    Room far = MakeRoom(Vec3(metres, metres, -metres));
    const Solution s = Solve(far.scene, o);
    EXPECT_LT(WorstAgainst(far, s, home, expected), tolerance) << metres << " m from the origin";
    EXPECT_TRUE(AllFinite(s));
    WarnOfLostPrecision(&far.scene, o.contact_distance);
    EXPECT_EQ(far.scene.warnings.empty(), metres < 2000) << "faces 2 mm apart and faces that touch";
  }
}

// What float cannot express there is refused, not approximated.
TEST(ExtremesTest, ElementsFinerThanTheStepsOfCoordinatesAreRefused) {
  EXPECT_THROW(Solve(MakeRoom(Vec3::Constant(1e5f)).scene, Coarse(0.5f)), InputError);
}

// Under one lamp: a plane a million metres wide, a plate of a metre, a triangle of a millionth of a metre, a
// strip a metre long and a millionth wide. All get what the lamp's form factor gives them.
TEST(ExtremesTest, FromAMillionMetresToAMillionthEachTriangleGetsItsLight) {
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  const float half = 5e5f, step = 1e-6f;
  // Tilted, so that no coordinate of it is exact.
  b.AddQuad({-half, -0.1f * half, -half}, {-half, -0.1f * half, half}, {half, 0.1f * half, half},
            {half, 0.1f * half, -half}, grey);
  const Vec3 place(-0.5f, 0.5f, 0.125f);
  const uint32_t plate = b.AddQuad({0.5f, 0.5f, 0}, {0.5f, 0.5f, 1}, {1.5f, 0.5f, 1}, {1.5f, 0.5f, 0}, grey);
  const uint32_t tiny = b.AddTriangle(place, place + Vec3(0, 0, step), place + Vec3(step, 0, 0), grey);
  const uint32_t strip = b.AddTriangle({-1, 0.5f, 0}, {-1, 0.5f, step}, {0, 0.5f, 0}, grey);
  const std::array<Vec3, 3> lamp = {Vec3(-0.5f, 2, -0.5f), Vec3(0.5f, 2, -0.5f), Vec3(0, 2, 0.5f)};
  b.AddTriangle(lamp[0], lamp[1], lamp[2], b.AddEmitter(Rgb::Constant(3)));
  SolveOptions o = Coarse(4e5f);
  o.max_steps = 0;
  const Solution s = Solve(b.Build(), o);
  EXPECT_TRUE(AllFinite(s));
  for (const uint32_t surface : {plate, tiny, strip}) {
    int nodes = 0;
    for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
      if (s.mesh.patches[s.mesh.node_patch[n]].surface != surface) continue;
      ++nodes;
      EXPECT_FALSE(s.hidden[n]);
      const double expected =
          0.5 * 3 * ExactTriangleLight(s.mesh.node_sample_position[n], Vec3::UnitY(), lamp).irradiance;
      // Cells of the lamp count as points beyond six of their edges: 0.4 %.
      EXPECT_NEAR(s.total.Flux(n)[1] / expected, 1, 4e-3) << "surface " << surface;
    }
    EXPECT_EQ(nodes, surface == plate ? 4 : 3);
  }
}

TEST(ExtremesTest, ThinTrianglesAreToldByNameAndSize) {
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  b.AddTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, grey);
  b.AddTriangle({100, 0, 0}, {100, 0, 1e-5f}, {101, 0, 0}, grey);
  Scene scene = b.Build();
  WarnOfLostPrecision(&scene, 0.002);
  ASSERT_EQ(scene.warnings.size(), 1u);
  const std::string& told = scene.warnings[0];
  EXPECT_NE(told.find("'triangle 1'"), std::string::npos) << told;
  EXPECT_NE(told.find("1e-05 m"), std::string::npos) << told;
  EXPECT_NE(told.find("1.2e-05 m"), std::string::npos) << told << ": the step";
}

}  // namespace
}  // namespace lobe
