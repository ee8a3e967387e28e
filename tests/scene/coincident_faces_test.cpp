#include "scene/coincident_faces.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/coplanar_faces.h"
#include "scene/flat_triangle.h"
#include "scene/gltf_scene.h"
#include "scene/ray_tracer.h"
#include "tests/support/random_directions.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::RandomDirections;
using test::SceneBuilder;
using testing::HasSubstr;

constexpr float kFar = 1e30f;

Scene Resolved(Scene scene) {
  ResolveCoincidentFaces(&scene);
  return scene;
}

bool SameBits(const Scene& a, const Scene& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
  };
  return same(a.positions, b.positions) && same(a.normals, b.normals) && same(a.faces, b.faces) &&
         a.materials.size() == b.materials.size() && a.warnings == b.warnings;
}

/// Of the sides that emit.
double EmittingArea(const Scene& scene) {
  double area = 0;
  for (const Face& f : scene.faces) {
    const Material& material = scene.material(f);
    area += scene.Area(f) * (int(material.emits()) + int(material.emits_behind()));
  }
  return area;
}

double AreaOf(const Scene& scene, uint32_t surface) {
  double area = 0;
  for (const Face& f : scene.faces) area += f.surface == surface ? scene.Area(f) : 0;
  return area;
}

/// A plane somewhere, and flat things on it by two coordinates.
struct Plane {
  Vec3 origin, x, y;
  Vec3 normal() const { return x.cross(y); }
  Vec3 At(float u, float v) const { return origin + u * x + v * y; }
  static Plane Random(RandomDirections* random, float away) {
    Plane plane;
    plane.origin = away * random->Direction();
    plane.x = random->Direction();
    plane.y = plane.x.cross(random->Direction()).normalized();
    return plane;
  }
};

/// Parallelograms in a plane, cut up in every way that exporters know.
void AddSheet(const Plane& plane, const Eigen::Vector2f& corner, const Eigen::Vector2f& a,
              const Eigen::Vector2f& b, int pattern, bool turned, uint32_t material, SceneBuilder* builder) {
  std::vector<Vec3> positions;
  std::vector<std::array<uint32_t, 3>> triangles;
  const auto add = [&](float s, float t) {
    const Eigen::Vector2f p = corner + s * a + t * b;
    positions.push_back(plane.At(p.x(), p.y()));
  };
  const auto quad = [&](std::array<uint32_t, 4> v, int diagonal) {
    triangles.push_back({v[diagonal], v[diagonal + 1], v[diagonal + 2]});
    triangles.push_back({v[diagonal], v[diagonal + 2], v[(diagonal + 3) % 4]});
  };
  if (pattern <= 2) {
    for (const auto& [s, t] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) add(float(s), float(t));
    if (pattern < 2) quad({0, 1, 2, 3}, pattern);
    if (pattern == 2) {
      add(0.4f, 0.7f);
      for (uint32_t i = 0; i < 4; ++i) triangles.push_back({i, (i + 1) % 4, 4});
    }
  } else {
    const uint32_t n = static_cast<uint32_t>(pattern);
    for (uint32_t i = 0; i <= n; ++i) {
      for (uint32_t j = 0; j <= n; ++j) add(float(i) / float(n), float(j) / float(n));
    }
    const auto at = [n](uint32_t i, uint32_t j) { return i * (n + 1) + j; };
    for (uint32_t i = 0; i < n; ++i) {
      for (uint32_t j = 0; j < n; ++j) {
        quad({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, int(i + j) % 2);
      }
    }
  }
  const bool flip = turned != (a.x() * b.y() - a.y() * b.x() < 0);
  if (flip) {
    for (auto& t : triangles) std::swap(t[1], t[2]);
  }
  // Any corner may come first.
  for (size_t i = 0; i < triangles.size(); ++i) {
    std::rotate(triangles[i].begin(), triangles[i].begin() + i % 3, triangles[i].end());
  }
  builder->AddMesh(positions,
                   std::vector<Vec3>(positions.size(), turned ? Vec3(-plane.normal()) : plane.normal()),
                   triangles, material);
}

/// The rule, point by point: the material seen at `p` from the side `up` points to; empty: only backs are
/// there; nothing: no face is there, or its border is too near to say.
std::optional<std::string> Expected(const Scene& scene, const Vec3& p, const Vec3& up) {
  std::optional<std::pair<bool, uint32_t>> best;
  bool any = false;
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    const FlatTriangle flat(scene.Corners(scene.faces[f]));
    constexpr double kBorder = 1e-3;
    if (!flat.LiesUnder(p.cast<double>(), kBorder)) continue;
    any = true;
    const Material& material = scene.material(scene.faces[f]);
    if (!material.double_sided && flat.normal.dot(up.cast<double>()) < 0) continue;
    best = std::max(best, std::optional(std::pair(material.emits(), f)));
  }
  if (best) return scene.material(scene.faces[best->second]).name;
  if (any) return "";
  return {};
}

bool NearABorder(const Scene& scene, const Vec3& p) {
  return std::any_of(scene.faces.begin(), scene.faces.end(), [&](const Face& face) {
    const FlatTriangle flat(scene.Corners(face));
    return flat.LiesUnder(p.cast<double>(), 1e-3) && !flat.LiesUnder(p.cast<double>(), -1e-3);
  });
}

/// Compares what rays meet with the rule, and looks for anything that is still there twice.
void ExpectTheRule(const Scene& before, const Plane& plane, RandomDirections* random, int* compared) {
  const Scene after = Resolved(before);
  const RayTracer tracer(after);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = plane.At(random->Between(-2, 2), random->Between(-2, 2));
    if (NearABorder(before, p)) continue;
    for (const float side : {1.0f, -1.0f}) {
      const Vec3 up = side * plane.normal();
      const auto expected = Expected(before, p, up);
      const Vec3 from = random->Above(up);
      if (from.dot(up) < 0.1f) continue;
      const RayHit hit = tracer.Intersect({p + from, 0, -from, kFar});
      ASSERT_EQ(hit.hit(), expected.has_value());
      if (!expected) continue;
      ++*compared;
      const Face& face = after.faces[hit.face];
      const bool black = hit.side == Side::kBack && !after.material(face).double_sided;
      EXPECT_EQ(black ? "" : after.material(face).name, *expected);
    }
  }
  // Whatever still shares a place is back to back.
  const CoplanarFaces left = FindCoplanarFaces(after);
  for (const auto& [f, g] : left.overlaps) ADD_FAILURE() << f << " overlaps " << g;
  for (uint32_t f = 0; f < left.first.size(); ++f) {
    if (left.first[f] == f) continue;
    const Face &face = after.faces[f], &other = after.faces[left.first[f]];
    EXPECT_LT(after.GeometricNormal(face).dot(after.GeometricNormal(other)), 0);
    EXPECT_FALSE(after.material(face).double_sided || after.material(other).double_sided);
  }
}

class Sheets {
 public:
  explicit Sheets(uint32_t seed) : random_(seed) {}
  RandomDirections& random() { return random_; }
  uint32_t AddMaterial(SceneBuilder* b) {
    const bool emits = random_.Between(0, 1) < 0.3f, double_sided = random_.Between(0, 1) < 0.4f;
    return b->AddMaterial(std::string("m").append(std::to_string(count_++)), Lambert{Rgb::Constant(0.5f)},
                          Rgb::Constant(emits ? 1.0f : 0.0f), double_sided);
  }
  Eigen::Vector2f Point() { return {random_.Between(-1, 1), random_.Between(-1, 1)}; }

 private:
  RandomDirections random_;
  int count_ = 0;
};

// All windings, orders of corners, ways to cut a quad, sides, orders in the file, in any plane.
TEST(CoincidentFacesTest, SheetsExportedTwiceShowTheEmitterElseTheLater) {
  int compared = 0;
  for (uint32_t seed = 0; seed < 150; ++seed) {
    Sheets sheets(seed);
    const Plane plane = Plane::Random(&sheets.random(), seed % 3 ? 3 : 100);
    SceneBuilder b;
    const int count = 2 + int(seed % 3);
    for (int i = 0; i < count; ++i) {
      const int pattern = int(sheets.random().Between(0, 4.99f));
      AddSheet(plane, {-1, -1}, {2.1f, 0.3f}, {-0.2f, 1.9f}, pattern, sheets.random().Between(0, 1) < 0.5f,
               sheets.AddMaterial(&b), &b);
    }
    ExpectTheRule(b.Build(), plane, &sheets.random(), &compared);
    ASSERT_FALSE(HasFailure()) << "seed " << seed;
  }
  EXPECT_GT(compared, 10000);
}

TEST(CoincidentFacesTest, SheetsThatOverlapInPartShowTheEmitterElseTheLater) {
  int compared = 0;
  for (uint32_t seed = 0; seed < 300; ++seed) {
    Sheets sheets(seed);
    const Plane plane = Plane::Random(&sheets.random(), seed % 3 ? 3 : 100);
    SceneBuilder b;
    const int count = 2 + int(seed % 4);
    for (int i = 0; i < count; ++i) {
      const int pattern = int(sheets.random().Between(0, 4.99f));
      AddSheet(plane, sheets.Point(), sheets.Point(), sheets.Point(), pattern,
               sheets.random().Between(0, 1) < 0.5f, sheets.AddMaterial(&b), &b);
    }
    ExpectTheRule(b.Build(), plane, &sheets.random(), &compared);
    ASSERT_FALSE(HasFailure()) << "seed " << seed;
  }
  EXPECT_GT(compared, 5000);
}

// A lamp's light is that of one lamp, whichever way it is there twice.
TEST(CoincidentFacesTest, ALampExportedTwiceEmitsOnce) {
  RandomDirections random(3);
  const Plane plane = Plane::Random(&random, 3);
  for (const bool double_sided : {false, true}) {
    for (int pattern = 0; pattern < 5; ++pattern) {
      for (const bool turned : {false, true}) {
        SceneBuilder b;
        const uint32_t lamp = b.AddMaterial("lamp", Lambert{Rgb::Zero()}, Rgb::Constant(1), double_sided);
        AddSheet(plane, {0, 0}, {1, 0.2f}, {0, 2}, 0, false, lamp, &b);
        AddSheet(plane, {0, 0}, {1, 0.2f}, {0, 2}, pattern, turned, lamp, &b);
        const Scene scene = Resolved(b.Build());
        // Single-sided lamps back to back are two lamps.
        EXPECT_NEAR(EmittingArea(scene), double_sided || turned ? 4 : 2, 1e-5);
        ASSERT_EQ(scene.warnings.size(), !double_sided && turned ? 0 : 1);
        if (!scene.warnings.empty()) {
          EXPECT_THAT(scene.warnings[0], HasSubstr("'mesh 0' lies where 'mesh 1' does"));
        }
      }
    }
  }
}

TEST(CoincidentFacesTest, ALampInTheCeilingsPlaneMakesAHoleInIt) {
  const Scene scene = ReadGltfScene(LOBE_TEST_DATA "/scenes/lamp_in_ceiling_plane.glb");
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_THAT(scene.warnings[0], HasSubstr("'ceiling' lies where 'lamp' does (2 triangles)"));
  const auto surface = [&](const std::string& name) {
    return uint32_t(std::find(scene.surface_names.begin(), scene.surface_names.end(), name) -
                    scene.surface_names.begin());
  };
  const double lamp = AreaOf(scene, surface("lamp")), ceiling = AreaOf(scene, surface("ceiling"));
  EXPECT_NEAR(lamp, EmittingArea(scene), 1e-6);
  EXPECT_NEAR(lamp + ceiling, 12, 1e-5) << "4 m by 3 m";
}

TEST(CoincidentFacesTest, TheFileWithALampTwiceIsReadWithOne) {
  const Scene scene = ReadGltfScene(LOBE_TEST_DATA "/scenes/lamp_twice.glb");
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_THAT(scene.warnings[0], HasSubstr("'lamp' lies where 'lamp' does (2 triangles)"));
  EXPECT_EQ(std::count_if(scene.faces.begin(), scene.faces.end(),
                          [&](const Face& f) { return scene.material(f).emits(); }),
            2);
}

// Furniture on floors, boxes on boxes, rooms: what touches with its back alone is left as it is.
TEST(CoincidentFacesTest, WhatOnlyTouchesIsLeftAsItIs) {
  for (const char* name : {"cornell_diffuse", "glossy_floor", "lampshade", "glass_room"}) {
    const Scene scene = ReadGltfScene(std::string(LOBE_TEST_DATA "/scenes/") + name + ".glb");
    EXPECT_TRUE(SameBits(Resolved(scene), scene)) << name;
    EXPECT_TRUE(scene.warnings.empty()) << name;
  }
  for (const bool double_sided : {false, true}) {
    SceneBuilder b;
    const uint32_t grey = b.AddMaterial("grey", Lambert{Rgb::Constant(0.5f)}, Rgb::Zero(), double_sided);
    b.AddBox({0, 0, 0}, {1, 1, 1}, grey);
    b.AddBox({0.2f, 1, 0.3f}, {0.7f, 2, 0.8f}, grey);  // on it
    b.AddBox({1, 0, 0}, {2, 1, 1}, grey);              // beside it, corner to corner
    b.AddBox({0.5f, 2, 0.4f}, {1.5f, 3, 0.6f}, grey);  // over the edge
    EXPECT_TRUE(SameBits(Resolved(b.Build()), b.Build())) << double_sided;
  }
}

// From below one looks at the sheet: the box stands on its other side.
TEST(CoincidentFacesTest, AFootOnASheetIsCoveredByIt) {
  for (const bool box_first : {false, true}) {
    SceneBuilder b;
    const uint32_t sheet = b.AddMaterial("sheet", Lambert{Rgb::Constant(0.5f)}, Rgb::Zero(), true);
    const uint32_t box = b.AddMaterial("box", Lambert{Rgb::Constant(0.2f)}, Rgb::Constant(1));
    const auto add_box = [&] { b.AddBox({-0.5f, 0, -0.5f}, {0.5f, 1, 2}, box); };
    if (box_first) add_box();
    b.AddQuad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}, sheet);
    if (!box_first) add_box();
    const Scene before = b.Build(), scene = Resolved(before);
    EXPECT_TRUE(scene.warnings.empty());
    const RayTracer tracer(scene);
    const auto seen = [&](float x, float z) {
      const RayHit hit = tracer.Intersect({{x, -1, z}, 0, {0, 1, 0}, kFar});
      return scene.material(scene.faces[hit.face]).name;
    };
    EXPECT_EQ(seen(0.1f, 0.2f), "sheet");
    EXPECT_EQ(seen(0.1f, 1.5f), "box") << "over the edge";
    EXPECT_NEAR(EmittingArea(scene), EmittingArea(before) - 1.5, 1e-5);
    EXPECT_NEAR(AreaOf(scene, box_first ? 1 : 0), 4, 1e-6) << "whole, to be cut along contacts later";
  }
}

TEST(CoincidentFacesTest, TranslucentSheetsAndPanesAreSeenWholeOrNotAtAll) {
  MetallicRoughness paper;
  paper.metallic = 0;
  paper.diffuse_transmission = 0.5f;
  MetallicRoughness glass;
  glass.metallic = glass.roughness = 0;
  glass.transmission = 1;
  for (const MetallicRoughness& sheer : {paper, glass}) {
    for (const bool sheer_later : {false, true}) {
      SceneBuilder b;
      const uint32_t sheet = b.AddMaterial("sheet", sheer, Rgb::Zero(), true);
      const uint32_t wall = b.AddLambert(Rgb::Constant(0.5f));
      if (!sheer_later) b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, sheet);
      b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, wall);
      if (sheer_later) b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, sheet);
      const Scene scene = Resolved(b.Build());
      ASSERT_EQ(scene.faces.size(), 2u);
      for (const Face& face : scene.faces) {
        EXPECT_EQ(face.material, sheer_later ? sheet : wall);
        EXPECT_EQ(scene.material(face).double_sided, sheer_later);
      }
    }
    // Modelled from both sides it is one sheet, and nothing is amiss.
    SceneBuilder b;
    const uint32_t sheet = b.AddMaterial("sheet", sheer, Rgb::Zero(), true);
    b.AddMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {3, Vec3::UnitZ()}, {{0, 1, 2}, {0, 2, 1}}, sheet);
    const Scene scene = Resolved(b.Build());
    EXPECT_EQ(scene.faces.size(), 1u);
    EXPECT_TRUE(scene.warnings.empty());
  }
}

// Bodies may not be opened: light would never get out.
TEST(CoincidentFacesTest, SolidGlassIsLeftOutOnlyWhereItIsThereTwice) {
  MetallicRoughness glass;
  glass.metallic = glass.roughness = 0;
  glass.transmission = glass.thickness = 1;
  SceneBuilder b;
  const uint32_t solid = b.AddMaterial("glass", glass), grey = b.AddLambert(Rgb::Constant(0.5f));
  b.AddBox({0, 0, 0}, {1, 1, 1}, solid);
  b.AddBox({1, 0, 0}, {2, 1, 1}, solid);    // beside it
  b.AddBox({0, 0, 1}, {1, 1, 2}, grey);     // flush
  b.AddBox({-1, -1, -1}, {3, 0, 3}, grey);  // beneath
  const Scene apart = b.Build();
  EXPECT_TRUE(SameBits(Resolved(apart), apart));
  b.AddBox({0, 0, 0}, {1, 1, 1}, solid);
  const Scene twice = Resolved(b.Build());
  EXPECT_EQ(twice.faces.size(), apart.faces.size());
  ASSERT_EQ(twice.warnings.size(), 1u);
  EXPECT_THAT(twice.warnings[0], HasSubstr("'box 0' lies where 'box 4' does (12 triangles)"));
}

// Flush beams of one material look like one: no word, and one floor.
TEST(CoincidentFacesTest, FlushFacesOfOneMaterialAreToldOfOnlyIfOneIsGone) {
  SceneBuilder b;
  const uint32_t wood = b.AddLambert(Rgb::Constant(0.5f));
  b.AddBox({0, 0, 0}, {4, 0.2f, 1}, wood);
  b.AddBox({1, 0, -1}, {2, 0.2f, 3}, wood);
  const Scene scene = Resolved(b.Build());
  EXPECT_TRUE(scene.warnings.empty());
  double top = 0;
  for (const Face& face : scene.faces) {
    if (scene.GeometricNormal(face).y() > 0.5f) top += scene.Area(face);
  }
  EXPECT_NEAR(top, 4 + 4 - 1, 1e-5);
}

TEST(CoincidentFacesTest, ResolvingTwiceChangesNothing) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    Sheets sheets(seed);
    const Plane plane = Plane::Random(&sheets.random(), 3);
    SceneBuilder b;
    for (int i = 0; i < 4; ++i) {
      AddSheet(plane, sheets.Point(), sheets.Point(), sheets.Point(), i, i % 2, sheets.AddMaterial(&b), &b);
    }
    const Scene once = Resolved(b.Build());
    EXPECT_TRUE(SameBits(Resolved(once), once)) << "seed " << seed;
  }
}

// In processor time, as other programs may run; ten times what it takes.
TEST(CoincidentFacesTest, AHundredThousandPairsTakeBoundedTime) {
  RandomDirections random(7);
  for (const bool all_at_one_place : {false, true}) {
    std::vector<Vec3> positions;
    std::vector<std::array<uint32_t, 3>> triangles;
    for (uint32_t i = 0; i < 100000; ++i) {
      const Vec3 at = all_at_one_place ? Vec3::Zero() : Vec3(10 * random.Direction());
      const Vec3 x = all_at_one_place ? Vec3::UnitX() : Vec3(0.1f * random.Direction());
      const Vec3 y = all_at_one_place ? Vec3::UnitY() : Vec3(0.1f * random.Direction());
      for (const Vec3& p : {at, Vec3(at + x), Vec3(at + y)}) positions.push_back(p);
      triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
      triangles.push_back({3 * i + 1, 3 * i + 2, 3 * i});
    }
    SceneBuilder b;
    b.AddMesh(positions, std::vector<Vec3>(positions.size(), Vec3::UnitZ()), triangles,
              b.AddLambert(Rgb::Constant(0.5f)));
    Scene scene = b.Build();
    const std::clock_t start = std::clock();
    ResolveCoincidentFaces(&scene);
    EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 6);
    EXPECT_EQ(scene.faces.size(), all_at_one_place ? 1u : 100000u);
    EXPECT_EQ(scene.warnings.size(), 1u);
  }
}

}  // namespace
}  // namespace lobe
