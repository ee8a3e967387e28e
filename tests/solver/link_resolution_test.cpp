#include "solver/link_resolution.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "scene/tessellate.h"
#include "solver/link_gather.h"
#include "solver/solver.h"
#include "tests/support/lift_cabin.h"

namespace lobe {
namespace {

using test::LiftCabin;

// A scene between whose nodes noise is sent.
struct Sweeps {
  Scene scene;
  RayTracer tracer;
  Mesh mesh;
  std::vector<MaterialLobes> materials;
  std::unique_ptr<Links> links;
  std::vector<double> area;
  std::vector<PartDegrees> degrees;

  Sweeps(Scene s, float max_edge) : scene(std::move(s)), tracer(scene) {
    mesh = Tessellate(scene, {.max_edge = max_edge});
    TableCache cache;
    for (const auto& m : scene.materials) materials.emplace_back(m.reflectance, LobeOptions{}, cache);
    links = std::make_unique<Links>(scene, mesh, tracer, materials, Links::Options{});
    area = NodeAreas(mesh, links->hidden());
    for (const auto& p : mesh.patches) {
      degrees.push_back({materials[p.material].base.l_max, materials[p.material].gloss.l_max});
    }
  }

  // Rms over nodes and coefficients, area by area: a norm that is as good as any to see growth.
  double Norm(const NodeLobes& lobes) const {
    double sum = 0;
    for (uint32_t n = 0; n < mesh.node_count(); ++n) {
      for (const float c : lobes.all(n)) sum += area[n] * double(c) * double(c);
    }
    return std::sqrt(sum);
  }

  // Mean growth a sweep over the last ten of thirty sweeps of noise, with lobes sent in these degrees.
  double Growth(const std::vector<int>& sent) {
    NodeLobes light(mesh, degrees), next(mesh, degrees);
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    for (uint32_t n = 0; n < mesh.node_count(); ++n) {
      for (float& c : light.all(n)) c = normal(random);
    }
    LinkReceiver receiver(mesh, *links, materials);
    double before = 0;
    for (int sweep = 0; sweep < 30; ++sweep) {
      if (sweep == 20) before = Norm(light);
      const LinkField field(scene, mesh, light, sent);
      next.SetZero();
      for (uint32_t n = 0; n < mesh.node_count(); ++n) {
        if (!links->hidden()[n]) receiver.Gather(n, field, 1, next.all(n).data());
      }
      std::swap(light, next);
    }
    return std::pow(Norm(light) / before, 0.1);
  }
};

// Full degree grows, resolved degree decays: at every albedo, and by a margin.
TEST(LinkResolutionTest, NoiseDecaysInRoomsOfPolishedMetal) {
  for (const float albedo : {0.7f, 0.8f, 0.95f}) {
    Sweeps room(LiftCabin(albedo, 0.1f), 0.5f);
    const double growth = room.Growth(SentDegrees(room.mesh, room.materials, 1024, 2, 64));
    RecordProperty("growth_" + std::to_string(int(100 * albedo)), std::to_string(growth));
    EXPECT_LT(growth, (1 + albedo) / 2) << "albedo " << albedo;
    const double whole = room.Growth({});
    RecordProperty("growth_of_whole_lobes_" + std::to_string(int(100 * albedo)), std::to_string(whole));
    EXPECT_GT(whole, albedo + 0.1) << "or there is nothing to limit";
  }
}

// What the walls of a room hold at most, they send at any degree.
TEST(LinkResolutionTest, LowerDegreesKeepTheFlux) {
  Sweeps room(LiftCabin(0.7f, 0.1f), 0.8f);
  NodeLobes lobes(room.mesh, room.degrees);
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (uint32_t n = 0; n < room.mesh.node_count(); ++n) {
    for (float& c : lobes.all(n)) c = normal(random);
  }
  const LinkField field(room.scene, room.mesh, lobes, std::vector<int>(room.mesh.patches.size(), 0));
  for (uint32_t n = 0; n < room.mesh.node_count(); ++n) {
    ASSERT_TRUE(field.diffuse(n));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(double(field.radiance(n)[c]) * M_PI, double(lobes.Flux(n)[c]),
                  1e-4 * (1 + std::abs(double(lobes.Flux(n)[c]))));
    }
  }
}

TEST(LinkResolutionTest, TheFirstStepSendsWhatItHasUnlessSomethingGrew) {
  const Sweeps room(LiftCabin(0.8f, 0.1f), 0.8f);
  const auto degrees = [&](int step, int cap) {
    return SentDegrees(room.mesh, room.materials, 1024, step, cap);
  };
  for (uint32_t p = 0; p < room.mesh.patches.size(); ++p) {
    const MaterialLobes& m = room.materials[room.mesh.patches[p].material];
    EXPECT_EQ(degrees(1, 64)[p], m.diffuse() ? 0 : m.max_degree());
    EXPECT_EQ(degrees(1, 4)[p], m.diffuse() ? 0 : 4);
    EXPECT_EQ(degrees(2, 64)[p], m.diffuse() ? 0 : ResolvedDegree(m, 1024));
    EXPECT_EQ(degrees(2, 1)[p], m.diffuse() ? 0 : 1);
  }
}

TEST(LinkResolutionTest, DarkThingsAndManyLinksKeepTheirDegree) {
  const auto resolved = [](float albedo, int links) {
    TableCache cache;
    return ResolvedDegree(
        MaterialLobes(Reflectance(test::Metal(0.1f, Rgb::Constant(albedo))), LobeOptions{}, cache), links);
  };
  EXPECT_EQ(resolved(0.1f, 1024), LobeOptions{}.l_max);
  EXPECT_EQ(resolved(0.95f, 100000), LobeOptions{}.l_max);
  EXPECT_GT(resolved(0.5f, 1024), resolved(0.8f, 1024));
  // (l + 1) (l + 2) / 2 <= 1848 / 40
  EXPECT_EQ(resolved(0.95f, 1024), 8);
}

// The cabin ended at 22 % unshot, growing.
TEST(LinkResolutionTest, LiftCabinsConvergeAtAnyPolish) {
  for (const auto [albedo, roughness] : {std::pair{0.7f, 0.1f}, {0.95f, 0.3f}, {0.95f, 0.1f}}) {
    SolveOptions o;
    o.mesh.max_edge = 0.4f;
    const Solution s = Solve(LiftCabin(albedo, roughness), o);
    EXPECT_EQ(s.stop_reason, StopReason::kConverged) << albedo << " " << roughness;
    EXPECT_LT(s.ledger.Closure(), 1e-4);
  }
}

}  // namespace
}  // namespace lobe
