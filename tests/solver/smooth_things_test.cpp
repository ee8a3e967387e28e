// Ordinary smooth-shaded shiny things of everyday facet counts used to make energy without end.
#include <gtest/gtest.h>

#include "solver/solver.h"
#include "tests/support/metal.h"
#include "tests/support/smooth_things.h"

namespace lobe {
namespace {

using test::Metal;
using test::SceneBuilder;

MetallicRoughness Plastic(float roughness) {
  MetallicRoughness m = Metal(roughness, Rgb::Constant(0.6f));
  m.metallic = 0;
  return m;
}

struct Case {
  const char* name;
  void (*add)(SceneBuilder& b, uint32_t material);
};
const Case kThings[] = {
    {"ball of 80 triangles",
     [](SceneBuilder& b, uint32_t m) {
       b.AddSphere({2, 0.6f, 2}, 0.5f, m, 6);
     }},
    {"column",
     [](SceneBuilder& b, uint32_t m) {
       test::AddColumn(b, {2, 0, 2}, 0.3f, 2.5f, m, 12);
     }},
    {"chair leg",
     [](SceneBuilder& b, uint32_t m) {
       test::AddColumn(b, {2, 0, 2}, 0.03f, 0.5f, m, 8);
     }},
    {"torus",
     [](SceneBuilder& b, uint32_t m) {
       test::AddTorus(b, {2, 1, 2}, 0.7f, 0.25f, m, 16, 8);
     }},
    {"smooth cube",
     [](SceneBuilder& b, uint32_t m) {
       test::AddSmoothCube(b, {2, 0.6f, 2}, 0.5f, m);
     }},
};

TEST(SmoothThingsTest, AllConvergeAsFastAsABox) {
  for (const Case& thing : kThings) {
    for (const bool metal : {true, false}) {
      for (const float roughness : {0.02f, 0.1f, 0.2f}) {
        SceneBuilder b;
        b.AddBox({0, 0, 0}, {4, 3, 4}, b.AddLambert(Rgb::Constant(0.5f)), true);
        b.AddQuad({1.5f, 2.9f, 1.5f}, {2.5f, 2.9f, 1.5f}, {2.5f, 2.9f, 2.5f}, {1.5f, 2.9f, 2.5f},
                  b.AddEmitter(Rgb::Constant(5)));
        const Reflectance shiny = metal ? Metal(roughness, Rgb::Constant(0.9f)) : Plastic(roughness);
        thing.add(b, b.AddMaterial("shiny", shiny));
        SolveOptions o;
        o.mesh.max_edge = 1;
        o.links = 256;
        o.refine.error = 0;
        const Solution s = Solve(b.Build(), o);
        EXPECT_EQ(s.stop_reason, StopReason::kConverged) << thing.name << ", roughness " << roughness;
        EXPECT_LE(s.history.size() - 1, 10u) << thing.name << ", roughness " << roughness;
      }
    }
  }
}

// Two large surfaces that face each other: light sits at the rim of the gap and leaves.
TEST(SmoothThingsTest, SheetsOverFloorsTakeAtMostThreeStepsMoreThanPlainSweeps) {
  for (const float gap : {0.02f, 0.1f, 0.5f}) {
    for (const float albedo : {0.8f, 0.95f}) {
      SceneBuilder b;
      const uint32_t white = b.AddMaterial("white", Lambert{Rgb::Constant(albedo)}, Rgb::Zero(), true);
      b.AddQuad({-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, white);
      b.AddQuad({-1, gap, -1}, {-1, gap, 1}, {1, gap, 1}, {1, gap, -1}, white);
      b.AddQuad({-0.5f, 2, -0.5f}, {0.5f, 2, -0.5f}, {0.5f, 2, 0.5f}, {-0.5f, 2, 0.5f},
                b.AddEmitter(Rgb::Constant(5)));
      SolveOptions o;
      o.mesh.max_edge = 0.4f;
      o.links = 256;
      o.refine.error = 0;
      const Solution fast = Solve(b.Build(), o);
      o.accelerate = false;
      const Solution plain = Solve(b.Build(), o);
      EXPECT_EQ(fast.stop_reason, StopReason::kConverged) << gap << " " << albedo;
      EXPECT_EQ(plain.stop_reason, StopReason::kConverged) << gap << " " << albedo;
      EXPECT_LE(fast.history.size(), plain.history.size() + 3) << gap << " " << albedo;
    }
  }
}

}  // namespace
}  // namespace lobe
