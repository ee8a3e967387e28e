#include "scene/ray_tracer.h"

#include <algorithm>
#include <limits>
#include <random>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "scene/gltf_scene.h"
#include "tests/support/brute_force_tracer.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::BruteForceIntersect;
using test::SceneBuilder;

constexpr float kFar = std::numeric_limits<float>::infinity();

class Random {
 public:
  float Uniform() { return uniform_(bits_); }
  Vec3 Gauss() { return {normal_(bits_), normal_(bits_), normal_(bits_)}; }
  Vec3 Direction() { return Gauss().normalized(); }

 private:
  std::mt19937 bits_{7};
  std::uniform_real_distribution<float> uniform_;
  std::normal_distribution<float> normal_;
};

Scene Soup(int count, Random* random) {
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  for (int i = 0; i < count; ++i) {
    const Vec3 c = 2 * random->Gauss();
    b.AddTriangle(c + random->Gauss(), c + random->Gauss(), c + random->Gauss(), grey);
  }
  return b.Build();
}

Scene RoomWithThings() {
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  b.AddBox({-2, 0, -2}, {2, 3, 2}, grey, true);
  b.AddBox({-1, 0, -1}, {0.1f, 1.3f, 0.2f}, grey);
  b.AddSphere({1, 0.7f, 0.5f}, 0.6f, grey, 24);
  return b.Build();
}

bool Same(const RayHit& a, const RayHit& b) {
  return a.face == b.face && a.t == b.t && a.u == b.u && a.v == b.v && a.side == b.side;
}

// Which face is reported where two meet at one t is free; all else is as for one ray alone.
TEST(RayTracerTest, FansHitWhatSingleRaysHitButForTies) {
  Random random;
  const Scene room = RoomWithThings(), soup = Soup(300, &random);
  for (const Scene* scene : {&room, &soup}) {
    const RayTracer tracer(*scene);
    int hits = 0, ties = 0, misses = 0;
    for (const int count : {1, 7, 16, 17, 512}) {
      for (int fan = 0; fan < 20; ++fan) {
        const Vec3 origin(random.Uniform() - 0.5f, 1.4f + random.Uniform(), random.Uniform() - 0.5f);
        std::vector<float> x(count), y(count), z(count);
        for (int i = 0; i < count; ++i) {
          const Vec3 d = random.Direction();
          x[i] = d.x();
          y[i] = d.y();
          z[i] = d.z();
        }
        std::vector<RayHit> fanned(count);
        tracer.IntersectFan(origin, x.data(), y.data(), z.data(), fanned);
        for (int i = 0; i < count; ++i) {
          const RayHit single = tracer.Intersect({origin, 0, {x[i], y[i], z[i]}, kFar});
          ASSERT_EQ(fanned[i].hit(), single.hit());
          if (!single.hit()) {
            ++misses;
          } else if (fanned[i].face == single.face) {
            ++hits;
            EXPECT_TRUE(Same(fanned[i], single));
          } else {
            ++ties;
            EXPECT_NEAR(fanned[i].t, single.t, 1e-6f * single.t);
          }
        }
      }
    }
    EXPECT_GT(hits, 5000);
    EXPECT_LT(ties, hits / 1000);
    if (scene == &room) {
      EXPECT_EQ(misses, 0);
    }
  }
}

// With twins (both windings of a sheet) the hits are told apart one by one, without them in lanes.
TEST(RayTracerTest, PacketsHitWhatFansHit) {
  Random random;
  SceneBuilder sheets;
  const uint32_t grey = sheets.AddLambert(Rgb::Constant(0.5f));
  sheets.AddQuad({-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}, grey);
  sheets.AddQuad({-9, -9, -1}, {-9, 9, -1}, {9, 9, -1}, {9, -9, -1}, grey);
  const Scene soup = Soup(300, &random), twins = sheets.Build();
  for (const Scene* scene : {&soup, &twins}) {
    const RayTracer tracer(*scene);
    int hits = 0, backs = 0, misses = 0;
    for (int packet = 0; packet < 100; ++packet) {
      const Vec3 origin = random.Gauss();
      alignas(64) float x[kLanes], y[kLanes], z[kLanes];
      for (int i = 0; i < kLanes; ++i) {
        const Vec3 d = random.Direction();
        x[i] = d.x();
        y[i] = d.y();
        z[i] = d.z();
      }
      RayHit fanned[kLanes];
      PacketHits got;
      tracer.IntersectFan(origin, x, y, z, fanned);
      tracer.IntersectPacket(origin, x, y, z, &got);
      for (int i = 0; i < kLanes; ++i) {
        ASSERT_EQ(got.at(i).hit(), fanned[i].hit());
        hits += fanned[i].hit();
        misses += !fanned[i].hit();
        backs += fanned[i].hit() && fanned[i].side == Side::kBack;
        if (fanned[i].hit()) {
          EXPECT_TRUE(Same(got.at(i), fanned[i]));
        }
      }
    }
    EXPECT_GT(hits, 300);
    EXPECT_GT(misses, 100);
    EXPECT_EQ(backs > 100, scene == &soup);
  }
}

TEST(RayTracerTest, AgreesWithBruteForce) {
  Random random;
  const Scene scene = Soup(60, &random);
  const RayTracer tracer(scene);
  int hits = 0, backs = 0;
  for (int i = 0; i < 5000; ++i) {
    const Ray ray = {3 * random.Gauss(), 0.1f, random.Gauss(), 5};
    const RayHit expected = BruteForceIntersect(scene, ray), hit = tracer.Intersect(ray);
    EXPECT_EQ(tracer.Occluded(ray), hit.hit());
    if (hit.face != expected.face) {
      // Single and double precision may differ on an edge, or at the end of the ray, and nowhere else.
      const RayHit& of = expected.hit() ? expected : hit;
      const float edge = std::min({of.u, of.v, 1 - of.u - of.v});
      EXPECT_TRUE(edge < 1e-5f || of.t < 0.1f + 1e-5f || of.t > 5 - 1e-4f) << i;
      continue;
    }
    if (!hit.hit()) continue;
    ++hits;
    backs += hit.side == Side::kBack;
    EXPECT_EQ(hit.side, expected.side);
    // Coordinates of about 10 round by 1e-6; a ray that grazes multiplies that.
    const Vec3 n = scene.GeometricNormal(scene.faces[hit.face]);
    const float cosine = std::abs(n.dot(ray.direction.normalized()));
    const float length = ray.direction.norm();
    EXPECT_NEAR(hit.t * length, expected.t * length, 1e-5f / cosine);
    const auto p = scene.Corners(scene.faces[hit.face]);
    const Vec3 by_barycentrics = (1 - hit.u - hit.v) * p[0] + hit.u * p[1] + hit.v * p[2];
    EXPECT_LT((by_barycentrics - (ray.origin + hit.t * ray.direction)).norm(), 2e-5f / cosine);
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(backs, hits / 4);
}

TEST(RayTracerTest, SideIsFrontForCounterClockwise) {
  SceneBuilder b;
  b.AddTriangle({0.3f, 0.1f, 0}, {2.1f, 0.2f, 0.3f}, {0.2f, 1.7f, 0.4f}, b.AddLambert(Rgb::Zero()));
  const Scene scene = b.Build();
  const RayTracer tracer(scene);
  const auto p = scene.Corners(scene.faces[0]);
  const Vec3 inside = 0.5f * p[0] + 0.2f * p[1] + 0.3f * p[2];
  const Vec3 n = scene.GeometricNormal(scene.faces[0]);
  const RayHit front = tracer.Intersect({inside + 2 * n, 0, -n, kFar});
  ASSERT_TRUE(front.hit());
  EXPECT_EQ(front.side, Side::kFront);
  EXPECT_NEAR(front.t, 2, 1e-5);
  EXPECT_NEAR(front.u, 0.2, 1e-5);
  EXPECT_NEAR(front.v, 0.3, 1e-5);
  const RayHit back = tracer.Intersect({inside - 2 * n, 0, 4 * n, kFar});
  ASSERT_TRUE(back.hit());
  EXPECT_EQ(back.side, Side::kBack);
  EXPECT_NEAR(back.t, 0.5, 1e-5) << "t is in multiples of the direction";
}

TEST(RayTracerTest, PacketsEqualSinglesBitForBit) {
  Random random;
  for (const Scene& scene :
       {RoomWithThings(), Soup(300, &random), ReadGltfScene(LOBE_TEST_DATA "/scenes/glossy_floor.glb")}) {
    const RayTracer tracer(scene);
    const Vec3 centre = scene.Bounds().center();
    std::vector<Ray> rays;
    // A picture, rays everywhere, and rays at vertices and the middles of edges, where faces tie.
    for (int i = 0; i < 128 * 128; ++i) {
      rays.push_back({centre, 0, Vec3(i % 128 / 64.0f - 1, i / 128 / 64.0f - 1, -1), kFar});
    }
    for (int i = 0; i < 20001; ++i) {
      const auto p = scene.Corners(scene.faces[i % scene.faces.size()]);
      const Vec3 at = i % 2 ? p[0] : Vec3((p[1] + p[2]) * 0.5f);
      rays.push_back({centre, 0, i % 3 ? random.Direction() : Vec3(at - centre), i % 5 ? kFar : 1.5f});
    }
    std::vector<RayHit> singles(rays.size()), packets(rays.size());
    std::vector<uint8_t> occluded(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) singles[i] = tracer.Intersect(rays[i]);

    for (const bool coherent : {true, false}) {
      for (const size_t chunk : {rays.size(), size_t{1}, size_t{5}, size_t{16}, size_t{23}}) {
        for (size_t begin = 0; begin < rays.size(); begin += chunk) {
          const size_t n = std::min(chunk, rays.size() - begin);
          tracer.Intersect(std::span(rays).subspan(begin, n), std::span(packets).subspan(begin, n), coherent);
          tracer.Occluded(std::span(rays).subspan(begin, n), std::span(occluded).subspan(begin, n), coherent);
        }
        size_t different = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
          different += !Same(singles[i], packets[i]) || (occluded[i] != 0) != tracer.Occluded(rays[i]);
        }
        EXPECT_EQ(different, 0u) << "coherent " << coherent << ", chunks of " << chunk;
      }
    }
  }
}

TEST(RayTracerTest, LiftedOriginsDoNotMeetTheirOwnFace) {
  Random random;
  int met = 0, missed = 0, total = 0;
  for (int k = 0; k < 60; ++k) {
    SceneBuilder b;
    const float size = std::pow(10.0f, random.Gauss().x());
    const Vec3 c = 3 * random.Gauss();
    b.AddTriangle(c + size * random.Gauss(), c + size * random.Gauss(), c + size * random.Gauss(),
                  b.AddLambert(Rgb::Zero()));
    const Scene scene = b.Build();
    const RayTracer tracer(scene);
    const auto p = scene.Corners(scene.faces[0]);
    const Vec3 n = scene.GeometricNormal(scene.faces[0]);
    for (int i = 0; i < 500; ++i) {
      float u = random.Uniform(), v = random.Uniform();
      if (u + v > 1) std::tie(u, v) = std::pair(1 - u, 1 - v);
      const Vec3 point = (1 - u - v) * p[0] + u * p[1] + v * p[2];
      Vec3 d = random.Direction();
      d -= d.dot(n) * n;
      d = d.normalized() + std::pow(10.0f, -4 * random.Uniform()) * n;
      ++total;
      met += tracer.Occluded({point + tracer.epsilon() * n, 0, d, kFar});
      // And the lift is no more than it need be: from as far below, steep rays do meet it.
      if (std::min({u, v, 1 - u - v}) > 0.1f) {
        missed += !tracer.Occluded({point - tracer.epsilon() * n, 0, n, kFar});
      }
    }
  }
  EXPECT_EQ(met, 0) << "of " << total;
  EXPECT_EQ(missed, 0) << "of " << total;
}

// The end of a long ray is as uncertain as its beginning, however small and near the origin the face.
TEST(RayTracerTest, ASmallFaceDoesNotHideItselfFromAfar) {
  constexpr float kSize = 0.01f, kAway = 3000;
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  b.AddTriangle({0, 0, 0}, {0, 0, kSize}, {kSize, 0, 0}, grey);  // faces +y
  b.AddQuad({-kAway, -9, -kAway}, {-kAway, -9, kAway}, {kAway, -9, kAway}, {kAway, -9, -kAway}, grey);
  const Scene open = b.Build();
  // A lid as large as the face, one of its sizes above it.
  b.AddQuad({-kSize, kSize, -kSize}, {-kSize, kSize, 2 * kSize}, {2 * kSize, kSize, 2 * kSize},
            {2 * kSize, kSize, -kSize}, grey);
  const Scene lidded = b.Build();
  const RayTracer tracer(open), under_lid(lidded);
  const auto p = open.Corners(open.faces[0]);
  Random random;
  int hidden = 0, hidden_by_its_own_lift = 0, seen_through_the_lid = 0;
  constexpr int kRays = 5000;
  for (int i = 0; i < kRays; ++i) {
    float u = random.Uniform(), v = random.Uniform();
    if (u + v > 1) std::tie(u, v) = std::pair(1 - u, 1 - v);
    const Vec3 target = (1 - u - v) * p[0] + u * p[1] + v * p[2];
    Vec3 up = random.Direction();
    up.y() = std::abs(up.y()) + 1;  // not past the lid
    const Vec3 from = kAway * up.normalized();
    const auto ray = [&](float lift) {
      const Vec3 to = target + lift * Vec3::UnitY();
      return Ray{from, 0, to - from, 1};
    };
    hidden += tracer.Occluded(ray(tracer.LiftOfEnd(0, from)));
    hidden_by_its_own_lift += tracer.Occluded(ray(tracer.Lift(0)));
    seen_through_the_lid += !under_lid.Occluded(ray(under_lid.LiftOfEnd(0, from)));
  }
  EXPECT_EQ(hidden, 0) << "of " << kRays;
  EXPECT_GT(hidden_by_its_own_lift, kRays / 100) << "else this is no test";
  EXPECT_EQ(seen_through_the_lid, 0) << "of " << kRays;
  EXPECT_EQ(tracer.LiftOfEnd(0, {0, 1, 0}), tracer.Lift(0)) << "from nearby its own will do";
}

TEST(RayTracerTest, SealedRoomDoesNotLeak) {
  const Scene scene = RoomWithThings();
  const RayTracer tracer(scene);
  Random random;
  int leaks = 0;
  for (int i = 0; i < 20000; ++i) {
    // At edges and corners of the room in particular.
    Vec3 target(random.Uniform() < 0.5f ? -2.0f : 2.0f, 3 * random.Uniform(),
                random.Uniform() < 0.5f ? -2.0f : 2.0f);
    if (i % 4 == 0) target.y() = i % 8 ? 0.0f : 3.0f;
    const Vec3 eye(0.31f, 2.2f, -0.27f);
    leaks += !tracer.Intersect({eye, 0, i % 2 ? Vec3(target - eye) : random.Direction(), kFar}).hit();
  }
  EXPECT_EQ(leaks, 0);
}

TEST(RayTracerTest, OppositeTwinsShowTheirFrontsAndRepeatsTheFirst) {
  const Vec3 p0(0, 0, 0), p1(1, 0.1f, 0), p2(0.2f, 1, 0.3f);
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Zero());
  b.AddTriangle({0, 0, -5}, {1, 0, -5}, {0, 1, -5}, grey);
  b.AddTriangle(p0, p1, p2, grey);
  b.AddTriangle(p1, p2, p0, grey);
  b.AddTriangle(p0, p2, p1, grey);
  b.AddTriangle(p2, p1, p0, grey);
  const Scene scene = b.Build();
  const RayTracer tracer(scene);
  const Vec3 point = 0.5f * p0 + 0.2f * p1 + 0.3f * p2, n = scene.GeometricNormal(scene.faces[1]);
  for (const float from : {1.0f, -1.0f}) {
    const RayHit hit = tracer.Intersect({point + from * n, 0, -from * n, kFar});
    EXPECT_EQ(hit.face, from > 0 ? 1u : 3u);
    EXPECT_EQ(hit.side, Side::kFront);
    const auto p = scene.Corners(scene.faces[hit.face]);
    EXPECT_LT(((1 - hit.u - hit.v) * p[0] + hit.u * p[1] + hit.v * p[2] - point).norm(), 1e-6f);
  }
  EXPECT_EQ(tracer.Intersect({{0.2f, 0.2f, -4}, 0, {0, 0, -1}, kFar}).face, 0u);
}

// What goes through the one has to come out of it, so the other may not stand before its back.
TEST(RayTracerTest, ATranslucentSheetModelledTwiceIsOneSheet) {
  SceneBuilder b;
  MetallicRoughness paper;
  paper.metallic = 0;
  paper.diffuse_transmission = 0.5f;
  const uint32_t sheet = b.AddMaterial("paper", paper, Rgb::Zero(), true);
  b.AddTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, sheet);
  b.AddTriangle({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, sheet);
  const Scene scene = b.Build();
  const RayTracer tracer(scene);
  const RayHit front = tracer.Intersect({{0.2f, 0.3f, 1}, 0, {0, 0, -1}, kFar});
  const RayHit back = tracer.Intersect({{0.2f, 0.3f, -1}, 0, {0, 0, 1}, kFar});
  EXPECT_EQ(front.face, 0u);
  EXPECT_EQ(front.side, Side::kFront);
  EXPECT_EQ(back.face, 0u);
  EXPECT_EQ(back.side, Side::kBack);
}

TEST(RayTracerTest, RaysEndWhereTheyAreToldTo) {
  SceneBuilder b;
  b.AddQuad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, b.AddLambert(Rgb::Zero()));
  const RayTracer tracer(b.Build());
  const auto occluded = [&](float t_min, float t_max) {
    return tracer.Occluded({{0.1f, 0.2f, 1}, t_min, {0, 0, -1}, t_max});
  };
  EXPECT_TRUE(occluded(0, 1.001f));
  EXPECT_FALSE(occluded(0, 0.999f));
  EXPECT_FALSE(occluded(1.001f, kFar));
}

TEST(RayTracerTest, SceneWithoutFacesIsEmptySpace) {
  const RayTracer tracer{Scene{}};
  EXPECT_FALSE(tracer.Occluded({Vec3::Zero(), 0, Vec3::UnitX(), kFar}));
  EXPECT_FALSE(tracer.Intersect({Vec3::Zero(), 0, Vec3::UnitX(), kFar}).hit());
  EXPECT_EQ(tracer.epsilon(), 0);
}

}  // namespace
}  // namespace lobe
