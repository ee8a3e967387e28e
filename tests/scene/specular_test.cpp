#include "scene/specular.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/glass.h"
#include "tests/support/random_directions.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::ClearGlass;
using test::Pane;
using test::RandomDirections;
using test::SceneBuilder;

constexpr float kFar = std::numeric_limits<float>::infinity();

// Materials without faces: Continue needs no more.
SpecularSurfaces Surfaces(const std::vector<Reflectance>& reflectances) {
  SceneBuilder b;
  for (const Reflectance& r : reflectances) b.AddMaterial("m", r);
  return SpecularSurfaces(b.Build());
}

MediaStack Inside(std::initializer_list<uint32_t> materials) {
  MediaStack media;
  for (const uint32_t m : materials) media.Enter(m);
  return media;
}

HitPoint FlatHit(const Vec3& normal) { return {Vec3::Zero(), normal, normal}; }

// Follows transmissions alone, to where they leave the scene.
struct Way {
  Ray ray;
  Rgb weight = Rgb::Constant(1);
  MediaStack media;
  int crossings = 0;
  bool reflected_totally = false;
};
Way FollowTransmission(const Scene& scene, Ray ray, const MediaStack& start = {}) {
  const RayTracer tracer(scene);
  const SpecularSurfaces specular(scene);
  Way way{ray, Rgb::Constant(1), start, 0, false};
  for (; way.crossings < 100; ++way.crossings) {
    const RayHit hit = tracer.Intersect(way.ray);
    if (!hit.hit()) return way;
    const uint32_t material = scene.faces[hit.face].material;
    way.weight *= specular.Transmittance(way.media, material, hit.side, hit.t);
    const HitPoint at = FindHitPoint(scene, way.ray, hit);
    const SpecularWays ways = specular.Continue(material, hit.side, at, -way.ray.direction, way.media);
    if (!ways.transmission.open()) {
      way.reflected_totally = true;
      return way;
    }
    way.weight *= ways.transmission.weight;
    way.media = ways.beyond;
    way.ray = {at.position + ways.transmission.outward * tracer.epsilon(), 0, ways.transmission.direction,
               kFar};
  }
  return way;
}

float F0(float n1, float n2) { return (n1 - n2) * (n1 - n2) / ((n1 + n2) * (n1 + n2)); }

TEST(MediaStackTest, ForgetsTheOutermostWhenFull) {
  MediaStack media;
  EXPECT_EQ(media.top(), kNone);
  for (uint32_t m = 0; m < 20; ++m) media.Enter(m);
  for (uint32_t m = 20; m-- > 20 - MediaStack::kCapacity;) {
    EXPECT_EQ(media.top(), m);
    media.Leave(m);
  }
  EXPECT_EQ(media.top(), kNone);
  media.Leave(3);  // of what it does not know it takes leave without harm
  EXPECT_EQ(media.top(), kNone);
}

TEST(MediaStackTest, LeavesTheLastOfAMaterialWhereverItIs) {
  MediaStack media = Inside({4, 5, 4, 6});
  media.Leave(4);
  EXPECT_TRUE(media.Contains(4));
  EXPECT_EQ(media.top(), 6u);
  media.Leave(6);
  EXPECT_EQ(media.top(), 5u);
  media.Leave(4);
  EXPECT_FALSE(media.Contains(4));
}

TEST(SpecularSurfacesTest, KindsFollowFromTransmissionThicknessAndRoughness) {
  MetallicRoughness rough = ClearGlass(1.5f), metal = rough, chrome{.roughness = 0};
  rough.roughness = 0.5f;
  metal.metallic = 1;
  const auto s = Surfaces({Lambert{}, chrome, Pane(1.5f), ClearGlass(1.5f), rough, metal});
  using Kind = SpecularSurfaces::Kind;
  const Kind expected[] = {Kind::kNone, Kind::kMirror, Kind::kPane, Kind::kBody, Kind::kNone, Kind::kMirror};
  for (uint32_t m = 0; m < 6; ++m) EXPECT_EQ(s.kind(m), expected[m]) << m;
  EXPECT_TRUE(s.any_pane() && s.any_body());
  EXPECT_FALSE(Surfaces({Lambert{}, chrome}).any_pane() || Surfaces({Lambert{}, chrome}).any_body());
}

TEST(SpecularSurfacesTest, ClearWhiteGlassLosesNothingAtAnyAngleFromEitherSide) {
  RandomDirections random(23);
  for (int i = 0; i < 2000; ++i) {
    const auto s = Surfaces({ClearGlass(random.Between(1.01f, 2.5f)), ClearGlass(random.Between(1.01f, 2.5f)),
                             Pane(random.Between(1, 2.5f))});
    const Vec3 n = random.Direction(), wo = random.Above(n);
    for (const Side side : {Side::kFront, Side::kBack}) {
      for (const uint32_t material : {0u, 2u}) {
        for (const MediaStack& media : {MediaStack{}, Inside({1}), Inside({0}), Inside({1, 0})}) {
          const SpecularWays ways = s.Continue(material, side, FlatHit(n), wo, media);
          EXPECT_LT((ways.reflection.weight + ways.transmission.weight / ways.basic - 1).abs().maxCoeff(),
                    1e-6);
          EXPECT_GE(ways.reflection.weight.minCoeff(), 0);
          EXPECT_GE(ways.transmission.weight.minCoeff(), 0);
        }
      }
    }
  }
}

TEST(SpecularSurfacesTest, RefractsBySnellsLawAndTheWayBackIsTheSame) {
  RandomDirections random(23);
  int refracted = 0, total = 0;
  for (int i = 0; i < 4000; ++i) {
    // From air, or from water around the glass.
    const float n_glass = random.Between(1.05f, 2.4f), n_water = random.Between(1.05f, 2.4f);
    const auto s = Surfaces({ClearGlass(n_glass), ClearGlass(n_water)});
    const bool in_water = i % 2, from_inside = i % 4 < 2;
    const float n_outer = in_water ? n_water : 1.0f;
    const float n_here = from_inside ? n_glass : n_outer, n_beyond = from_inside ? n_outer : n_glass;
    MediaStack media = in_water ? Inside({1}) : MediaStack{};
    if (from_inside) media.Enter(0);
    const Vec3 n = random.Direction(), wo = random.Above(n);
    const Side side = from_inside ? Side::kBack : Side::kFront;
    const SpecularWays ways = s.Continue(0, side, FlatHit(n), wo, media);
    const float sine = wo.cross(n).norm(), sine_beyond = sine * n_here / n_beyond;
    if (sine_beyond >= 1) {
      EXPECT_FALSE(ways.transmission.open());
      EXPECT_TRUE((ways.reflection.weight == 1).all());
      ++total;
      continue;
    }
    if (sine_beyond > 0.999f || sine > 0.999f) continue;  // roots of small differences
    ++refracted;
    const Vec3& wt = ways.transmission.direction;
    EXPECT_NEAR(wt.norm(), 1, 1e-6);
    EXPECT_LT(wt.dot(n), 0);
    EXPECT_NEAR(wt.cross(n).norm(), sine_beyond, 2e-6);
    EXPECT_LT((n_here * wo.cross(n) + n_beyond * wt.cross(n)).norm(), 1e-5)
        << "in one plane, to the other side";
    EXPECT_NEAR(ways.basic, n_here * n_here / (n_beyond * n_beyond), 1e-5);

    const Side other = from_inside ? Side::kFront : Side::kBack;
    const SpecularWays back = s.Continue(0, other, FlatHit(-n), wt, ways.beyond);
    EXPECT_LT((back.transmission.direction - wo).norm(), 2e-4);
    EXPECT_NEAR(back.basic * ways.basic, 1, 1e-5);
    EXPECT_LT((back.reflection.weight - ways.reflection.weight).abs().maxCoeff(), 1e-3)
        << "both sides reflect the same share";
    EXPECT_EQ(back.beyond.top(), media.top());
  }
  EXPECT_GT(refracted, 2000);
  EXPECT_GT(total, 300);
}

TEST(SpecularSurfacesTest, TotalReflectionBeginsAtTheCriticalAngle) {
  const auto s = Surfaces({ClearGlass(1.5f)});
  const float critical = std::asin(1 / 1.5f);
  const auto open = [&](float angle) {
    const Vec3 wo(std::sin(angle), 0, std::cos(angle));
    return s.Continue(0, Side::kBack, FlatHit(Vec3::UnitZ()), wo, Inside({0})).transmission.open();
  };
  EXPECT_TRUE(open(critical - 1e-3f));
  EXPECT_FALSE(open(critical + 1e-3f));
}

// KHR_materials_ior: 0 stands for an index without end. Chances are weights over `basic`, which must not be 0
// where nothing is transmitted.
TEST(SpecularSurfacesTest, GlassOfIndexZeroReflectsAllFromBothSides) {
  const auto s = Surfaces({ClearGlass(0), ClearGlass(1.5f)});
  RandomDirections random(23);
  const auto expect_mirror = [](const SpecularWays& ways) {
    EXPECT_TRUE((ways.reflection.weight == 1).all()) << ways.reflection.weight.transpose();
    EXPECT_TRUE(ways.reflection.direction.allFinite());
    EXPECT_FALSE(ways.transmission.open());
    EXPECT_TRUE(ways.transmission.direction.allFinite());
    EXPECT_TRUE((ways.transmission.weight / ways.basic == 0).all()) << "of power";
  };
  for (int i = 0; i < 500; ++i) {
    const Vec3 n = random.Direction(), wo = i % 10 ? random.Above(n) : n;
    expect_mirror(s.Continue(0, Side::kFront, FlatHit(n), wo, {}));
    expect_mirror(s.Continue(0, Side::kFront, FlatHit(n), wo, Inside({1})));
    expect_mirror(s.Continue(0, Side::kBack, FlatHit(n), wo, {}));
    expect_mirror(s.Continue(0, Side::kBack, FlatHit(n), wo, Inside({0})));
    expect_mirror(s.Continue(0, Side::kBack, FlatHit(n), wo, Inside({1, 0})));
    expect_mirror(s.Continue(1, Side::kFront, FlatHit(n), wo, Inside({0})));
  }
}

TEST(SpecularSurfacesTest, AtNormalIncidenceBothMediaDecideWhatIsReflected) {
  const auto s = Surfaces({ClearGlass(1.5f), ClearGlass(1.33f)});
  const auto reflected = [&](Side side, const MediaStack& media) {
    return s.Continue(0, side, FlatHit(Vec3::UnitY()), Vec3::UnitY(), media).reflection.weight[1];
  };
  EXPECT_NEAR(reflected(Side::kFront, {}), 0.04f, 1e-6);
  EXPECT_NEAR(reflected(Side::kFront, Inside({1})), F0(1.5f, 1.33f), 1e-6);
  EXPECT_NEAR(reflected(Side::kBack, Inside({1, 0})), F0(1.5f, 1.33f), 1e-6);
  EXPECT_NEAR(reflected(Side::kBack, {}), 0.04f, 1e-6) << "whoever meets the inside has been inside";
}

TEST(SpecularSurfacesTest, BetweenEqualMediaThereIsNoBoundary) {
  const auto s = Surfaces({ClearGlass(1.33f), ClearGlass(1.33f), ClearGlass(1.5f), ClearGlass(1.0f)});
  RandomDirections random(23);
  for (int i = 0; i < 500; ++i) {
    const Vec3 n = random.Direction(), wo = random.Above(n);
    if (wo.dot(n) < 1e-3f) continue;
    // Water in water; leaving water with glass entered since; air in air.
    const SpecularWays all[] = {s.Continue(0, Side::kFront, FlatHit(n), wo, Inside({1})),
                                s.Continue(0, Side::kBack, FlatHit(n), wo, Inside({0, 2})),
                                s.Continue(3, Side::kFront, FlatHit(n), wo, {})};
    for (const SpecularWays& ways : all) {
      EXPECT_FALSE(ways.reflection.open());
      EXPECT_TRUE((ways.transmission.weight == 1).all());
      EXPECT_LT((ways.transmission.direction + wo).norm(), 1e-6);
    }
    EXPECT_EQ(all[1].beyond.top(), 2u);
  }
}

TEST(SpecularSurfacesTest, InterpolatedNormalsSendNothingToTheWrongSideOfTheFace) {
  const auto s = Surfaces({ClearGlass(1.5f), Pane(1.5f)});
  RandomDirections random(23);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 face = random.Direction();
    const Vec3 n = (face + 0.6f * random.Direction()).normalized();
    const HitPoint at{Vec3::Zero(), face, n};
    const Vec3 wo = random.Above(face);
    for (const Side side : {Side::kFront, Side::kBack}) {
      for (const uint32_t material : {0u, 1u}) {
        const SpecularWays ways = s.Continue(material, side, at, wo, {});
        EXPECT_GT(ways.reflection.direction.dot(face), 0);
        EXPECT_LT(ways.transmission.direction.dot(face), 0);
        EXPECT_NEAR(ways.transmission.direction.norm(), 1, 1e-5);
      }
    }
  }
}

TEST(SpecularSurfacesTest, ColourAndTransmissionShareWeighEachCrossing) {
  MetallicRoughness m = ClearGlass(1.5f);
  m.base_color = Rgb(1, 0.5f, 0.25f);
  m.transmission = 0.5f;
  const auto s = Surfaces({m});
  const SpecularWays ways = s.Continue(0, Side::kFront, FlatHit(Vec3::UnitY()), Vec3::UnitY(), {});
  EXPECT_LT((ways.transmission.weight / ways.basic - 0.96f * 0.5f * m.base_color).abs().maxCoeff(), 1e-6);
  EXPECT_NEAR(std::get<MetallicRoughness>(Reflectance(m)).DiffuseColor()[1], 0.25f, 1e-6)
      << "the other half of the light under the coat is the base's";
}

TEST(SpecularSurfacesTest, ASlabDisplacesARayWithoutTurningItAndAttenuatesByItsLength) {
  constexpr float kThick = 0.3f, kIor = 1.5f;
  SceneBuilder b;
  MetallicRoughness m = ClearGlass(kIor);
  m.attenuation_color = Rgb(0.5f, 0.25f, 0);
  m.attenuation_distance = 0.2f;
  b.AddBox({-5, 0, -5}, {5, kThick, 5}, b.AddMaterial("glass", m));
  const Scene scene = b.Build();
  for (const float angle : {0.0f, 0.3f, 0.9f, 1.3f}) {
    const Vec3 down(std::sin(angle), -std::cos(angle), 0);
    const Ray ray{Vec3(0.1f, kThick, 0.2f) - 2 * down, 0, down, kFar};
    const Way way = FollowTransmission(scene, ray);
    ASSERT_EQ(way.crossings, 2);
    EXPECT_LT((way.ray.direction - down).norm(), 2e-6) << angle;
    const float beyond = std::asin(std::sin(angle) / kIor);
    const Vec3 off = way.ray.origin - ray.origin;
    const float shift = (off - off.dot(down) * down).norm();
    EXPECT_NEAR(shift, kThick * std::sin(angle - beyond) / std::cos(beyond), 1e-5) << angle;
    const float c = 1 - std::cos(angle), fresnel = 0.04f + 0.96f * c * c * c * c * c;
    const float length = kThick / std::cos(beyond);
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(way.weight[k], std::pow(1 - fresnel, 2) * std::pow(m.attenuation_color[k], length / 0.2f),
                  1e-5);
    }
    EXPECT_EQ(way.weight[2], 0) << "black at its distance is black at any";
    EXPECT_EQ(way.media.top(), kNone);
  }
}

TEST(SpecularSurfacesTest, NestedBallsAndBubblesAreCrossedInOrder) {
  const Ray ray{{-3, 0.004f, 0.003f}, 0, Vec3::UnitX(), kFar};
  const auto weight = [&](const SceneBuilder& b, int crossings, const MediaStack& start = {}) {
    const Way way = FollowTransmission(b.Build(), ray, start);
    EXPECT_EQ(way.crossings, crossings);
    EXPECT_EQ(way.media.top(), kNone);
    EXPECT_GT(way.ray.direction.dot(ray.direction), 1 - 1e-3) << "through the middle";
    return way.weight[0];
  };
  constexpr double kTolerance = 1e-4;  // the ray is a little off the axis
  {
    SceneBuilder water_in_glass;
    const uint32_t glass = water_in_glass.AddMaterial("glass", ClearGlass(1.5f));
    const uint32_t water = water_in_glass.AddMaterial("water", ClearGlass(1.33f));
    water_in_glass.AddSphere({0, 0, 0}, 1, glass, 24);
    water_in_glass.AddSphere({0, 0, 0}, 0.5f, water, 24);
    EXPECT_NEAR(weight(water_in_glass, 4), std::pow(0.96, 2) * std::pow(1 - F0(1.5f, 1.33f), 2), kTolerance);
  }
  {
    SceneBuilder hollow;  // the inner surface faces the bubble, outside the glass
    const uint32_t glass = hollow.AddMaterial("glass", ClearGlass(1.5f));
    hollow.AddSphere({0, 0, 0}, 1, glass, 24);
    hollow.AddSphere({0, 0, 0}, 0.8f, glass, 24, /*inward=*/true);
    EXPECT_NEAR(weight(hollow, 4), std::pow(0.96, 4), kTolerance);
  }
  {
    SceneBuilder overlapping;  // two balls of one glass: what they share is one body
    const uint32_t glass = overlapping.AddMaterial("glass", ClearGlass(1.5f));
    const uint32_t same = overlapping.AddMaterial("same", ClearGlass(1.5f));
    overlapping.AddSphere({0, 0, 0}, 1, glass, 24);
    overlapping.AddSphere({1, 0, 0}, 1, same, 24);
    EXPECT_NEAR(weight(overlapping, 4), std::pow(0.96, 2), kTolerance);
  }
  {
    SceneBuilder pane_inside;
    pane_inside.AddSphere({0, 0, 0}, 1, pane_inside.AddMaterial("glass", ClearGlass(1.5f)), 24);
    const uint32_t pane = pane_inside.AddMaterial("pane", Pane(1.5f), Rgb::Zero(), true);
    pane_inside.AddQuad({0, -0.5f, -0.5f}, {0, -0.5f, 0.5f}, {0, 0.5f, 0.5f}, {0, 0.5f, -0.5f}, pane);
    EXPECT_NEAR(weight(pane_inside, 3), std::pow(0.96, 3), kTolerance);
  }
}

TEST(SpecularSurfacesTest, AWayThatBeginsInsideLeavesAndIsAttenuated) {
  SceneBuilder b;
  MetallicRoughness m = ClearGlass(1.5f);
  m.attenuation_color = Rgb(0.5f, 1, 1);
  m.attenuation_distance = 1;
  b.AddBox({-1, -1, -1}, {1, 1, 1}, b.AddMaterial("glass", m));
  const Way way = FollowTransmission(b.Build(), {{0, 0.5f, 0.2f}, 0, Vec3::UnitY(), kFar});
  EXPECT_EQ(way.crossings, 1);
  EXPECT_NEAR(way.weight[0], 0.96f * 1.5f * 1.5f * std::sqrt(0.5f), 1e-5);
  EXPECT_NEAR(way.weight[1], 0.96f * 1.5f * 1.5f, 1e-5) << "radiance in glass is n^2 times that outside";
}

TEST(SpecularSurfacesTest, ABallOfIndexOneIsInvisible) {
  SceneBuilder b;
  b.AddSphere({0, 0, 0}, 1, b.AddMaterial("nothing", ClearGlass(1)), 12);
  const Scene scene = b.Build();
  RandomDirections random(23);
  int met = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 from = 3 * random.Direction(), to = random.Between(0, 0.99f) * random.Direction();
    const Vec3 direction = (to - from).normalized();
    const Way way = FollowTransmission(scene, {from, 0, direction, kFar});
    met += way.crossings == 2;
    EXPECT_TRUE((way.weight == 1).all());
    EXPECT_LT((way.ray.direction - direction).norm(), 1e-3);  // grazing is put just beyond the face
  }
  EXPECT_GT(met, 450);
}

TEST(SpecularSurfacesTest, EndlessWaysAreClearInClearGlassAndBlackInColoured) {
  MetallicRoughness grey = ClearGlass(1.5f);
  grey.attenuation_color = Rgb(0.9f, 1, 1);
  grey.attenuation_distance = 1;
  const auto s = Surfaces({ClearGlass(1.5f), grey});
  EXPECT_TRUE((s.Transmittance(Inside({0}), kNone, Side::kFront, kFar) == 1).all());
  EXPECT_TRUE((s.Transmittance(Inside({1}), kNone, Side::kFront, kFar) == Rgb(0, 1, 1)).all());
  EXPECT_TRUE((s.Transmittance(MediaStack{}, kNone, Side::kFront, kFar) == 1).all());
}

// ---- Panes

TEST(SeeThroughTest, IsTheProductOverPanesOfWhatTheirCoatsAndColoursPass) {
  SceneBuilder b;
  const uint32_t clear = b.AddMaterial("clear", Pane(1.5f), Rgb::Zero(), true);
  const uint32_t green = b.AddMaterial("green", Pane(1.7f, Rgb(0.2f, 0.9f, 0.3f)), Rgb::Zero(), true);
  const auto quad = [&](float x, uint32_t m) {
    b.AddQuad({x, -9, -9}, {x, -9, 9}, {x, 9, 9}, {x, 9, -9}, m);  // fronts towards -x
  };
  quad(0, clear);
  quad(1, green);
  quad(2, clear);
  quad(5, b.AddLambert(Rgb::Constant(0.5f)));
  const Scene scene = b.Build();
  const RayTracer tracer(scene);
  const SpecularSurfaces specular(scene);
  const auto pass = [](float n, float cosine) {
    return (1 - F0(n, 1)) * (1 - std::pow(1 - cosine, 5.0f));  // f90 = 1
  };
  for (const Vec3& to : {Vec3(4, 0.3f, 0.1f), Vec3(4, 4, -3), Vec3(4.5f, -8, 8)}) {
    const Vec3 from(-1, 0.2f, 0.4f);
    const float cosine = (to - from).normalized().x();
    const Rgb expected = pass(1.5f, cosine) * pass(1.5f, cosine) * pass(1.7f, cosine) * Rgb(0.2f, 0.9f, 0.3f);
    EXPECT_LT((specular.SeeThrough(tracer, {from, 0, to - from, 1}) - expected).abs().maxCoeff(), 1e-5);
    EXPECT_LT((specular.SeeThrough(tracer, {to, 0, from - to, 1}) - expected).abs().maxCoeff(), 1e-5);
  }
  EXPECT_TRUE((specular.SeeThrough(tracer, {{-1, 0, 0}, 0, {8, 0, 0}, 1}) == 0).all()) << "a wall beyond";
  EXPECT_TRUE((specular.SeeThrough(tracer, {{-1, 0, 0}, 0, {0.9f, 0, 0}, 1}) == 1).all()) << "ends before";

  Ray ray{{-1, 0.3f, 0.2f}, 0, {2, 0, 0}, kFar};
  Rgb passed = Rgb::Constant(1);
  const RayHit hit = specular.IntersectPastPanes(tracer, &ray, &passed);
  ASSERT_TRUE(hit.hit());
  EXPECT_EQ(scene.faces[hit.face].material, 2u);
  EXPECT_NEAR((ray.origin + hit.t * ray.direction).x(), 5, 1e-5);
}

TEST(SeeThroughTest, EndsBehindMorePanesThanItFollows) {
  SceneBuilder b;
  MetallicRoughness nothing = Pane(1);
  const uint32_t clear = b.AddMaterial("clear", nothing, Rgb::Zero(), true);
  for (int i = 0; i < SpecularSurfaces::kMostPanes + 5; ++i) {
    const float x = 0.1f * float(i);
    b.AddQuad({x, -9, -9}, {x, -9, 9}, {x, 9, 9}, {x, 9, -9}, clear);
  }
  const Scene scene = b.Build();
  const RayTracer tracer(scene);
  const SpecularSurfaces specular(scene);
  const auto seen = [&](float x) {
    return specular.SeeThrough(tracer, {{-1, 0, 0}, 0, {x + 1, 0, 0}, 1})[0];
  };
  EXPECT_EQ(seen(0.1f * SpecularSurfaces::kMostPanes - 0.05f), 1);
  EXPECT_EQ(seen(0.1f * SpecularSurfaces::kMostPanes + 0.05f), 0);
}

TEST(SeeThroughTest, APaneModelledForBothSidesIsOnePane) {
  SceneBuilder b;
  const uint32_t clear = b.AddMaterial("clear", Pane(1.5f), Rgb::Zero(), true);
  b.AddQuad({0, -1, -1}, {0, -1, 1}, {0, 1, 1}, {0, 1, -1}, clear);
  b.AddQuad({0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}, clear);
  const Scene scene = b.Build();
  const RayTracer tracer(scene);
  const Rgb seen = SpecularSurfaces(scene).SeeThrough(tracer, {{-1, 0.1f, 0.2f}, 0, {2, 0, 0}, 1});
  EXPECT_NEAR(seen[0], 0.96f, 1e-6);
}

}  // namespace
}  // namespace lobe
