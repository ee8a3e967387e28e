#include "scene/mirror.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "scene/tessellate.h"
#include "tests/support/random_directions.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::RandomDirections;
using test::SceneBuilder;

constexpr float kFar = std::numeric_limits<float>::infinity();

TEST(MirrorDirectionTest, LiesInThePlaneAtTheSameAngleAndMirrorsBack) {
  RandomDirections random(11);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 n = random.Direction();
    const HitPoint at{Vec3::Zero(), n, n};
    const Vec3 wo = random.Above(n);
    if (wo.dot(n) < 1e-3f) continue;  // grazing is lifted
    const Vec3 wi = MirrorDirection(wo, at);
    EXPECT_NEAR(wi.norm(), 1, 1e-6);
    EXPECT_NEAR(wi.dot(n), wo.dot(n), 1e-6);
    EXPECT_NEAR(n.dot(wo.cross(wi)), 0, 1e-6) << "in one plane";
    EXPECT_LT(((wi + wo) - 2 * wo.dot(n) * n).norm(), 1e-6) << "on the other side of the normal";
    EXPECT_LT((MirrorDirection(wi, at) - wo).norm(), 2e-6);
  }
}

// An interpolated normal may turn the mirror image into the surface: it is lifted just above, and no further.
TEST(MirrorDirectionTest, WhatWouldPointIntoTheSurfaceIsLiftedJustAboveIt) {
  RandomDirections random(11);
  int lifted = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 face = random.Direction();
    const Vec3 n = (face + 0.5f * random.Direction()).normalized();
    const Vec3 wo = random.Above(face);
    const Vec3 wi = MirrorDirection(wo, {Vec3::Zero(), face, n});
    const Vec3 plain = 2 * wo.dot(n) * n - wo;
    EXPECT_NEAR(wi.norm(), 1, 1e-6);
    EXPECT_GT(wi.dot(face), 0);
    if (plain.dot(face) > 0) {
      EXPECT_LT((wi - plain).norm(), 1e-6);
      continue;
    }
    ++lifted;
    // The rest is the part along the face, made unit: of length 0.5 at least here, so 1e-4 grows to 2e-4.
    EXPECT_LT(wi.dot(face), 1e-3);
    const Vec3 along = plain - plain.dot(face) * face;
    EXPECT_GT(wi.dot(along.normalized()), 1 - 1e-6);
  }
  EXPECT_GT(lifted, 100);
}

TEST(FindHitPointTest, FlatFacesHaveTheFacesNormalOnTheSideThatWasMet) {
  SceneBuilder b;
  const uint32_t grey = b.AddMaterial("grey", Lambert{}, Rgb::Zero(), /*double_sided=*/true);
  b.AddQuad({-1, 0.5f, 1}, {1, 0.5f, 1}, {1, 0.9f, -1}, {-1, 0.9f, -1}, grey);
  const Scene scene = b.Build();
  const Mesh mesh = Tessellate(scene, {.max_edge = 0.4f});
  const RayTracer tracer(scene);
  const Vec3 n = scene.GeometricNormal(scene.faces[0]);
  RandomDirections random(11);
  int met[2] = {0, 0};
  for (int i = 0; i < 500; ++i) {
    const Vec3 target(0.3f, 0.7f, 0);
    const Vec3 away = random.Direction();
    // A direction that is not unit: t is in multiples of it.
    const Ray ray{target + 3 * away, 0, -2 * away, kFar};
    const RayHit hit = tracer.Intersect(ray);
    if (!hit.hit()) continue;
    const HitPoint at = FindHitPoint(scene, mesh, ray, hit, mesh.Locate(hit.face, hit.side, hit.u, hit.v));
    // Ends where it was aimed, but for what grazing adds.
    EXPECT_LT((at.position - target).norm(), 3e-6f / std::abs(away.dot(n)));
    ++met[int(hit.side)];
    EXPECT_LT((at.geometric_normal - (hit.side == Side::kFront ? n : Vec3(-n))).norm(), 1e-6);
    EXPECT_EQ(at.normal, at.geometric_normal);
    EXPECT_GT(at.geometric_normal.dot(away), 0) << "on the side the ray came from";
  }
  EXPECT_GT(met[0], 100);
  EXPECT_GT(met[1], 100);
}

TEST(FindHitPointTest, CurvedPatchesHaveInterpolatedNormalsOnBothSides) {
  constexpr int kSegments = 24;
  SceneBuilder b;
  const Vec3 centre(0.2f, -0.3f, 0.4f);
  b.AddSphere(centre, 0.8f, b.AddMaterial("grey", Lambert{}, Rgb::Zero(), true), kSegments);
  const Scene scene = b.Build();
  const Mesh mesh = Tessellate(scene, {.max_edge = 0.05f});
  const RayTracer tracer(scene);
  RandomDirections random(11);
  double flattest = 1;
  for (int i = 0; i < 2000; ++i) {
    const bool inside = i % 2;
    const Vec3 from = inside ? centre : Vec3(centre + 2 * random.Direction());
    const Vec3 direction = inside ? random.Direction() : Vec3((centre - from).normalized());
    const Ray ray{from, 0, direction, kFar};
    const RayHit hit = tracer.Intersect(ray);
    ASSERT_TRUE(hit.hit());
    const HitPoint at = FindHitPoint(scene, mesh, ray, hit, mesh.Locate(hit.face, hit.side, hit.u, hit.v));
    const Vec3 radial = (at.position - centre).normalized() * (inside ? -1.0f : 1.0f);
    EXPECT_NEAR(at.normal.norm(), 1, 1e-6);
    // Linear interpolation between normals an angle h apart is off by at most h^2 / 8 in length and, since
    // points and normals are interpolated alike, by next to nothing in direction.
    EXPECT_GT(at.normal.dot(radial), 1 - 2e-5);
    EXPECT_GT(at.normal.dot(at.geometric_normal), 0);
    flattest = std::min(flattest, double(at.geometric_normal.dot(radial)));
  }
  EXPECT_LT(flattest, 1 - 5e-4) << "the faces' own normals are much further off";
}

TEST(FindHitPointTest, WithoutNodesTheGeometricNormalIsTakenAsItIs) {
  SceneBuilder b;
  b.AddSphere({0, 0, 0}, 1, b.AddLambert(Rgb::Constant(0.5f)), 6);
  const Scene scene = b.Build();
  const Mesh mesh = Tessellate(scene, {.max_edge = 0.3f});  // fronts only
  const RayTracer tracer(scene);
  const Ray ray{{0, 0, 0}, 0, Vec3(0.3f, 0.5f, -0.7f).normalized(), kFar};
  const RayHit hit = tracer.Intersect(ray);
  ASSERT_TRUE(hit.hit());
  ASSERT_EQ(hit.side, Side::kBack);
  const Mesh::Location where = mesh.Locate(hit.face, hit.side, hit.u, hit.v);
  ASSERT_EQ(where.element, kNone);
  const HitPoint at = FindHitPoint(scene, mesh, ray, hit, where);
  EXPECT_EQ(at.normal, at.geometric_normal);
  EXPECT_LT((at.normal + scene.GeometricNormal(scene.faces[hit.face])).norm(), 1e-6);
}

}  // namespace
}  // namespace lobe
