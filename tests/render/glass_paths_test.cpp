#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "render/path_tracer.h"
#include "tests/support/glass.h"
#include "tests/support/scene_builder.h"
#include "tests/support/significance.h"

namespace lobe {
namespace {

using test::ClearGlass;
using test::Pane;
using test::SceneBuilder;

constexpr double kPi = std::numbers::pi;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr LightSampling kWays[] = {LightSampling::kBoth, LightSampling::kLights, LightSampling::kDirections};

Ray RayTo(const Vec3& from, const Vec3& to) { return {from, 0, (to - from).normalized(), kInfinity}; }

// Mean of independent samples of one ray.
Estimate Look(const PathTracer& paths, const Ray& ray, int samples) {
  RandomStream random(77);
  Eigen::Array3d first = Eigen::Array3d::Zero(), second = first;
  for (int i = 0; i < samples; ++i) {
    const Eigen::Array3d x = paths.Radiance(ray, random).cast<double>();
    first += x;
    second += x * x;
  }
  Estimate out;
  out.mean = first / samples;
  out.standard_error = ((second / samples - out.mean.square()).max(0.0) / samples).sqrt();
  return out;
}

void ExpectMean(const Estimate& got, const Rgb& expected, double tests, const std::string& what) {
  const double z = test::SidakQuantile(0.01, tests);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(got.mean[c], expected[c], z * got.standard_error[c] + 3e-5 * std::abs(expected[c]))
        << what << ", channel " << c << ", standard error " << got.standard_error[c];
  }
}

// Every way into a lossless thing ends on a wall of radiance 1. Only roulette, from the ninth bounce on,
// makes samples differ: 1 / 0.98 for those that live on.
TEST(GlassPathsTest, ClearGlassInAFurnaceIsInvisible) {
  SceneBuilder b;
  b.AddBox({-2, -2, -2}, {2, 2, 2}, b.AddEmitter(Rgb::Constant(1)), true);
  const uint32_t glass = b.AddMaterial("glass", ClearGlass(1.5f)),
                 water = b.AddMaterial("water", ClearGlass(1.33f));
  b.AddSphere({-0.8f, 0, 0}, 0.6f, glass, 12);
  b.AddSphere({-0.8f, 0.1f, 0}, 0.3f, water, 12);
  b.AddBox({0.5f, -0.5f, -0.5f}, {1.2f, 0.7f, 0.4f}, glass);
  const uint32_t pane = b.AddMaterial("pane", Pane(1.7f), Rgb::Zero(), true);
  b.AddQuad({-1, -1, 1}, {1, -1, 1}, {1, 1, 1.3f}, {-1, 1, 1.3f}, pane);
  const Scene scene = b.Build();
  for (const auto way : kWays) {
    const PathTracer paths(scene, {.light_sampling = way});
    RandomStream random(5);
    double sum = 0, sum2 = 0;
    int plain = 0;
    constexpr int kSamples = 40000;
    for (int i = 0; i < kSamples; ++i) {
      const Vec3 from(3 * random.Next() - 1.5f, 3 * random.Next() - 1.5f, 1.8f);
      const Vec3 to(2.4f * random.Next() - 1.4f, 1.2f * random.Next() - 0.6f, 0.6f * random.Next() - 0.3f);
      const double x = paths.Radiance(RayTo(from, to), random)[1];
      plain += std::abs(x - 1) < 1e-4;
      sum += x;
      sum2 += x * x;
    }
    const double mean = sum / kSamples, error = std::sqrt((sum2 / kSamples - mean * mean) / kSamples);
    EXPECT_NEAR(mean, 1, 4 * error + 1e-5);
    EXPECT_GT(plain, 0.9 * kSamples);
  }
}

TEST(GlassPathsTest, WhatGlassDoesNotPassItsBaseReflects) {
  SceneBuilder b;  // walls of reflectance 1/2 that emit 1: every radiance is 2
  const Rgb white = Rgb::Constant(1);
  b.AddBox({-2, -2, -2}, {2, 2, 2}, b.AddMaterial("wall", Lambert{Rgb::Constant(0.5f)}, white), true);
  MetallicRoughness half = Pane(1.5f);
  half.transmission = 0.5f;
  half.has_specular = true;
  half.specular = 0;  // a coat would make the base's albedo depend on the angle
  b.AddQuad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0.3f}, {-1, 1, 0.3f},
            b.AddMaterial("pane", half, Rgb::Zero(), true));
  const Scene scene = b.Build();
  for (const auto way : kWays) {
    const PathTracer paths(scene, {.light_sampling = way});
    for (const Vec3& to : {Vec3(0.3f, 0.2f, 0.1f), Vec3(-0.6f, 0.5f, 0.2f)}) {
      ExpectMean(Look(paths, RayTo({0.4f, -0.3f, 1.7f}, to), 20000), Rgb::Constant(2), 18, "pane");
    }
  }
}

// Irradiance under a square lamp behind a pane: the area integral of cos cos T / r^2, by midpoints.
TEST(GlassPathsTest, ALampBehindAPaneFollowsTheAreaIntegral) {
  constexpr float kLamp = 2, kPane = 1.2f, kIor = 1.6f;
  const Rgb tint(0.9f, 0.6f, 0.3f);
  SceneBuilder b;
  const uint32_t floor = b.AddLambert(Rgb::Constant(0.5f));
  b.AddTriangle({-0.3f, 0, -0.2f}, {0, 0, 0.4f}, {0.3f, 0, -0.2f}, floor);
  b.AddQuad({-1, kLamp, -1}, {1, kLamp, -1}, {1, kLamp, 1}, {-1, kLamp, 1}, b.AddEmitter(Rgb::Constant(3)));
  b.AddQuad({-9, kPane, -9}, {-9, kPane, 9}, {9, kPane, 9}, {9, kPane, -9},
            b.AddMaterial("pane", Pane(kIor, tint), Rgb::Zero(), true));
  const Scene scene = b.Build();
  ASSERT_GT(scene.GeometricNormal(scene.faces[0]).y(), 0.9f);
  ASSERT_LT(scene.GeometricNormal(scene.faces[1]).y(), -0.9f);

  constexpr int kSteps = 400;
  const double f0 = std::pow((kIor - 1) / (kIor + 1), 2);
  double expected = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double x = (i + 0.5) * 2 / kSteps - 1, z = (j + 0.5) * 2 / kSteps - 1;
      const double r2 = x * x + z * z + kLamp * kLamp, cosine = kLamp / std::sqrt(r2);
      expected += 3 * cosine * cosine / r2 * (1 - f0) * (1 - std::pow(1 - cosine, 5));
    }
  }
  expected *= 4.0 / (kSteps * kSteps);
  for (const auto way : kWays) {
    const PathTracer paths(scene, {.light_sampling = way});
    // The first triangle's centroid lies above the origin.
    const Estimate e = paths.Irradiance({0}, 60000);
    ExpectMean(e, Rgb(tint * float(expected)), 9, "way " + std::to_string(int(way)));
  }
}

// Light from below a coloured slab, and what is reflected to and fro in it: at one angle throughout.
TEST(GlassPathsTest, ASlabPassesTheSeriesOfItsInnerReflections) {
  constexpr float kThick = 0.4f, kIor = 1.5f;
  MetallicRoughness m = ClearGlass(kIor);
  m.attenuation_color = Rgb(0.9f, 0.5f, 0.1f);
  m.attenuation_distance = 0.3f;
  SceneBuilder b;
  b.AddBox({-50, 0, -50}, {50, kThick, 50}, b.AddMaterial("glass", m));
  b.AddQuad({-50, -1, -50}, {-50, -1, 50}, {50, -1, 50}, {50, -1, -50}, b.AddEmitter(Rgb::Constant(1)));
  const Scene scene = b.Build();
  const PathTracer paths(scene);
  for (const float angle : {0.2f, 0.8f, 1.2f}) {
    const Vec3 down(std::sin(angle), -std::cos(angle), 0);
    const Estimate e = Look(paths, {Vec3(0.2f, kThick, 0.1f) - down, 0, down, kInfinity}, 40000);
    const double sine = std::sin(angle) / kIor, length = kThick / std::sqrt(1 - sine * sine);
    const double f = 0.04 + 0.96 * std::pow(1 - std::cos(angle), 5);
    Rgb expected;
    for (int c = 0; c < 3; ++c) {
      const double a = std::pow(double(m.attenuation_color[c]), length / 0.3);
      expected[c] = float((1 - f) * (1 - f) * a / (1 - f * f * a * a));
    }
    ExpectMean(e, expected, 9, "angle " + std::to_string(angle));
  }
}

TEST(GlassPathsTest, RadianceInsideGlassIsTheSquareOfTheIndexTimesThatOutside) {
  SceneBuilder b;
  b.AddBox({-1, -1, -1}, {1, 1, 1}, b.AddMaterial("glass", ClearGlass(1.5f)));
  b.AddQuad({-0.5f, 0, -0.5f}, {-0.5f, 0, 0.5f}, {0.5f, 0, 0.5f}, {0.5f, 0, -0.5f},
            b.AddEmitter(Rgb::Constant(1)));
  const PathTracer paths(b.Build());
  ExpectMean(Look(paths, RayTo({0.1f, 3, 0.1f}, {0.1f, 0, 0.1f}), 40000), Rgb::Constant(0.96f / 2.25f), 3,
             "a lamp in glass");
  // From inside, under light 1 from everywhere outside: n^2 within the critical angle.
  SceneBuilder in;
  in.AddBox({-1, -1, -1}, {1, 1, 1}, in.AddMaterial("glass", ClearGlass(1.5f)));
  in.AddBox({-3, -3, -3}, {3, 3, 3}, in.AddEmitter(Rgb::Constant(1)), true);
  const PathTracer inside(in.Build());
  ExpectMean(Look(inside, RayTo({0.1f, 0.2f, 0.1f}, {0.1f, 1, 0.15f}), 20000), Rgb::Constant(2.25f), 3,
             "out of glass");
}

TEST(GlassPathsTest, LightsDirectionsAndBothAgreeAmongGlass) {
  SceneBuilder b;
  const uint32_t wall = b.AddLambert(Rgb(0.7f, 0.6f, 0.5f));
  b.AddBox({-1, 0, -1}, {1, 2, 1}, wall, true);
  b.AddQuad({-0.6f, 1.95f, -0.6f}, {0.6f, 1.95f, -0.6f}, {0.6f, 1.95f, 0.6f}, {-0.6f, 1.95f, 0.6f},
            b.AddEmitter(Rgb(4, 5, 6)));
  MetallicRoughness green = ClearGlass(1.5f), half = Pane(1.5f, Rgb(0.8f, 0.9f, 1));
  green.attenuation_color = Rgb(0.3f, 0.9f, 0.4f);
  green.attenuation_distance = 0.3f;
  half.transmission = 0.6f;
  b.AddSphere({-0.4f, 0.5f, 0}, 0.35f, b.AddMaterial("ball", ClearGlass(1.5f)), 12);
  b.AddBox({0.2f, 0.001f, -0.4f}, {0.7f, 0.6f, 0.1f}, b.AddMaterial("block", green));
  b.AddQuad({-0.9f, 1.2f, -0.9f}, {-0.9f, 1.2f, 0.9f}, {0.9f, 1.3f, 0.9f}, {0.9f, 1.3f, -0.9f},
            b.AddMaterial("pane", half, Rgb::Zero(), true));
  const Scene scene = b.Build();
  const PathTracer both(scene), lights(scene, {.light_sampling = LightSampling::kLights}),
      directions(scene, {.light_sampling = LightSampling::kDirections});
  // A point of every wall, and the pane's base from both sides.
  std::vector<SurfacePoint> places;
  for (uint32_t f = 0; f < 12; f += 2) places.push_back({f, Side::kFront, 0.3f, 0.2f});
  const uint32_t pane = uint32_t(scene.faces.size()) - 1;
  places.push_back({pane, Side::kFront, 0.3f, 0.2f});
  places.push_back({pane, Side::kBack, 0.3f, 0.2f});
  const double z = test::SidakQuantile(0.01, 2.0 * 3 * double(places.size()));
  constexpr int kSamples = 30000;
  for (const SurfacePoint& at : places) {
    const Vec3 n = scene.GeometricNormal(scene.faces[at.face]) * (at.side == Side::kFront ? 1.0f : -1.0f);
    const Vec3 wo = (n + Vec3(0.2f, 0.1f, -0.15f)).normalized();
    const Estimate a = both.ExitantRadiance(at, wo, kSamples, 1),
                   b2 = lights.ExitantRadiance(at, wo, kSamples, 2),
                   c = directions.ExitantRadiance(at, wo, kSamples, 3);
    for (const Estimate* other : {&b2, &c}) {
      for (int k = 0; k < 3; ++k) {
        const double error = std::hypot(a.standard_error[k], other->standard_error[k]);
        EXPECT_NEAR(a.mean[k], other->mean[k], z * error) << "face " << at.face << " side " << int(at.side);
        EXPECT_LT(error, 0.1 * a.mean[k]) << "noise hides nothing";
      }
    }
  }
}

}  // namespace
}  // namespace lobe
