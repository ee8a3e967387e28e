// docs/conventions.md#horizon: what smooth shading sends and receives below horizons and facets.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "brdf/frame.h"
#include "scene/tessellate.h"
#include "solver/link_gather.h"
#include "solver/losses.h"
#include "solver/solution.h"
#include "tests/support/metal.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::Metal;
using test::SceneBuilder;

// One triangle in the plane y = 0, its normals leaning by `lean` radians towards +x.
Scene LeaningTriangle(float lean) {
  SceneBuilder b;
  const uint32_t metal = b.AddMaterial("metal", Metal(0.5f, Rgb::Constant(0.8f)));
  const Vec3 normal(std::sin(lean), std::cos(lean), 0);
  b.AddMesh({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}, {normal, normal, normal}, {{0, 1, 2}}, metal);
  return b.Build();
}

struct Fixture {
  Scene scene;
  RayTracer tracer{scene};
  Mesh mesh;
  std::vector<MaterialLobes> materials;
  NodeLobes lobes;

  explicit Fixture(float lean) : scene(LeaningTriangle(lean)), mesh(Tessellate(scene, {.max_edge = 2.0f})) {
    TableCache cache;
    for (const auto& m : scene.materials) materials.emplace_back(m.reflectance, LobeOptions{}, cache);
    std::vector<PartDegrees> degrees;
    for (const auto& p : mesh.patches) {
      degrees.push_back({materials[p.material].base.l_max, materials[p.material].gloss.l_max});
    }
    lobes = NodeLobes(mesh, degrees);
    // Radiance 1 in every direction.
    for (uint32_t n = 0; n < mesh.node_count(); ++n) {
      for (int c = 0; c < 3; ++c) {
        lobes.gloss(n)[c * lobes.degrees(n).gloss_count()] = std::sqrt(2 * std::numbers::pi_v<float>);
      }
    }
  }
};

TEST(HorizonTest, LinksReadNothingBelowTheHorizonOfTheShadingNormal) {
  const Fixture f(0.5f);
  const LinkField field(f.scene, f.mesh, f.lobes);
  for (uint32_t n = 0; n < f.mesh.node_count(); ++n) {
    const Frame frame(f.mesh.node_normal[n]);
    for (int i = 0; i < 64; ++i) {
      const float theta = 0.1f + 0.03f * float(i), phi = 2.4f * float(i);
      const Vec3 local(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const float expected = local.z() < 0 ? 0.0f : 1.0f;
      EXPECT_NEAR(field.Read(n, frame.ToWorld(local))[1], expected, 1e-4f) << theta;
    }
  }
}

// A hemisphere leaning by a has (1 - cos a) / 2 of its cos-weighted solid angle below the plane.
TEST(HorizonTest, LinksBelowTheFacetBringNothingAndAreTheLedgersLoss) {
  for (const float lean : {0.0f, 0.3f, 0.7f}) {
    const Fixture f(lean);
    const Links links(f.scene, f.mesh, f.tracer, f.materials, {.links = 16384});
    const double expected = (1 - std::cos(double(lean))) / 2;
    for (uint32_t n = 0; n < f.mesh.node_count(); ++n) {
      const auto of = links.of(n);
      const double below = double(std::count(of.begin(), of.end(), Links::kBelow)) / double(of.size());
      EXPECT_NEAR(below, expected, 2e-3) << lean;
      EXPECT_EQ(std::count(of.begin(), of.end(), Links::kEscaped),
                std::count_if(of.begin(), of.end(), [](uint32_t link) { return link != Links::kBelow; }));
      EXPECT_FALSE(links.hidden()[n]);
    }
    NodeLobes nothing = f.lobes;
    nothing.SetZero();
    const std::vector<double> area = NodeAreas(f.mesh, links.hidden());
    const Losses losses = FindLosses(f.mesh, links, f.lobes, nothing, area);
    EXPECT_NEAR(losses.below_facets[1] / losses.sent[1], expected, 2e-3);
    EXPECT_NEAR((losses.below_facets[1] + losses.escaped[1]) / losses.sent[1], 1, 1e-4);
  }
}

}  // namespace
}  // namespace lobe
