#include "scene/contacts.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <iostream>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "scene/ray_tracer.h"
#include "scene/tessellate.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

/// A few roundings of the coordinates used here, metres; what the cutter takes for one point.
constexpr double kSnap = 5e-5;

uint32_t Grey(SceneBuilder* b, bool double_sided = false) {
  return b->AddMaterial("grey", Lambert{Rgb::Constant(0.5f)}, Rgb::Zero(), double_sided);
}

/// 4 m x 4 m at height 0, seen from above, cut along the diagonal x = z.
uint32_t AddFloor(SceneBuilder* b, uint32_t material) {
  return b->AddQuad({-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}, material);
}

bool SameBits(const Scene& a, const Scene& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
  };
  if (!same(a.positions, b.positions) || !same(a.normals, b.normals)) return false;
  return std::equal(a.faces.begin(), a.faces.end(), b.faces.begin(), b.faces.end(),
                    [](const Face& x, const Face& y) {
                      return x.vertex == y.vertex && x.material == y.material && x.surface == y.surface &&
                             x.contact == y.contact;
                    });
}

double AreaOf(const Scene& scene, uint32_t surface) {
  double area = 0;
  for (const Face& f : scene.faces) {
    if (f.surface == surface) area += scene.Area(f);
  }
  return area;
}

using Place = std::array<float, 3>;
Place PlaceOf(const Scene& scene, uint32_t vertex) {
  const Vec3& p = scene.positions[vertex];
  return {p.x(), p.y(), p.z()};
}

double DistanceToSegment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

/// Rays see the same of both scenes.
void ExpectSameToRays(const Scene& before, const Scene& after, int rays = 20000) {
  const RayTracer old_tracer(before), new_tracer(after);
  const Eigen::AlignedBox3f bounds = before.Bounds();
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0, 1), sign(-1, 1);
  int hits = 0;
  for (int i = 0; i < rays; ++i) {
    const Vec3 from =
        bounds.min() - 0.2f * bounds.sizes() +
        Vec3(1.4f * bounds.sizes().cwiseProduct(Vec3(unit(random), unit(random), unit(random))));
    const Vec3 direction = Vec3(sign(random), sign(random), sign(random)).normalized();
    const Ray ray = {from, 0, direction, 1e6f};
    const RayHit a = old_tracer.Intersect(ray), b = new_tracer.Intersect(ray);
    ASSERT_EQ(a.hit(), b.hit()) << "ray " << i;
    if (!a.hit()) continue;
    ++hits;
    // A new vertex is off its face by a rounding, more along the ray where that grazes the face.
    const float cosine = std::abs(before.GeometricNormal(before.faces[a.face]).dot(direction));
    ASSERT_NEAR(a.t, b.t, 2e-6 * bounds.diagonal().norm() / std::max(cosine, 1e-3f)) << "ray " << i;
    // Of surfaces in one place either may come first by a rounding.
    if (before.faces[a.face].surface != after.faces[b.face].surface) continue;
    ASSERT_EQ(a.side, b.side) << "ray " << i;
    ASSERT_EQ(before.faces[a.face].material, after.faces[b.face].material);
  }
  EXPECT_GT(hits, rays / 100);
}

/// What holds for every cut of every scene of sound triangles.
void ExpectCutLaws(const Scene& before, const Scene& after) {
  ASSERT_GE(after.faces.size(), before.faces.size());
  ASSERT_EQ(after.positions.size(), after.normals.size());
  for (uint32_t s = 0; s < before.surface_names.size(); ++s) {
    const double area = AreaOf(before, s);
    // Of a thin triangle, what half a rounding along its border makes is more.
    double border = 0;
    for (const Face& f : before.faces) {
      const auto p = before.Corners(f);
      for (int k = 0; k < 3; ++k) border += f.surface == s ? (p[k] - p[(k + 1) % 3]).norm() : 0;
    }
    EXPECT_NEAR(AreaOf(after, s), area, 1e-6 * area + 3e-8 * border) << before.surface_names[s];
  }
  for (const Vec3& n : after.normals) ASSERT_NEAR(n.norm(), 1, 1e-5);
  std::map<uint32_t, std::vector<Vec3>> normals;  // by surface
  for (const Face& f : before.faces) normals[f.surface].push_back(before.GeometricNormal(f));

  std::map<uint32_t, std::set<Place>> places;
  std::map<std::pair<Place, Place>, int> contact_edges;
  for (const Face& f : after.faces) {
    const Vec3 n = after.GeometricNormal(f);
    float nearest = -1;
    for (const Vec3& m : normals[f.surface]) nearest = std::max(nearest, m.dot(n));
    ASSERT_GT(nearest, 0.999f) << "a piece turned over or without area";
    for (int k = 0; k < 3; ++k) {
      places[f.surface].insert(PlaceOf(after, f.vertex[k]));
      if (f.contact >> k & 1) {
        ++contact_edges[std::minmax(PlaceOf(after, f.vertex[k]), PlaceOf(after, f.vertex[(k + 1) % 3]))];
      }
    }
  }
  for (const auto& [edge, count] : contact_edges) EXPECT_GE(count, 2) << "marked on one side only";

  // No vertex of a surface in the middle of an edge of it.
  for (const Face& f : after.faces) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t v = f.vertex[k], w = f.vertex[(k + 1) % 3];
      const Vec3d a = after.positions[v].cast<double>(), b = after.positions[w].cast<double>();
      for (const Place& place : places[f.surface]) {
        const Vec3d p = Vec3(place[0], place[1], place[2]).cast<double>();
        if (p == a || p == b) continue;
        ASSERT_GT(DistanceToSegment(p, a, b), 1e-6) << "T-junction in " << after.surface_names[f.surface];
      }
    }
  }
}

/// Elements of `surface` do not lie on both sides of the line from a to b, and have no nodes in common
/// across it, but for its ends.
void ExpectParted(const Mesh& mesh, uint32_t surface, const Vec3& a, const Vec3& b) {
  const Vec3d from = a.cast<double>(), along = (b - a).cast<double>();
  std::array<std::set<uint32_t>, 2> nodes;
  int on_line = 0;
  for (uint32_t e = 0; e < mesh.element_count(); ++e) {
    const Mesh::Patch& patch = mesh.patches[mesh.element_patch[e]];
    if (patch.surface != surface || patch.side != Side::kFront) continue;
    std::array<Vec3d, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = mesh.node_position[mesh.elements[e][k]].cast<double>();
    const Vec3d normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    if (std::abs(normal.dot(along.normalized())) > 1e-3 || std::abs(normal.dot(from - p[0])) > 3e-3) continue;
    const Vec3d across = normal.cross(along).normalized();
    for (double t = 0.005; t < 1; t += 0.01) {
      const Vec3d x = from + t * along;
      double inside = 1e9;
      for (int k = 0; k < 3; ++k) {
        inside = std::min(inside, normal.cross(p[(k + 1) % 3] - p[k]).normalized().dot(x - p[k]));
      }
      ASSERT_LT(inside, kSnap) << "element " << e << " straddles the line at " << t;
    }
    const double side = across.dot((p[0] + p[1] + p[2]) / 3 - from);
    for (const uint32_t n : mesh.elements[e]) {
      const Vec3d q = mesh.node_position[n].cast<double>() - from;
      const double t = q.dot(along) / along.squaredNorm();
      if (std::abs(across.dot(q)) > kSnap || t < 0.001 || t > 0.999) continue;
      nodes[side > 0].insert(n);
      ++on_line;
    }
  }
  EXPECT_GT(on_line, 0) << "no nodes on the line";
  for (const uint32_t n : nodes[0]) EXPECT_FALSE(nodes[1].contains(n)) << "node " << n << " on both sides";
}

int Patches(const Mesh& mesh, uint32_t surface, Side side = Side::kFront) {
  int count = 0;
  for (const Mesh::Patch& p : mesh.patches) count += p.surface == surface && p.side == side;
  return count;
}

TEST(ContactsTest, BoxOnAFloorPartsTheFloorBeneathItFromTheRest) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  const uint32_t floor = AddFloor(&b, grey);
  b.AddBox({-0.3f, 0, -0.7f}, {0.9f, 1, 0.2f}, grey);
  const Scene before = b.Build();
  ContactReport report;
  const Scene after = CutAlongContacts(before, {}, &report);
  EXPECT_EQ(report.faces_cut, 2u) << "both halves of the floor, and nothing of the box";
  ExpectCutLaws(before, after);
  ExpectSameToRays(before, after);
  const Mesh mesh = Tessellate(after, {.max_edge = 0.25f});
  const std::array<Vec3, 4> foot = {Vec3(-0.3f, 0, -0.7f), Vec3(0.9f, 0, -0.7f), Vec3(0.9f, 0, 0.2f),
                                    Vec3(-0.3f, 0, 0.2f)};
  for (int k = 0; k < 4; ++k) ExpectParted(mesh, floor, foot[k], foot[(k + 1) % 4]);
  ASSERT_EQ(Patches(mesh, floor), 2);
  std::array<double, 2> area{};
  int patch_of_floor = 0;
  for (const Mesh::Patch& p : mesh.patches) {
    if (p.surface != floor) continue;
    for (uint32_t e = p.element_begin; e < p.element_end; ++e) area[patch_of_floor] += mesh.ElementArea(e);
    ++patch_of_floor;
  }
  EXPECT_NEAR(std::min(area[0], area[1]), 1.2 * 0.9, 1e-5);
}

TEST(ContactsTest, CornersOfAFootHaveANodeForEveryElementAroundThem) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  const uint32_t floor = AddFloor(&b, grey);
  b.AddBox({-0.3f, 0, -0.7f}, {0.9f, 1, 0.2f}, grey);
  const Mesh mesh = Tessellate(CutAlongContacts(b.Build()), {.max_edge = 0.25f});
  std::map<uint32_t, std::vector<Vec3>> around;  // by node at the corner
  for (uint32_t e = 0; e < mesh.element_count(); ++e) {
    if (mesh.patches[mesh.element_patch[e]].surface != floor) continue;
    Vec3 centroid = Vec3::Zero();
    for (const uint32_t n : mesh.elements[e]) centroid += mesh.node_position[n] / 3;
    if (centroid.x() > -0.3f && centroid.z() > -0.7f) continue;  // beneath
    for (const uint32_t n : mesh.elements[e]) {
      if (mesh.node_position[n] == Vec3(-0.3f, 0, -0.7f)) around[n].push_back(centroid);
    }
  }
  EXPECT_GE(around.size(), 3u);
  for (const auto& [node, centroids] : around) {
    ASSERT_EQ(centroids.size(), 1u);
    const Vec3 inset = mesh.node_sample_position[node] - mesh.node_position[node];
    EXPECT_GT(inset.normalized().dot((centroids[0] - mesh.node_position[node]).normalized()), 0.999f);
  }
}

TEST(ContactsTest, SunkenBoxCutsWhereItPassesThrough) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  const uint32_t floor = AddFloor(&b, grey);
  const uint32_t box = b.AddBox({-0.3f, -0.01f, -0.7f}, {0.9f, 1, 0.2f}, grey);
  const Scene before = b.Build(), after = CutAlongContacts(before);
  ExpectCutLaws(before, after);
  ExpectSameToRays(before, after);
  const Mesh mesh = Tessellate(after, {.max_edge = 0.25f});
  const std::array<Vec3, 4> foot = {Vec3(-0.3f, 0, -0.7f), Vec3(0.9f, 0, -0.7f), Vec3(0.9f, 0, 0.2f),
                                    Vec3(-0.3f, 0, 0.2f)};
  for (int k = 0; k < 4; ++k) {
    ExpectParted(mesh, floor, foot[k], foot[(k + 1) % 4]);
    ExpectParted(mesh, box, foot[k], foot[(k + 1) % 4]);
  }
  EXPECT_EQ(Patches(mesh, floor), 2);
}

TEST(ContactsTest, AbuttingBoxesCutEachOther) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  const uint32_t left = b.AddBox({-1, 0, -1}, {0, 1, 1}, grey);
  const uint32_t right = b.AddBox({0, 0.25f, -0.5f}, {1, 1.5f, 0.5f}, grey);
  const Scene before = b.Build(), after = CutAlongContacts(before);
  ExpectCutLaws(before, after);
  ExpectSameToRays(before, after);
  const Mesh mesh = Tessellate(after, {.max_edge = 0.25f});
  ExpectParted(mesh, left, {0, 0.25f, -0.5f}, {0, 0.25f, 0.5f});
  ExpectParted(mesh, left, {0, 0.25f, 0.5f}, {0, 1, 0.5f});
  ExpectParted(mesh, left, {0, 0.25f, -0.5f}, {0, 1, -0.5f});
  ExpectParted(mesh, right, {0, 1, -0.5f}, {0, 1, 0.5f});
}

TEST(ContactsTest, FrameAMillimetreOffAWallLeavesItsOutlineThere) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  const uint32_t wall = b.AddQuad({-2, 0, 0}, {2, 0, 0}, {2, 3, 0}, {-2, 3, 0}, grey);
  b.AddBox({-0.5f, 1, 0.001f}, {0.7f, 2, 0.031f}, grey);
  const Scene before = b.Build(), after = CutAlongContacts(before);
  ExpectCutLaws(before, after);
  ExpectSameToRays(before, after);
  const Mesh mesh = Tessellate(after, {.max_edge = 0.25f});
  const std::array<Vec3, 4> frame = {Vec3(-0.5f, 1, 0), Vec3(0.7f, 1, 0), Vec3(0.7f, 2, 0),
                                     Vec3(-0.5f, 2, 0)};
  for (int k = 0; k < 4; ++k) ExpectParted(mesh, wall, frame[k], frame[(k + 1) % 4]);
  EXPECT_EQ(Patches(mesh, wall), 2);

  EXPECT_TRUE(SameBits(CutAlongContacts(before, {.distance = 5e-4f}), before)) << "nearer than the frame is";
}

TEST(ContactsTest, WhatIsBehindABlackBackDoesNotCut) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  AddFloor(&b, grey);
  b.AddBox({-0.3f, -1, -0.7f}, {0.9f, -0.001f, 0.2f}, grey);
  const Scene below = b.Build();
  EXPECT_TRUE(SameBits(CutAlongContacts(below), below));

  SceneBuilder c;
  const uint32_t sheet = AddFloor(&c, Grey(&c, /*double_sided=*/true));
  c.AddBox({-0.3f, -1, -0.7f}, {0.9f, -0.001f, 0.2f}, 0);
  const Scene cut = CutAlongContacts(c.Build());
  const Mesh mesh = Tessellate(cut, {.max_edge = 0.25f});
  EXPECT_EQ(Patches(mesh, sheet, Side::kBack), 2);
}

TEST(ContactsTest, ThinWallInTheMiddleOfAFloorPartsItsSidesAndLeavesItConnectedAroundTheEnds) {
  for (const bool double_sided : {false, true}) {
    SceneBuilder b;
    const uint32_t grey = Grey(&b), thin = Grey(&b, true);
    const uint32_t floor = AddFloor(&b, double_sided ? thin : grey);
    // Its foot crosses the floor's diagonal.
    b.AddQuad({-0.8f, 0, 0.1f}, {0.9f, 0, 0.1f}, {0.9f, 1, 0.1f}, {-0.8f, 1, 0.1f}, thin);
    const Scene before = b.Build(), after = CutAlongContacts(before);
    ExpectCutLaws(before, after);
    ExpectSameToRays(before, after);
    for (const float edge : {0.25f, 5.0f}) {
      const Mesh mesh = Tessellate(after, {.max_edge = edge});
      ExpectParted(mesh, floor, {-0.8f, 0, 0.1f}, {0.9f, 0, 0.1f});
      EXPECT_EQ(Patches(mesh, floor), 1);
    }
  }
}

TEST(ContactsTest, LineOfOneEdgeStillPartsItsSides) {
  // Within one of the floor's triangles, and exactly along the diagonal between them.
  const std::array<std::pair<Vec3, Vec3>, 2> feet = {std::pair(Vec3(0.2f, 0, 1), Vec3(1, 0, 1.2f)),
                                                     std::pair(Vec3(-0.5f, 0, 0.5f), Vec3(1, 0, -1))};
  for (const auto& [p, q] : feet) {
    SceneBuilder b;
    const uint32_t floor = AddFloor(&b, Grey(&b));
    b.AddQuad(p, q, q + Vec3::UnitY(), p + Vec3::UnitY(), Grey(&b, true));
    const Scene before = b.Build(), after = CutAlongContacts(before);
    ExpectCutLaws(before, after);
    ExpectSameToRays(before, after);
    const Mesh mesh = Tessellate(after, {.max_edge = 10});
    ExpectParted(mesh, floor, p, q);
    EXPECT_EQ(Patches(mesh, floor), 1);
  }
}

TEST(ContactsTest, WallAlongTheEdgesOfAGridPartsThemWithoutACut) {
  for (const int cells : {1, 3}) {  // of the grid under the wall
    SceneBuilder b;
    const uint32_t grey = Grey(&b);
    std::vector<Vec3> positions, normals;
    std::vector<std::array<uint32_t, 3>> triangles;
    for (int z = 0; z <= 4; ++z) {
      for (int x = 0; x <= 5; ++x) {
        positions.push_back(Vec3(float(x), 0, float(-z)));
        normals.push_back(Vec3::UnitY());
        const uint32_t v = uint32_t(6 * z + x);
        if (x == 5 || z == 4) continue;
        triangles.push_back({v, v + 1, v + 7});
        triangles.push_back({v, v + 7, v + 6});
      }
    }
    const uint32_t floor = b.AddMesh(positions, normals, triangles, grey);
    b.AddQuad({1, 0, -2}, {1 + float(cells), 0, -2}, {1 + float(cells), 1, -2}, {1, 1, -2}, Grey(&b, true));
    const Scene before = b.Build();
    ContactReport report;
    const Scene after = CutAlongContacts(before, {}, &report);
    ExpectCutLaws(before, after);
    if (cells > 1) {
      EXPECT_EQ(after.faces.size(), before.faces.size());
      EXPECT_EQ(report.faces_cut, 0u);
    }
    const Mesh mesh = Tessellate(after, {.max_edge = 10});
    ExpectParted(mesh, floor, {1, 0, -2}, {1 + float(cells), 0, -2});
    EXPECT_EQ(Patches(mesh, floor), 1);
  }
}

TEST(ContactsTest, CoplanarNeighboursNeedNoCutButAWallThatEndsOnThemDoes) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  const uint32_t left = b.AddQuad({-2, 0, 2}, {0, 0, 2}, {0, 0, -2}, {-2, 0, -2}, grey);
  b.AddQuad({0, 0, 2}, {2, 0, 2}, {2, 0, 0.3f}, {0, 0, 0.3f}, grey);
  b.AddQuad({0, 0, 0.3f}, {2, 0, 0.3f}, {2, 0, -2}, {0, 0, -2}, grey);
  const Scene floors = b.Build();
  EXPECT_TRUE(SameBits(CutAlongContacts(floors), floors));

  b.AddQuad({-2, 0, -0.5f}, {-1, 0, -0.5f}, {-1, 1, -0.5f}, {-2, 1, -0.5f}, grey);
  const Scene before = b.Build(), after = CutAlongContacts(before);
  ExpectCutLaws(before, after);
  ExpectParted(Tessellate(after, {.max_edge = 0.3f}), left, {-2, 0, -0.5f}, {-1, 0, -0.5f});
}

TEST(ContactsTest, HalfSunkenSphereCutsItsCircle) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  const uint32_t floor = AddFloor(&b, grey);
  b.AddSphere({0.13f, 0.04f, 0.07f}, 0.5f, grey, 12);
  const Scene before = b.Build(), after = CutAlongContacts(before);
  ExpectCutLaws(before, after);
  ExpectSameToRays(before, after);
  const Mesh mesh = Tessellate(after, {.max_edge = 0.25f});
  EXPECT_EQ(Patches(mesh, floor), 2);
  double inner = 1e9;
  for (const Mesh::Patch& p : mesh.patches) {
    if (p.surface != floor) continue;
    double area = 0;
    for (uint32_t e = p.element_begin; e < p.element_end; ++e) area += mesh.ElementArea(e);
    inner = std::min(inner, area);
  }
  // Chords of 12 segments enclose a little less than the circle.
  const double disc = M_PI * (0.25 - 0.04 * 0.04);
  EXPECT_LT(inner, disc);
  EXPECT_GT(inner, 0.95 * disc);
}

TEST(ContactsTest, ColumnOnAFloorLeavesFatElements) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  const uint32_t floor = AddFloor(&b, grey);
  constexpr int kSides = 32;
  for (int i = 0; i < kSides; ++i) {
    const auto at = [](int k, float y) {
      return Vec3(0.2f * float(std::cos(2 * M_PI * k / kSides)), y,
                  -0.2f * float(std::sin(2 * M_PI * k / kSides)));
    };
    b.AddQuad(at(i, 0), at(i + 1, 0), at(i + 1, 1), at(i, 1), grey);
  }
  const Scene before = b.Build(), after = CutAlongContacts(before);
  ExpectCutLaws(before, after);
  int floor_faces = 0, thin = 0;
  for (const Face& f : after.faces) {
    if (f.surface != floor) continue;
    const auto p = after.Corners(f);
    double longest = 0;
    for (int k = 0; k < 3; ++k) longest = std::max<double>(longest, (p[k] - p[(k + 1) % 3]).norm());
    ++floor_faces;
    thin += 2 * after.Area(f) / (longest * longest) < 0.15;  // height over longest edge
  }
  EXPECT_LT(floor_faces, 300);
  // Those at the floor's diagonal, which is the border of both its triangles.
  EXPECT_LT(thin, floor_faces / 8);
}

TEST(ContactsTest, SheetsModelledForBothSidesAreCutAlike) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  AddFloor(&b, grey);
  b.AddQuad({-2, 0, 2}, {-2, 0, -2}, {2, 0, -2}, {2, 0, 2}, grey);  // the same corners, seen from below
  b.AddBox({-0.3f, 0, -0.7f}, {0.9f, 1, 0.2f}, grey);
  const Scene before = b.Build(), after = CutAlongContacts(before);
  ExpectCutLaws(before, after);
  // Each side shows its front everywhere, which rays decide by equal corners.
  const RayTracer tracer(after);
  for (const float y : {-1.0f, 1.5f}) {
    for (float x = -1.9f; x < 2; x += 0.113f) {
      for (float z = -1.9f; z < 2; z += 0.117f) {
        const RayHit hit = tracer.Intersect({{x, y, z}, 0, {0, -y, 0}, 10});
        ASSERT_TRUE(hit.hit());
        EXPECT_EQ(hit.side, Side::kFront);
      }
    }
  }
}

TEST(ContactsTest, ScenesWithoutContactsComeBackBitForBit) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  b.AddBox({-2, 0, -2}, {2, 3, 2}, grey, /*inward=*/true);
  b.AddQuad({-0.5f, 2.98f, -0.5f}, {0.5f, 2.98f, -0.5f}, {0.5f, 2.98f, 0.5f}, {-0.5f, 2.98f, 0.5f}, grey);
  b.AddSphere({0, 1, 0}, 0.5f, grey);
  b.AddSphere({1.2f, 1, 0}, 0.02f, grey, 24);  // with edges about as long as the distance
  // Walls as quads of their own around the room, as the Cornell box has them.
  b.AddQuad({4, 0, 0}, {5, 0, 0}, {5, 0, -1}, {4, 0, -1}, grey);
  b.AddQuad({4, 0, -1}, {5, 0, -1}, {5, 1, -1}, {4, 1, -1}, grey);
  b.AddQuad({4, 0, 0}, {4, 0, -1}, {4, 1, -1}, {4, 1, 0}, grey);
  const Scene scene = b.Build();
  ContactReport report;
  EXPECT_TRUE(SameBits(CutAlongContacts(scene, {}, &report), scene));
  EXPECT_EQ(report.lines, 0u);
}

TEST(ContactsTest, DistanceZeroCutsNothing) {
  SceneBuilder b;
  AddFloor(&b, Grey(&b));
  b.AddBox({-0.3f, -0.1f, -0.7f}, {0.9f, 1, 0.2f}, 0);
  const Scene scene = b.Build();
  EXPECT_TRUE(SameBits(CutAlongContacts(scene, {.distance = 0}), scene));
}

/// Triangles through each other in all directions, in a room.
Scene Soup(int count, unsigned seed) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  b.AddBox({-1, -1, -1}, {1, 1, 1}, grey, /*inward=*/true);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  for (int i = 0; i < count; ++i) {
    const Vec3 p = 0.9f * point();
    b.AddTriangle(p, p + 0.5f * point(), p + 0.5f * point(), grey);
  }
  return b.Build();
}

TEST(ContactsTest, SoupKeepsItsAreaAndLooksTheSame) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Scene before = Soup(60, seed), after = CutAlongContacts(before);
    EXPECT_GT(after.faces.size(), 3 * before.faces.size());
    ExpectCutLaws(before, after);
    ExpectSameToRays(before, after);
  }
}

TEST(ContactsTest, ClosedRoomStaysClosed) {
  const Scene scene = CutAlongContacts(Soup(60, 4));
  const RayTracer tracer(scene);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1, 1);
  // At vertices and edges of the cut walls in particular.
  int aimed = 0;
  for (const Face& f : scene.faces) {
    if (f.surface != 0) continue;
    const auto p = scene.Corners(f);
    for (int k = 0; k < 3; ++k) {
      for (const float t : {0.0f, 0.5f, 0.37f}) {
        const Vec3 target = p[k] + t * (p[(k + 1) % 3] - p[k]);
        const Vec3 from = 0.95f * Vec3(unit(random), unit(random), unit(random));
        ASSERT_TRUE(tracer.Intersect({from, 0, target - from, 1e6f}).hit());
        ++aimed;
      }
    }
  }
  EXPECT_GT(aimed, 1000);
}

TEST(ContactsTest, GivesTheSameBitsForAnyNumberOfThreadsAndEveryTime) {
  const Scene before = Soup(80, 9), once = CutAlongContacts(before);
  EXPECT_TRUE(SameBits(CutAlongContacts(before), once));
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_TRUE(SameBits(CutAlongContacts(before), once));
}

TEST(ContactsTest, CuttingASecondTimeChangesNothingOfABoxOnAFloor) {
  SceneBuilder b;
  AddFloor(&b, Grey(&b));
  b.AddBox({-0.3f, 0, -0.7f}, {0.9f, 1, 0.2f}, 0);
  const Scene once = CutAlongContacts(b.Build());
  EXPECT_TRUE(SameBits(CutAlongContacts(once), once));
}

TEST(ContactsTest, CrowdedFaceKeepsItsLongestLinesAndWarns) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  const uint32_t floor = AddFloor(&b, grey);
  for (int i = 0; i < 40; ++i) {  // posts, all in one half of the floor
    const float x = -1.5f + 0.07f * float(i);
    b.AddTriangle({x, 0, 1.8f}, {x + 0.002f * float(i + 5), 0, 1.9f}, {x, 0.5f, 1.8f}, grey);
  }
  const Scene before = b.Build();
  ContactReport report;
  const Scene after = CutAlongContacts(before, {.max_lines = 10}, &report);
  EXPECT_EQ(report.crowded_faces, 1u);
  EXPECT_EQ(report.lines, 10u);
  ASSERT_EQ(after.warnings.size(), 1u);
  EXPECT_NE(after.warnings[0].find("1 face is touched"), std::string::npos) << after.warnings[0];
  ExpectCutLaws(before, after);
  const Mesh mesh = Tessellate(after, {.max_edge = 0.5f});
  ExpectParted(mesh, floor, {-1.5f + 0.07f * 39, 0, 1.8f}, {-1.5f + 0.07f * 39 + 0.002f * 44, 0, 1.9f});
}

TEST(ContactsTest, BadTrianglesNeitherHangNorCrash) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b, true);
  for (int i = 0; i < 5; ++i) AddFloor(&b, grey);                         // five in one place
  b.AddQuad({-2, 0, 2.5f}, {2, 0, 2}, {2.5f, 0, -2}, {-2, 0, -2}, grey);  // nearly the same
  b.AddTriangle({0, 0, 0}, {1, 0, 0}, {1, 0, 0}, grey);
  b.AddTriangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, grey);
  b.AddTriangle({-1, -1, 0}, {0, 0, 0}, {1, 1, 1e-30f}, grey);
  b.AddTriangle({-1, -1, 0}, {1, 1, 0}, {1, 1.00001f, 0}, grey);  // a needle
  std::mt19937 random(3);
  std::uniform_int_distribution<int> tick(-4, 4);
  for (int i = 0; i < 80; ++i) {  // on a lattice: everything touches, coincides, or is collinear
    const auto point = [&] {
      return Vec3(0.25f * float(tick(random)), tick(random) % 2 ? 0.0f : 0.25f * float(tick(random)),
                  0.25f * float(tick(random)));
    };
    b.AddTriangle(point(), point(), point(), grey);
  }
  const Scene before = b.Build(), after = CutAlongContacts(before);
  double area = 0, cut_area = 0;
  for (const Face& f : before.faces) area += before.Area(f);
  for (const Face& f : after.faces) cut_area += after.Area(f);
  EXPECT_NEAR(cut_area, area, 1e-5 * area);
  const Mesh mesh = Tessellate(after, {.max_edge = 0.5f});
  EXPECT_GT(mesh.element_count(), after.faces.size() / 2);
}

TEST(ContactsTest, FarFromTheOriginTouchesWithinItsRoundings) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  const Vec3 at(1000, 100, -2000);
  const uint32_t floor =
      b.AddQuad(at + Vec3(-2, 0, 2), at + Vec3(2, 0, 2), at + Vec3(2, 0, -2), at + Vec3(-2, 0, -2), grey);
  b.AddBox(at + Vec3(-0.3f, 0, -0.7f), at + Vec3(0.9f, 1, 0.2f), grey);
  const Scene after = CutAlongContacts(b.Build());
  EXPECT_EQ(Patches(Tessellate(after, {.max_edge = 0.5f}), floor), 2);
}

TEST(SlowContactsTest, HundredThousandFacesTakeASecondOrTwo) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  AddFloor(&b, grey);
  for (int i = 0; i < 25; ++i) {
    const Vec3 centre(-1.6f + 0.8f * float(i % 5), i % 2 ? 0.1f : 1.0f, -1.6f + 0.8f * float(i / 5));
    b.AddSphere(centre, 0.3f, grey, 45);
  }
  const Scene before = b.Build();
  ASSERT_GT(before.faces.size(), 190000u);
  const auto start = std::chrono::steady_clock::now();
  ContactReport report;
  const Scene after = CutAlongContacts(before, {}, &report);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::cout << before.faces.size() << " faces, " << report.lines << " lines: " << seconds << " s\n";
  EXPECT_GT(report.lines, 1000u);
  EXPECT_LT(seconds, 120) << "with sanitizers it takes 30 s; by all pairs it would be hours";
}

}  // namespace
}  // namespace lobe
