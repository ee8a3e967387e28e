#include "render/path_tracer.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "brdf/frame.h"
#include "brdf/hemisphere_integral.h"
#include "tests/support/metal.h"
#include "tests/support/outgoing_integral.h"
#include "tests/support/polygon_light.h"
#include "tests/support/scene_builder.h"
#include "tests/support/significance.h"

namespace lobe {
namespace {

using test::Metal;
using test::SceneBuilder;

constexpr double kPi = std::numbers::pi;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

MetallicRoughness Coated(float roughness, const Rgb& colour) {
  MetallicRoughness m = Metal(roughness, colour);
  m.metallic = 0;
  return m;
}

// Without a coat.
MetallicRoughness Sheet(float transmission, const Rgb& reflected, const Rgb& transmitted) {
  MetallicRoughness m = Coated(1, reflected);
  m.has_specular = true;
  m.specular = 0;
  m.diffuse_transmission = transmission;
  m.diffuse_transmission_color = transmitted;
  return m;
}

Ray RayTo(const Vec3& from, const Vec3& to) { return {from, 0, (to - from).normalized(), kInfinity}; }

// `tests`: how many channels are compared in the whole test, for Sidak.
void ExpectMean(const Estimate& got, const Rgb& expected, double tests, const std::string& what) {
  const double z = test::SidakQuantile(0.01, tests);
  for (int c = 0; c < 3; ++c) {
    // Sums of floats: a few roundings each.
    EXPECT_NEAR(got.mean[c], expected[c], z * got.standard_error[c] + 2e-5 * std::abs(expected[c]))
        << what << ", channel " << c << ", standard error " << got.standard_error[c];
  }
}

// Walls emit 1 and reflect half; a white block, a white mirror and a white sheet float in the room and lose
// nothing: every radiance is 2.
Scene LosslessFurnace() {
  SceneBuilder b;
  const Rgb white = Rgb::Constant(1);
  b.AddBox({0, 0, 0}, {4, 4, 4}, b.AddMaterial("wall", Lambert{Rgb::Constant(0.5f)}, white), true);
  b.AddBox({0.5f, 0.5f, 0.5f}, {1.5f, 1.5f, 1.5f}, b.AddLambert(white));
  b.AddBox({2.5f, 0.5f, 0.7f}, {3.5f, 1.5f, 1.7f}, b.AddMaterial("mirror", Metal(0)));
  b.AddQuad({1, 2, 1}, {1, 2, 3}, {3, 2.5f, 3}, {3, 2.5f, 1},
            b.AddMaterial("sheet", Sheet(0.5f, white, white), Rgb::Zero(), true));
  return b.Build();
}

TEST(PathTracerTest, LosslessThingsInAFurnaceShowTwo) {
  const Scene scene = LosslessFurnace();
  for (const auto way : {LightSampling::kBoth, LightSampling::kLights, LightSampling::kDirections}) {
    const PathTracer paths(scene, {.light_sampling = way});
    for (uint32_t f = 0; f < scene.faces.size(); ++f) {
      const bool wall = f < 12;
      for (const Side side : {Side::kFront, Side::kBack}) {
        if (side == Side::kBack && !scene.material(scene.faces[f]).double_sided) continue;
        const Vec3 n = scene.GeometricNormal(scene.faces[f]) * (side == Side::kFront ? 1.0f : -1.0f);
        const Vec3 wo = (n + Vec3(0.31f, -0.22f, 0.15f)).normalized();
        const Estimate e = paths.ExitantRadiance({f, side, 0.2f, 0.3f}, wo, 1000, f);
        ExpectMean(e, Rgb::Constant(wall ? 1 : 2), 3.0 * 3 * 40, "face " + std::to_string(f));
      }
    }
  }
}

// Roulette cuts long paths short and keeps their mean: 1 / (1 - 0.9), where most light comes late.
TEST(PathTracerTest, BrightFurnaceReachesTheSumOfTheWholeSeries) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {1, 1, 1}, b.AddMaterial("wall", Lambert{Rgb(0.5f, 0.7f, 0.9f)}, Rgb::Constant(1)),
           true);
  const Scene scene = b.Build();
  const Estimate e = PathTracer(scene).ExitantRadiance({3}, scene.GeometricNormal(scene.faces[3]), 20000);
  ExpectMean(e, Rgb(1, 0.7f / 0.3f, 9), 3, "furnace");
  EXPECT_LT(e.standard_error[2], 0.06) << "roulette must not blow up the noise";
}

TEST(PathTracerTest, KBouncesEqualKTermsOfTheSeries) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {1, 1, 1}, b.AddMaterial("wall", Lambert{Rgb::Constant(0.5f)}, Rgb::Constant(1)), true);
  const Scene scene = b.Build();
  double expected = 0, term = 1;
  for (int bounces = 1; bounces <= 12; ++bounces) {
    expected += term *= 0.5;
    const PathTracer paths(scene, {.max_bounces = bounces});
    const Estimate e = paths.ExitantRadiance({3}, scene.GeometricNormal(scene.faces[3]), 4000);
    ExpectMean(e, Rgb::Constant(float(expected)), 36, std::to_string(bounces) + " bounces");
  }
}

// A convex block under light 1 from everywhere shows its directional albedo, whatever its model.
TEST(PathTracerTest, EveryModelShowsItsAlbedoInAFurnace) {
  const Rgb colour(0.9f, 0.6f, 0.3f);
  MetallicRoughness tinted = Coated(0.3f, colour);
  tinted.has_specular = true;
  tinted.specular_color = Rgb(1, 0.8f, 0.5f);
  const std::vector<std::pair<Reflectance, double>> models = {
      {Lambert{colour}, 1},        {Phong{colour, 30}, 0.2},     {Ward{colour, 0.2f}, 0.2},
      {Metal(0.6f, colour), 0.36}, {Coated(0.4f, colour), 0.16}, {tinted, 0.09},
      {Coated(0, colour), 1},      {Coated(0.005f, colour), 1}};
  for (const auto& [model, width] : models) {
    SceneBuilder b;
    const uint32_t surface = b.AddMaterial("block", model);
    b.AddBox({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, surface);
    b.AddBox({-2, -2, -2}, {2, 2, 2}, b.AddEmitter(Rgb::Constant(1)), true);
    const Scene scene = b.Build();
    const Vec3 n = scene.GeometricNormal(scene.faces[0]);
    const Frame frame(n);
    for (const float theta : {0.2f, 0.9f, 1.4f}) {
      const Vec3d wo(std::sin(theta) * std::cos(0.7), std::sin(theta) * std::sin(0.7), std::cos(theta));
      const Vec3d plane(std::sin(theta), 0, std::cos(theta));
      const auto& m = model;
      Rgb expected = (test::IntegrateOutgoing(width, plane.z(),
                                              [&](const Vec3d& wi) { return EvaluateGloss(m, wi, plane); }) +
                      test::IntegrateOutgoing(1, plane.z(), [&](const Vec3d& wi) {
                        return EvaluateBase(m, wi, plane);
                      })).cast<float>();
      const auto* gltf = std::get_if<MetallicRoughness>(&model);
      if (gltf && gltf->roughness < kMirrorRoughness) expected += gltf->Fresnel(std::cos(theta));
      for (const auto way : {LightSampling::kBoth, LightSampling::kDirections}) {
        const PathTracer paths(scene, {.light_sampling = way});
        const Estimate e = paths.ExitantRadiance({0}, frame.ToWorld(wo.cast<float>()), 8000);
        ExpectMean(e, expected, 3.0 * 2 * 3 * double(models.size()),
                   Describe(model) + " at " + std::to_string(theta));
      }
    }
  }
}

// Gloss, mirror, sheet, coloured walls and two lamps of different size, one double-sided.
Scene MixedRoom() {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {3, 3, 3}, b.AddLambert(Rgb(0.6f, 0.4f, 0.3f)), true);
  b.AddBox({0.3f, 0.01f, 0.3f}, {1, 1, 1}, b.AddMaterial("gloss", Metal(0.35f, Rgb(0.9f, 0.8f, 0.7f))));
  b.AddBox({2, 0.01f, 0.3f}, {2.7f, 1, 1}, b.AddMaterial("glazed", Coated(0, Rgb(0.2f, 0.5f, 0.7f))));
  b.AddQuad(
      {1, 0.5f, 1.5f}, {2, 0.5f, 1.5f}, {2, 1.5f, 1.7f}, {1, 1.5f, 1.7f},
      b.AddMaterial("sheet", Sheet(0.6f, Rgb::Constant(0.8f), Rgb(0.9f, 0.7f, 0.4f)), Rgb::Zero(), true));
  b.AddQuad({1, 2.9f, 1}, {1.8f, 2.9f, 1}, {1.8f, 2.9f, 1.8f}, {1, 2.9f, 1.8f}, b.AddEmitter(Rgb(5, 4, 3)));
  b.AddQuad({0.5f, 1.5f, 2.5f}, {0.8f, 1.5f, 2.5f}, {0.8f, 1.8f, 2.5f}, {0.5f, 1.8f, 2.5f},
            b.AddMaterial("leaf", Ward{Rgb::Constant(0.3f), 0.3f}, Rgb(4, 6, 8), true));
  return b.Build();
}

TEST(PathTracerTest, LightsDirectionsAndBothAgree) {
  const Scene scene = MixedRoom();
  const PathTracer both(scene), lights(scene, {.light_sampling = LightSampling::kLights}),
      directions(scene, {.light_sampling = LightSampling::kDirections});
  const uint32_t faces[] = {2, 5, 14, 18, 26, 30, 36, 37} /* no undersides: nothing to see there */;
  for (const uint32_t f : faces) {
    const Vec3 wo = (scene.GeometricNormal(scene.faces[f]) + Vec3(0.2f, 0.35f, -0.15f)).normalized();
    const SurfacePoint at{f, Side::kFront, 0.3f, 0.25f};
    const Estimate a = both.ExitantRadiance(at, wo, 16000, 1), l = lights.ExitantRadiance(at, wo, 32000, 2),
                   d = directions.ExitantRadiance(at, wo, 64000, 3);
    for (const Estimate& other : {l, d}) {
      Estimate difference;
      difference.mean = other.mean - a.mean;
      difference.standard_error = (other.standard_error.square() + a.standard_error.square()).sqrt();
      ExpectMean(difference, Rgb::Zero(), 3.0 * 2 * std::size(faces), "face " + std::to_string(f));
      EXPECT_LT(difference.standard_error.maxCoeff(), 0.1 * a.mean.maxCoeff()) << "the test sees too little";
    }
    EXPECT_LT(a.standard_error.mean() * std::sqrt(16000.0),
              1.1 * std::min(l.standard_error.mean() * std::sqrt(32000.0),
                             d.standard_error.mean() * std::sqrt(64000.0)))
        << "both together are as good as the better, face " << f;
  }
}

// Irradiance of a point from a polygon: Lambert's formula of 1760.
TEST(PathTracerTest, SquareLampOverAFloorFollowsLambertsFormula) {
  const Rgb radiance(3, 2, 1), albedo(0.8f, 0.5f, 0.2f);
  const std::vector<Vec3> lamp = {{-0.5f, 1, -0.4f}, {0.5f, 1, -0.4f}, {0.5f, 1, 0.4f}, {-0.5f, 1, 0.4f}};
  SceneBuilder b;
  b.AddTriangle({-3, 0, -3}, {-3, 0, 4}, {4, 0, -3}, b.AddLambert(albedo));
  b.AddQuad(lamp[0], lamp[1], lamp[2], lamp[3], b.AddEmitter(radiance));
  const Scene scene = b.Build();
  ASSERT_GT(scene.GeometricNormal(scene.faces[0]).y(), 0.9f);
  for (const auto way : {LightSampling::kBoth, LightSampling::kLights, LightSampling::kDirections}) {
    const PathTracer paths(scene, {.light_sampling = way});
    for (const auto& [u, v] : {std::pair{0.42f, 0.43f}, {0.35f, 0.55f}, {0.3f, 0.1f}}) {
      const auto p = scene.Corners(scene.faces[0]);
      const Vec3 at = (1 - u - v) * p[0] + u * p[1] + v * p[2];
      const double factor = test::PolygonIrradiance(at.cast<double>(), Vec3d::UnitY(), lamp);
      ASSERT_GT(factor, 0.01);
      const SurfacePoint point{0, Side::kFront, u, v};
      ExpectMean(paths.Irradiance(point, 20000), radiance * float(factor), 54, "irradiance");
      ExpectMean(paths.ExitantRadiance(point, Vec3(0.6f, 0.64f, 0.48f), 20000),
                 radiance * albedo * float(factor / kPi), 54, "radiance");
    }
  }
}

// Below a sheet: what arrives on its upper side, times t colour / pi, to every direction.
TEST(PathTracerTest, LightThroughASheetFollowsTheClosedForm) {
  const Rgb through(0.9f, 0.6f, 0.3f);
  const std::vector<Vec3> lamp = {{-0.5f, 1, -0.4f}, {0.5f, 1, -0.4f}, {0.5f, 1, 0.4f}, {-0.5f, 1, 0.4f}};
  for (const bool double_sided : {true, false}) {
    SceneBuilder b;
    b.AddTriangle(
        {-3, 0, -3}, {-3, 0, 4}, {4, 0, -3},
        b.AddMaterial("sheet", Sheet(0.7f, Rgb::Constant(0.5f), through), Rgb::Zero(), double_sided));
    b.AddQuad(lamp[0], lamp[1], lamp[2], lamp[3], b.AddEmitter(Rgb::Constant(2)));
    const Scene scene = b.Build();
    for (const auto way : {LightSampling::kBoth, LightSampling::kLights, LightSampling::kDirections}) {
      const PathTracer paths(scene, {.light_sampling = way});
      const double e = 2 * test::PolygonIrradiance({-3 + 7 * 0.3, 0, -3 + 7 * 0.4}, Vec3d::UnitY(), lamp);
      const SurfacePoint below{0, Side::kBack, 0.4f, 0.3f}, above{0, Side::kFront, 0.4f, 0.3f};
      const Rgb seen = through * float(0.7 * e / kPi);
      ExpectMean(paths.ExitantRadiance(below, Vec3(0.6f, -0.64f, 0.48f), 20000),
                 double_sided ? seen : Rgb(Rgb::Zero()), 36, "below");
      ExpectMean(paths.ExitantRadiance(above, Vec3(0.6f, 0.64f, 0.48f), 20000),
                 Rgb::Constant(float(0.5 * 0.3 * e / kPi)), 36, "above");
    }
  }
}

// Two mirrors and a lamp: the product of their Fresnel reflectances, without noise.
TEST(PathTracerTest, AChainOfMirrorsShowsTheProductOfTheirFresnels) {
  const MetallicRoughness gold = Metal(0, Rgb(0.9f, 0.7f, 0.3f)), silver = Metal(0, Rgb::Constant(0.95f));
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {0, 0, 4}, {4, 0, 4}, {4, 0, 0}, b.AddMaterial("gold", gold));      // floor
  b.AddQuad({4, 0, 0}, {4, 0, 4}, {4, 4, 4}, {4, 4, 0}, b.AddMaterial("silver", silver));  // right
  b.AddQuad({0, 4, 0}, {4, 4, 0}, {4, 4, 4}, {0, 4, 4}, b.AddEmitter(Rgb(1, 2, 3)));       // ceiling
  const Scene scene = b.Build();
  const Vec3 eye(1, 1.5f, 2), at(2.5f, 0, 2.1f);
  const Vec3 d = (at - eye).normalized();
  const Rgb expected = gold.Fresnel(-d.y()) * silver.Fresnel(d.x()) * Rgb(1, 2, 3);
  for (const auto way : {LightSampling::kBoth, LightSampling::kLights, LightSampling::kDirections}) {
    const PathTracer paths(scene, {.light_sampling = way});
    RandomStream random(1);
    uint64_t rays = 0;
    const Rgb got = paths.Radiance(RayTo(eye, at), random, &rays);
    EXPECT_LT(((got - expected) / expected).abs().maxCoeff(), 1e-5f) << got.transpose();
    EXPECT_EQ(rays, 3u);
  }
}

TEST(PathTracerTest, ShowsEmittersBacksAndNothing) {
  for (const bool double_sided : {false, true}) {
    SceneBuilder b;
    b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},  // faces +z
              b.AddMaterial("lamp", Lambert{Rgb::Zero()}, Rgb(1, 2, 3), double_sided));
    const Scene scene = b.Build();
    const PathTracer paths(scene);
    RandomStream random(1);
    EXPECT_TRUE((paths.Radiance(RayTo({0.5f, 0.4f, 1}, {0.5f, 0.4f, 0}), random) == Rgb(1, 2, 3)).all());
    EXPECT_EQ(paths.Radiance(RayTo({0.5f, 0.4f, -1}, {0.5f, 0.4f, 0}), random)[1], double_sided ? 2 : 0);
    EXPECT_EQ(paths.Radiance(RayTo({0.5f, 0.4f, 1}, {0.5f, 0.4f, 2}), random)[1], 0) << "the void";
  }
}

// Sheets modelled by two faces at one place, both lamps, and one lamp written twice: rays meet each once, so
// shadow rays must too.
TEST(PathTracerTest, RepeatedLampsCountOnce) {
  const Vec3 p0(-1, 1, -1), p1(1, 1, -1), p2(0.3f, 1, 1);  // faces down
  SceneBuilder b;
  b.AddTriangle({-3, 0, -3}, {-3, 0, 4}, {4, 0, -3}, b.AddLambert(Rgb::Constant(0.5f)));
  b.AddTriangle({-3, 2, -3}, {4, 2, -3}, {-3, 2, 4}, b.AddLambert(Rgb::Constant(0.5f)));
  b.AddTriangle(p0, p1, p2, b.AddMaterial("a", Lambert{Rgb::Zero()}, Rgb::Constant(1), true));
  b.AddTriangle(p1, p2, p0, b.AddMaterial("again", Lambert{Rgb::Zero()}, Rgb::Constant(2), true));
  b.AddTriangle(p0, p2, p1, b.AddMaterial("back", Lambert{Rgb::Zero()}, Rgb::Constant(5)));
  const Scene scene = b.Build();
  const auto e = [&](const Vec3d& n, const Vec3& at, bool up) {
    const std::vector<Vec3> lamp = up ? std::vector<Vec3>{p0, p1, p2} : std::vector<Vec3>{p0, p2, p1};
    return test::PolygonIrradiance(at.cast<double>(), n, lamp);
  };
  const SurfacePoint floor{0, Side::kFront, 0.4f, 0.35f}, ceiling{1, Side::kFront, 0.35f, 0.4f};
  const Vec3 on_floor(-3 + 7 * 0.35f, 0, -3 + 7 * 0.4f), on_ceiling(-3 + 7 * 0.35f, 2, -3 + 7 * 0.4f);
  for (const auto way : {LightSampling::kBoth, LightSampling::kLights, LightSampling::kDirections}) {
    const PathTracer paths(scene, {.light_sampling = way, .max_bounces = 1});
    ExpectMean(paths.Irradiance(floor, 20000), Rgb::Constant(float(e(Vec3d::UnitY(), on_floor, true))), 18,
               "the first lamp's front");
    ExpectMean(paths.Irradiance(ceiling, 20000),
               Rgb::Constant(5 * float(e(-Vec3d::UnitY(), on_ceiling, false))), 18, "its twin's front");
  }
}

// Interpolated normals: nothing leaks into a closed ball of few facets, and its white outside loses little.
TEST(PathTracerTest, SmoothNormalsNeitherLeakNorDarken) {
  for (const Reflectance& white :
       {Reflectance(Lambert{Rgb::Constant(1)}), Reflectance(Metal(0)), Reflectance(Metal(0.3f))}) {
    SceneBuilder b;
    b.AddBox({-4, -4, -4}, {4, 4, 4}, b.AddEmitter(Rgb::Constant(1)), true);
    b.AddSphere({0, 0, 0}, 1, b.AddMaterial("ball", white, Rgb::Zero(), true), 6);
    const Scene scene = b.Build();
    const PathTracer paths(scene);
    double sum = 0, least = 1;
    for (uint32_t f = 12; f < scene.faces.size(); ++f) {
      const Vec3 n = scene.GeometricNormal(scene.faces[f]);
      EXPECT_EQ(paths.ExitantRadiance({f, Side::kBack, 0.3f, 0.3f}, -n, 50, f).mean.maxCoeff(), 0)
          << "inside";
      for (const Vec3& lean : {Vec3(0.1f, 0.2f, 0.3f), Vec3(4, -2, 1), Vec3(-20, 8, 3)}) {
        const Vec3 wo = (n + lean - lean.dot(n) * n).normalized();
        const Estimate e = paths.ExitantRadiance({f, Side::kFront, 0.1f, 0.1f}, wo, 300, f);
        EXPECT_LE(e.mean[0], 1.001 + 5 * e.standard_error[0]);
        sum += e.mean[0];
        least = std::min(least, e.mean[0]);
      }
    }
    // Twelve facets round: the horizons of face and normal part by up to 15 degrees. Measured: 0.94, 1.00 and
    // 0.90.
    EXPECT_GT(sum / (3.0 * double(scene.faces.size() - 12)), 0.88) << Describe(white);
    EXPECT_GT(least, 0.4) << Describe(white);
  }
}

TEST(PathTracerTest, EstimatesAreTheSameForAnyNumberOfThreadsAndTheirErrorsHonest) {
  const Scene scene = MixedRoom();
  const PathTracer paths(scene);
  const SurfacePoint at{18, Side::kFront, 0.3f, 0.25f};
  const Vec3 wo = (scene.GeometricNormal(scene.faces[18]) + Vec3(0.2f, 0.3f, 0.1f)).normalized();
  Estimate one, many;
  tbb::task_arena(1).execute([&] { one = paths.ExitantRadiance(at, wo, 3000, 7); });
  tbb::task_arena(2).execute([&] { many = paths.ExitantRadiance(at, wo, 3000, 7); });
  EXPECT_TRUE((one.mean == many.mean).all() && (one.standard_error == many.standard_error).all());

  // Spread of 100 estimates against the errors they state: known to 1 / sqrt(200) = 7 %.
  double sum = 0, squares = 0, stated = 0;
  for (int seed = 0; seed < 100; ++seed) {
    const Estimate e = paths.ExitantRadiance(at, wo, 500, 1000 + seed);
    sum += e.mean[1];
    squares += e.mean[1] * e.mean[1];
    stated += e.standard_error[1] * e.standard_error[1] / 100;
  }
  const double variance = (squares - sum * sum / 100) / 99;
  EXPECT_NEAR(std::sqrt(variance / stated), 1, 0.25);
}

TEST(PathTracerTest, AsksForADirectionAboveTheSideAndTwoSamples) {
  const Scene scene = MixedRoom();
  const PathTracer paths(scene);
  const Vec3 n = scene.GeometricNormal(scene.faces[0]);
  EXPECT_THROW(paths.ExitantRadiance({0}, -n, 100), std::invalid_argument);
  EXPECT_THROW(paths.ExitantRadiance({0, Side::kBack}, n, 100), std::invalid_argument);
  EXPECT_THROW(paths.ExitantRadiance({0}, n, 1), std::invalid_argument);
}

TEST(PathTracerTest, ASceneWithoutLampsIsDark) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {1, 1, 1}, b.AddLambert(Rgb::Constant(1)), true);
  const Scene scene = b.Build();
  EXPECT_EQ(PathTracer(scene).Irradiance({0}, 100).mean.maxCoeff(), 0);
}

TEST(AliasTableTest, DrawsInProportionToItsWeights) {
  const std::vector<double> weights = {0.5, 0, 3, 1.25, 0.001, 7};
  double total = 0;
  for (const double w : weights) total += w;
  const AliasTable table(weights);
  std::vector<int> seen(weights.size());
  constexpr int kDraws = 1 << 20;
  // Evenly spaced: frequencies are exact but for one draw per cut.
  for (int i = 0; i < kDraws; ++i) ++seen[table.Draw((uint64_t(i) << 44) + 12345)];
  for (size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(seen[i], kDraws * weights[i] / total, 12) << i;
  EXPECT_EQ(seen[1], 0);
}

}  // namespace
}  // namespace lobe
