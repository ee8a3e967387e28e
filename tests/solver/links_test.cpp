#include "solver/links.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "brdf/frame.h"
#include "scene/mirror.h"
#include "scene/tessellate.h"
#include "solver/exposure.h"
#include "solver/solution.h"
#include "tests/support/same_links.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

constexpr float kFar = std::numeric_limits<float>::infinity();

MetallicRoughness Mirror(const Rgb& colour, float metallic = 1) {
  MetallicRoughness r;
  r.base_color = colour;
  r.metallic = metallic;
  r.roughness = 0;
  return r;
}

// A scene with everything that Links wants.
struct Linked {
  Scene scene;
  RayTracer tracer;
  Mesh mesh;
  std::vector<MaterialLobes> materials;
  std::vector<Emitter> emitters;

  Linked(Scene s, float max_edge) : scene(std::move(s)), tracer(scene) {
    mesh = Tessellate(scene, {.max_edge = max_edge});
    TableCache cache;
    for (const auto& m : scene.materials) materials.emplace_back(m.reflectance, LobeOptions{}, cache);
    emitters = FindEmitters(scene);
  }
  Links Trace(const Links::Options& options = {}) const {
    return Links(scene, mesh, tracer, materials, options);
  }

  Mesh::Location Locate(const RayHit& hit) const { return mesh.Locate(hit.face, hit.side, hit.u, hit.v); }

  // The rays of a node's links, in their order.
  std::vector<Ray> Rays(uint32_t node, const Links& links) const {
    LinkDirections directions(links.pattern(mesh.node_patch[node]));
    directions.Start(node, links.seed());
    const int count = directions.pattern().count();
    std::vector<float> x(count), y(count), z(count);
    directions.World(Frame(mesh.node_normal[node]), x.data(), y.data(), z.data());
    const Vec3 from = mesh.node_sample_position[node] + mesh.node_sample_normal[node] * tracer.epsilon();
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) rays.push_back({from, 0, {x[i], y[i], z[i]}, kFar});
    return rays;
  }
};

// A closed room; a box that goes down through the floor, so floor nodes are inside it, and a ball.
Scene RoomWithASunkenBox() {
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  b.AddBox({0, 0, 0}, {3, 2.5f, 2.8f}, grey, true);
  b.AddBox({0.83f, -0.5f, 0.71f}, {1.77f, 1.1f, 1.66f}, grey);
  b.AddSphere({2.3f, 1.1f, 2.0f}, 0.4f, grey, 8);
  return b.Build();
}

// Running mean of a quantity whose expectation is 0.
struct Deviation {
  double sum = 0, sum2 = 0, count = 0;
  void Add(double x) {
    sum += x;
    sum2 += x * x;
    ++count;
  }
  double z() const { return sum / std::sqrt(std::max(sum2, 1e-300)); }
};

TEST(LinksTest, EndsCarryTheLinearLightOfAWallWithoutBias) {
  const Linked room(RoomWithASunkenBox(), 0.5f);
  const Links links = room.Trace({.links = 256});
  // The light of each wall is linear in position; hit points of links know what it should be.
  const auto light = [](const Vec3& p) { return 1 + 0.7 * p.x() - 0.4 * p.y() + 0.9 * p.z(); };
  Deviation all;
  double spread = 0;
  for (uint32_t n = 0; n < room.mesh.node_count(); ++n) {
    if (links.hidden()[n]) continue;
    const auto ends = links.of(n);
    const auto rays = room.Rays(n, links);
    for (size_t i = 0; i < ends.size(); ++i) {
      if (!Links::IsNode(ends[i])) continue;
      const auto& patch = room.mesh.patches[room.mesh.node_patch[ends[i]]];
      const RayHit hit = room.tracer.Intersect(rays[i]);
      const NodeWeights w = Interpolate(room.mesh, links.hidden(), room.Locate(hit));
      if (!patch.planar || w.count < 3) continue;
      const Vec3 at = rays[i].origin + hit.t * rays[i].direction;
      all.Add(light(room.mesh.node_position[ends[i]]) - light(at));
      spread += std::abs(light(room.mesh.node_position[ends[i]]) - light(at));
    }
  }
  EXPECT_GT(all.count, 1e5);
  EXPECT_GT(spread / all.count, 0.05) << "single links are off";
  EXPECT_LT(std::abs(all.z()), 4) << "their mean is not: " << all.sum / all.count;
  EXPECT_LT(std::abs(all.sum / all.count), 2e-3);
}

// Any light on the nodes, and hidden nodes among them: what links read is Interpolate's value on average,
// also within every class of elements by how many of their nodes are hidden.
TEST(LinksTest, EndsFollowTheRenormalisedWeightsAndNeverAreHidden) {
  const Linked room(RoomWithASunkenBox(), 0.45f);
  const Links links = room.Trace({.links = 1024});
  const auto& hidden = links.hidden();
  ASSERT_GT(std::count(hidden.begin(), hidden.end(), 1), 3) << "floor nodes inside the box";
  std::mt19937 bits(4);
  std::uniform_real_distribution<float> uniform;
  std::vector<float> light(room.mesh.node_count());
  for (float& l : light) l = uniform(bits);
  std::array<Deviation, 4> by_count;   // of nodes that are not hidden
  std::array<Deviation, 3> by_corner;  // chosen or not, against its weight
  Deviation larger_of_two;             // beside a hidden one: chosen or not, against its renormalised weight
  for (uint32_t n = 0; n < room.mesh.node_count(); ++n) {
    if (hidden[n]) continue;
    const auto ends = links.of(n);
    const auto rays = room.Rays(n, links);
    for (size_t i = 0; i < ends.size(); ++i) {
      if (ends[i] == Links::kBelow) {  // of the smooth things
        EXPECT_LE(rays[i].direction.dot(room.mesh.node_sample_normal[n]), 0);
        continue;
      }
      const RayHit hit = room.tracer.Intersect(rays[i]);
      if (!hit.hit()) {  // from under the floor
        EXPECT_EQ(ends[i], Links::kEscaped);
        continue;
      }
      const auto where = room.Locate(hit);
      if (where.element == kNone) {
        EXPECT_EQ(ends[i], Links::kBlocked);
        continue;
      }
      const auto& corners = room.mesh.elements[where.element];
      const NodeWeights w = Interpolate(room.mesh, hidden, where);
      if (w.count == 0) {
        EXPECT_EQ(ends[i], Links::kBlocked);
        continue;
      }
      ASSERT_TRUE(Links::IsNode(ends[i]));
      EXPECT_FALSE(hidden[ends[i]]);
      const auto corner = std::find(corners.begin(), corners.end(), ends[i]);
      if (corner == corners.end()) {
        // On the edge between two elements rounding may choose either.
        EXPECT_LT(*std::min_element(where.weight, where.weight + 3), 1e-4);
        continue;
      }
      double expected = 0;
      for (int k = 0; k < w.count; ++k) expected += w.weight[k] * light[w.node[k]];
      by_count[w.count].Add(light[ends[i]] - expected);
      if (w.count == 2) {
        const int larger = w.weight[0] >= w.weight[1] ? 0 : 1;
        larger_of_two.Add((ends[i] == w.node[larger]) - w.weight[larger]);
      }
      if (w.count < 3) continue;
      for (int k = 0; k < 3; ++k) by_corner[k].Add((corner - corners.begin() == k) - where.weight[k]);
    }
  }
  EXPECT_GT(by_count[2].count, 500);
  EXPECT_GT(by_count[3].count, 1e5);
  for (const int k : {2, 3}) EXPECT_LT(std::abs(by_count[k].z()), 4) << k << " nodes";
  EXPECT_LT(std::abs(larger_of_two.z()), 4) << larger_of_two.sum / larger_of_two.count;
  for (int k = 0; k < 3; ++k) EXPECT_LT(std::abs(by_corner[k].z()), 4) << "corner " << k;
}

// Half of the sky over the floor is a black back, the rest is open.
TEST(LinksTest, WhatEscapesAndWhatIsBlockedIsCounted) {
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  b.AddQuad({-0.5f, 0, -0.5f}, {-0.5f, 0, 0.5f}, {0.5f, 0, 0.5f}, {0.5f, 0, -0.5f}, grey);
  // Looks up: the floor sees its back.
  b.AddQuad({-0.5f, 1, -0.5f}, {-0.5f, 1, 0.5f}, {0.5f, 1, 0.5f}, {0.5f, 1, -0.5f}, grey);
  const Linked open(b.Build(), 0.1f);
  const Links links = open.Trace({.links = 512});
  double blocked = 0, escaped = 0, area_sum = 0;
  const auto area = NodeAreas(open.mesh, links.hidden());
  for (uint32_t n = 0; n < open.mesh.node_count(); ++n) {
    const auto ends = links.of(n);
    const auto rays = open.Rays(n, links);
    const bool floor = open.mesh.node_position[n].y() == 0;
    for (size_t i = 0; i < ends.size(); ++i) {
      EXPECT_TRUE(Links::IsLost(ends[i]));
      EXPECT_EQ(ends[i] == Links::kEscaped, !open.tracer.Intersect(rays[i]).hit());
      EXPECT_TRUE(floor || ends[i] == Links::kEscaped);
      if (floor) (ends[i] == Links::kBlocked ? blocked : escaped) += area[n] / double(ends.size());
    }
    if (floor) area_sum += area[n];
  }
  // Form factor of parallel unit squares one metre apart, 0.19982 (Howell C-11).
  EXPECT_NEAR(blocked / area_sum, 0.19982, 0.002);
  EXPECT_NEAR((blocked + escaped) / area_sum, 1, 1e-6);
  EXPECT_EQ(links.count(), links.rays());
  EXPECT_EQ(links.bytes(), 4 * links.count());
}

TEST(LinksTest, AreTheSameBitsForAnyNumberOfThreads) {
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  b.AddBox({0, 0, 0}, {3, 2.5f, 2.8f}, grey, true);
  b.AddBox({0.83f, -0.5f, 0.71f}, {1.77f, 1.1f, 1.66f}, b.AddMaterial("mirror", Mirror(Rgb::Constant(0.9f))));
  const Linked room(b.Build(), 0.3f);
  std::vector<std::unique_ptr<Links>> all;
  for (const int threads : {1, 2, 7}) {
    tbb::task_arena arena(threads);
    arena.execute([&] { all.push_back(std::make_unique<Links>(room.Trace({.links = 128}))); });
  }
  for (int i = 1; i < 3; ++i) test::ExpectSameLinks(*all[0], *all[i], room.mesh.node_count());
}

TEST(LinksTest, StopWhenToldAndSaySo) {
  const Linked room(RoomWithASunkenBox(), 0.3f);
  int asked = 0;
  const Links links(room.scene, room.mesh, room.tracer, room.materials, {},
                    [&](double) { return ++asked > 0; });
  EXPECT_TRUE(links.stopped());
  EXPECT_GE(asked, 1);
}

TEST(PackDirectionTest, IsOffByAtMostHalfAStepOfTheOctahedron) {
  std::mt19937 bits(8);
  std::normal_distribution<float> normal;
  std::vector<Vec3> directions;
  for (int i = 0; i < 300000; ++i) directions.push_back(Vec3(normal(bits), normal(bits), normal(bits)));
  // Axes, and the seams between octants.
  for (const float s : {-1.0f, 1.0f}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 d = Vec3::Zero();
      d[axis] = s;
      directions.push_back(d);
      for (const float t : {-1.0f, -0.3f, 1e-6f, 0.6f}) {
        d[(axis + 1) % 3] = t;
        directions.push_back(d);
        directions.push_back(d + Vec3(1e-7f, -1e-7f, 1e-7f));
      }
    }
  }
  double worst = 0;
  for (const Vec3& v : directions) {
    const Vec3 d = v.normalized(), back = UnpackDirection(PackDirection(d));
    EXPECT_NEAR(back.norm(), 1, 1e-6);
    worst = std::max(worst, (back.cast<double>() - d.cast<double>().normalized()).norm());
  }
  // sqrt(3 / 2) sqrt(3) / 32767.5, as the header derives, and reached.
  EXPECT_LT(worst, 6.5e-5);
  EXPECT_GT(worst, 6e-5);
}

// A room one of whose things is a mirror: every hop of every chain is followed again, in the plain way.
void ExpectChainsFollowMirrors(const Linked& room, const Links& links, bool curved) {
  int chains = 0, hops = 0, two = 0;
  for (uint32_t n = 0; n < room.mesh.node_count(); ++n) {
    const auto ends = links.of(n);
    const auto rays = room.Rays(n, links);
    for (size_t i = 0; i < ends.size(); ++i) {
      Ray ray = rays[i];
      RayHit hit = room.tracer.Intersect(ray);
      const auto is_mirror = [&](const RayHit& h) {
        return h.hit() && room.Locate(h).element != kNone &&
               room.materials[room.scene.faces[h.face].material].kind() == GlossKind::kMirror;
      };
      ASSERT_EQ(Links::IsChain(ends[i]), is_mirror(hit));
      if (!Links::IsChain(ends[i])) continue;
      ++chains;
      const Links::Hop* hop = links.chain(ends[i]);
      Eigen::Array3d product = Eigen::Array3d::Ones();
      for (int mirrors = 0;; ++mirrors) {
        const bool on = is_mirror(hit) && mirrors < Links::kMaxMirrors;
        const Material* material = hit.hit() ? &room.scene.material(room.scene.faces[hit.face]) : nullptr;
        const bool has_base = on && std::get<MetallicRoughness>(material->reflectance).metallic < 1;
        if (!on || has_base) {
          ++hops;
          two += mirrors >= 2;
          // 0.5 by rounding to 16 bits; the rest is ElementLocator's rounding in the normal of a curved
          // mirror.
          for (int c = 0; c < 3; ++c) ASSERT_NEAR(hop->fresnel[c], 65535 * product[c], curved ? 1.5 : 0.55);
          ASSERT_LT((UnpackDirection(hop->direction) + ray.direction).norm(), 6.6e-5);
          ASSERT_EQ(hop->last, !on);
          if (!hit.hit()) {
            ASSERT_EQ(hop->node, Links::kEscaped);
          } else if (room.Locate(hit).element == kNone) {
            ASSERT_EQ(hop->node, Links::kBlocked);
          } else if (Links::IsNode(hop->node)) {
            const auto& e = room.mesh.elements[room.Locate(hit).element];
            EXPECT_NE(std::find(e.begin(), e.end(), hop->node), e.end());
          }
          if (!on) break;
          ++hop;
        }
        const HitPoint at = FindHitPoint(room.scene, room.mesh, ray, hit, room.Locate(hit));
        const Vec3 wo = -ray.direction;
        product *= std::get<MetallicRoughness>(material->reflectance)
                       .Fresnel(std::clamp(wo.dot(at.normal), 0.0f, 1.0f))
                       .cast<double>();
        ray = {at.position + at.geometric_normal * room.tracer.epsilon(), 0, MirrorDirection(wo, at), kFar};
        hit = room.tracer.Intersect(ray);
      }
    }
  }
  EXPECT_GT(chains, 1000);
  EXPECT_GT(hops, chains - 1);
  EXPECT_GT(two, 0);
}

TEST(LinksTest, ChainsByPlanarMirrorsHaveTheFresnelProductAndTheWay) {
  SceneBuilder b;
  const uint32_t grey = b.AddLambert(Rgb::Constant(0.5f));
  b.AddBox({0, 0, 0}, {2, 2, 2}, grey, true);
  const uint32_t gold = b.AddMaterial("gold", Mirror(Rgb(1.0f, 0.78f, 0.34f)));
  const uint32_t varnish = b.AddMaterial("varnish", Mirror(Rgb(0.3f, 0.4f, 0.2f), 0));
  b.AddQuad({0.1f, 0.1f, 0.3f}, {0.1f, 1.9f, 0.3f}, {0.1f, 1.9f, 1.8f}, {0.1f, 0.1f, 1.8f}, gold);
  b.AddQuad({1.9f, 0.1f, 0.3f}, {1.9f, 0.1f, 1.8f}, {1.9f, 1.9f, 1.8f}, {1.9f, 1.9f, 0.3f}, varnish);
  const Linked room(b.Build(), 0.7f);
  ExpectChainsFollowMirrors(room, room.Trace({.links = 200}), false);
}

TEST(LinksTest, ChainsByCurvedMirrorsFollowInterpolatedNormals) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {2, 2, 2}, b.AddLambert(Rgb::Constant(0.5f)), true);
  const uint32_t steel = b.AddMaterial("steel", Mirror(Rgb(0.6f, 0.7f, 0.8f)));
  b.AddSphere({0.6f, 0.8f, 0.7f}, 0.4f, steel, 12);
  b.AddSphere({1.4f, 1.0f, 1.3f}, 0.4f, steel, 12);
  const Linked room(b.Build(), 0.7f);
  ExpectChainsFollowMirrors(room, room.Trace({.links = 200}), true);
}

TEST(LinksTest, WithoutFollowingMirrorsLinksEndOnThem) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {1, 1, 1}, b.AddMaterial("mirror", Mirror(Rgb::Constant(0.9f))), true);
  const Linked room(b.Build(), 0.5f);
  const Links links = room.Trace({.links = 64, .follow_mirrors = false});
  for (uint32_t n = 0; n < room.mesh.node_count(); ++n) {
    for (const uint32_t link : links.of(n)) EXPECT_TRUE(Links::IsNode(link));
  }
  EXPECT_EQ(links.rays(), links.count());
}

// A closed room of nothing but mirrors: every chain goes on to the last mirror, and says that it was cut.
TEST(LinksTest, ChainsAreCutAtTheMostMirrorsAndSaySo) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {1, 1.1f, 1.2f}, b.AddMaterial("mirror", Mirror(Rgb::Constant(0.9f))), true);
  const Linked room(b.Build(), 0.6f);
  const Links links = room.Trace({.links = 64});
  int chains = 0;
  for (uint32_t n = 0; n < room.mesh.node_count(); ++n) {
    for (const uint32_t link : links.of(n)) {
      ASSERT_TRUE(Links::IsChain(link));
      const Links::Hop* hop = links.chain(link);
      EXPECT_TRUE(hop->last) << "metal has no base: only the last is kept";
      EXPECT_TRUE(hop->cut);
      EXPECT_GE(hop->fresnel[0], uint16_t(65535 * std::pow(0.9, Links::kMaxMirrors)) - 1);
      ++chains;
    }
  }
  EXPECT_EQ(size_t(chains), links.count());
  EXPECT_EQ(links.rays(), links.count() * (1 + Links::kMaxMirrors));
}

// Who carries a lamp's light over how many mirrors: straight and over one planar mirror (if the lamp is
// small) by shooting, everything else by links.
TEST(LinksTest, EmissionOverOnePlanarMirrorIsLeftToShootingExactlyOnce) {
  for (const float size : {0.2f, 1.2f}) {
    SceneBuilder b;
    b.AddBox({0, 0, 0}, {2, 2, 2}, b.AddLambert(Rgb::Constant(0.5f)), true);
    const uint32_t mirror = b.AddMaterial("mirror", Mirror(Rgb::Constant(0.9f)));
    const uint32_t lamp = b.AddEmitter(Rgb::Constant(5));
    b.AddQuad({0.1f, 0, 0}, {0.1f, 2, 0}, {0.1f, 2, 2}, {0.1f, 0, 2}, mirror);
    b.AddQuad({1.9f, 0, 0}, {1.9f, 0, 2}, {1.9f, 2, 2}, {1.9f, 2, 0}, mirror);
    b.AddSphere({1, 0.5f, 1}, 0.3f, mirror, 8);
    const float lo = 1 - size / 2, hi = 1 + size / 2;
    b.AddQuad({lo, 1.9f, lo}, {hi, 1.9f, lo}, {hi, 1.9f, hi}, {lo, 1.9f, hi}, lamp);
    const Linked room(b.Build(), 0.5f);
    const auto mirrors = FindPlanarMirrors(room.mesh, room.materials, room.emitters);
    // Links leave out only what is shot: every emitter small against the mirror.
    ASSERT_EQ(mirrors.size(), size < 0.5f ? 2u : 0u);
    const Links links = room.Trace({.links = 3000, .planar_mirrors = mirrors});
    int once = 0, by_ball = 0, twice = 0;
    for (uint32_t n = 0; n < room.mesh.node_count(); ++n) {
      const auto ends = links.of(n);
      const auto rays = room.Rays(n, links);
      for (size_t i = 0; i < ends.size(); ++i) {
        if (!Links::IsChain(ends[i])) continue;
        const Links::Hop* hop = links.chain(ends[i]);
        while (!hop->last) ++hop;
        if (!Links::IsNode(hop->node)) continue;
        const bool on_lamp = room.mesh.patches[room.mesh.node_patch[hop->node]].material == lamp;
        if (!on_lamp) {
          EXPECT_FALSE(hop->emission);
          continue;
        }
        // Mirrors on the way: each takes 0.9 or more.
        Ray ray = rays[i];
        RayHit hit = room.tracer.Intersect(ray);
        const bool ball = !room.mesh.patches[room.mesh.element_patch[room.Locate(hit).element]].planar;
        const HitPoint at = FindHitPoint(room.scene, room.mesh, ray, hit, room.Locate(hit));
        ray = {at.position + at.geometric_normal * room.tracer.epsilon(), 0,
               MirrorDirection(-ray.direction, at), kFar};
        hit = room.tracer.Intersect(ray);
        const bool one = hit.hit() && room.scene.faces[hit.face].material == lamp;
        (!one ? twice : ball ? by_ball : once)++;
        const bool shot = one && !ball && size < 0.5f;
        EXPECT_EQ(hop->emission, !shot) << (one ? "one mirror" : "two") << (ball ? ", a ball" : ", flat");
      }
    }
    EXPECT_GT(once, 20) << size;
    EXPECT_GT(by_ball, 0) << size;
    EXPECT_GT(twice, 10) << size;
  }
}

// A link that meets a lamp straight on brings none of its emission: that is shot.
TEST(LinksTest, StraightEmissionIsNeverRead) {
  SceneBuilder b;
  b.AddBox({0, 0, 0}, {1, 1, 1}, b.AddEmitter(Rgb::Constant(1)), true);
  const Linked room(b.Build(), 0.5f);
  const Links links = room.Trace({.links = 64});
  for (uint32_t n = 0; n < room.mesh.node_count(); ++n) {
    for (const uint32_t link : links.of(n)) EXPECT_TRUE(Links::IsNode(link)) << "no chain, so no emission";
  }
}

}  // namespace
}  // namespace lobe
