#include "scene/tessellate.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "scene/gltf_scene.h"
#include "tests/support/input_errors.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::ExpectInputError;
using test::SceneBuilder;

Mesh WithEdge(const Scene& scene, float max_edge) { return Tessellate(scene, {.max_edge = max_edge}); }

uint32_t Grey(SceneBuilder* b, bool double_sided = false) {
  return b->AddMaterial("grey", Lambert{Rgb::Constant(0.5f)}, Rgb::Zero(), double_sided);
}

double MeshArea(const Mesh& mesh) {
  double area = 0;
  for (uint32_t e = 0; e < mesh.element_count(); ++e) area += mesh.ElementArea(e);
  return area;
}

/// Total length of edges that one element has and no other in the opposite direction.
double BorderLength(const Mesh& mesh) {
  std::set<std::pair<uint32_t, uint32_t>> edges;
  for (const auto& e : mesh.elements) {
    for (int k = 0; k < 3; ++k) edges.insert({e[k], e[(k + 1) % 3]});
  }
  double length = 0;
  for (const auto& [a, b] : edges) {
    if (!edges.contains({b, a})) length += (mesh.node_position[a] - mesh.node_position[b]).norm();
  }
  return length;
}

/// Everything that holds for every mesh of every scene.
void ExpectMeshLaws(const Scene& scene, const Mesh& mesh, float max_edge) {
  const size_t nodes = mesh.node_count(), elements = mesh.element_count();
  ASSERT_EQ(mesh.node_normal.size(), nodes);
  ASSERT_EQ(mesh.node_sample_position.size(), nodes);
  ASSERT_EQ(mesh.node_sample_normal.size(), nodes);
  ASSERT_EQ(mesh.node_patch.size(), nodes);
  ASSERT_EQ(mesh.element_patch.size(), elements);
  ASSERT_EQ(mesh.roots.size(), 2 * scene.faces.size());

  // Patches cover nodes and elements in order, and elements use nodes of their patch only.
  uint32_t node = 0, element = 0;
  for (uint32_t i = 0; i < mesh.patches.size(); ++i) {
    const Mesh::Patch& patch = mesh.patches[i];
    ASSERT_EQ(patch.node_begin, node);
    ASSERT_EQ(patch.element_begin, element);
    ASSERT_LT(patch.node_begin, patch.node_end);
    ASSERT_LT(patch.element_begin, patch.element_end);
    for (; node < patch.node_end; ++node) ASSERT_EQ(mesh.node_patch[node], i);
    std::set<uint32_t> used;
    std::map<std::pair<uint32_t, uint32_t>, int> directed;
    for (; element < patch.element_end; ++element) {
      ASSERT_EQ(mesh.element_patch[element], i);
      for (int k = 0; k < 3; ++k) {
        const uint32_t a = mesh.elements[element][k], b = mesh.elements[element][(k + 1) % 3];
        ASSERT_TRUE(a >= patch.node_begin && a < patch.node_end);
        used.insert(a);
        ++directed[{a, b}];
        ASSERT_LE((mesh.node_position[a] - mesh.node_position[b]).norm(), max_edge * (1 + 2e-5f));
      }
    }
    ASSERT_EQ(used.size(), patch.node_end - patch.node_begin) << "every node is a corner of an element";

    // An edge is met at most once in each direction.
    for (const auto& [edge, count] : directed) ASSERT_EQ(count, 1);
  }
  ASSERT_EQ(node, nodes);
  ASSERT_EQ(element, elements);

  // Conforming: were an edge cut for one of its elements only, it and its halves would have no partners and
  // add to the border.
  const double border = BorderLength(Tessellate(scene, {.max_edge = 1e4f}));
  ASSERT_NEAR(BorderLength(mesh), border, 1e-5 * border);

  for (uint32_t n = 0; n < nodes; ++n) {
    ASSERT_NEAR(mesh.node_normal[n].norm(), 1, 1e-5);
    ASSERT_NEAR(mesh.node_sample_normal[n].norm(), 1, 1e-5);
    ASSERT_GT(mesh.node_normal[n].dot(mesh.node_sample_normal[n]), 0);
  }

  // Children come after parents, every element is one leaf, and leaves tile their face.
  std::vector<int> leaves(elements), parents(mesh.cells.size());
  for (uint32_t c = 0; c < mesh.cells.size(); ++c) {
    const Mesh::Cell& cell = mesh.cells[c];
    if (cell.child == kNone) {
      ASSERT_LT(cell.element, elements);
      ++leaves[cell.element];
    } else {
      ASSERT_GT(cell.child, c);
      ASSERT_LT(cell.apex, 3);
      ++parents[cell.child];
      ++parents[cell.child + 1];
    }
  }
  for (const int n : leaves) ASSERT_EQ(n, 1);
  const double scene_size = scene.Bounds().diagonal().norm();
  for (uint32_t root = 0; root < mesh.roots.size(); ++root) {
    if (mesh.roots[root] == kNone) continue;
    ++parents[mesh.roots[root]];
    double sum = 0;
    std::vector<uint32_t> stack = {mesh.roots[root]};
    while (!stack.empty()) {
      const Mesh::Cell& cell = mesh.cells[stack.back()];
      stack.pop_back();
      if (cell.child == kNone) {
        const Mesh::Patch& patch = mesh.patches[mesh.element_patch[cell.element]];
        ASSERT_EQ(patch.surface, scene.faces[root / 2].surface);
        ASSERT_EQ(patch.material, scene.faces[root / 2].material);
        ASSERT_EQ(patch.side, root % 2 ? Side::kBack : Side::kFront);
        sum += mesh.ElementArea(cell.element);
      } else {
        stack.insert(stack.end(), {cell.child, cell.child + 1});
      }
    }
    // Areas round by 2^-24 of themselves, and each midpoint on the face's edges moves by 2^-24 of its
    // coordinates.
    const auto p = scene.Corners(scene.faces[root / 2]);
    const double face_area = scene.Area(scene.faces[root / 2]);
    const double perimeter = (p[0] - p[1]).norm() + (p[1] - p[2]).norm() + (p[2] - p[0]).norm();
    ASSERT_NEAR(sum, face_area, 1e-6 * face_area + 1e-7 * scene_size * perimeter);
  }
  for (const int n : parents) ASSERT_EQ(n, 1);
}

/// The point that element corners and weights give is the point that the face's barycentrics give.
void ExpectLocateFindsPoints(const Scene& scene, const Mesh& mesh, int count) {
  std::mt19937 bits(5);
  std::uniform_real_distribution<float> uniform;
  const float size = scene.Bounds().diagonal().norm();
  int located = 0;
  for (int i = 0; i < count; ++i) {
    const uint32_t f = bits() % scene.faces.size();
    float u = uniform(bits), v = uniform(bits);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    if (i % 10 == 0) u = 0;                  // edges
    if (i % 20 == 0) v = i % 40 ? 1.0f : 0;  // corners
    for (const Side side : {Side::kFront, Side::kBack}) {
      const Mesh::Location where = mesh.Locate(f, side, u, v);
      if (mesh.roots[2 * f + static_cast<size_t>(side)] == kNone) {
        ASSERT_EQ(where.element, kNone);
        continue;
      }
      ++located;
      Vec3 point = Vec3::Zero();
      float sum = 0;
      for (int k = 0; k < 3; ++k) {
        ASSERT_GE(where.weight[k], 0);
        sum += where.weight[k];
        point += where.weight[k] * mesh.node_position[mesh.elements[where.element][k]];
      }
      ASSERT_NEAR(sum, 1, 1e-6);
      const auto p = scene.Corners(scene.faces[f]);
      // Midpoints and the sum round by a few 2^-24 of the scene's size each.
      ASSERT_LT((point - ((1 - u - v) * p[0] + u * p[1] + v * p[2])).norm(), 2e-6f * size);
    }
  }
  ASSERT_GT(located, count / 2);
}

TEST(TessellateTest, MeshesOfTestScenesObeyTheLaws) {
  for (const char* name :
       {"cornell_diffuse", "cornell_glossy", "furnace_glossy", "glossy_floor", "lampshade"}) {
    SCOPED_TRACE(name);
    const Scene scene = ReadGltfScene(std::string(LOBE_TEST_DATA "/scenes/") + name + ".glb");
    for (const float edge : {10.0f, 0.4f, 0.17f}) {
      const Mesh mesh = WithEdge(scene, edge);
      ExpectMeshLaws(scene, mesh, edge);
      ExpectLocateFindsPoints(scene, mesh, 2000);
    }
  }
}

TEST(TessellateTest, CornellBoxHasAboutFiveThousandNodes) {
  const Mesh mesh = WithEdge(ReadGltfScene(LOBE_TEST_DATA "/scenes/cornell_diffuse.glb"), 0.4f);
  std::cout << "cornell_diffuse at 0.4 m: " << mesh.node_count() << " nodes, " << mesh.element_count()
            << " elements, " << mesh.patches.size() << " patches\n";
  // 281 m^2 of right isosceles triangles with hypotenuses between 0.28 and 0.4 m have between 7000 and 14000
  // elements and half as many nodes, and then there are borders.
  EXPECT_GT(mesh.node_count(), 3500u);
  EXPECT_LT(mesh.node_count(), 8500u);
  for (const Mesh::Patch& patch : mesh.patches) EXPECT_TRUE(patch.planar);
}

TEST(TessellateTest, SquareSplitsIntoRightIsoscelesTriangles) {
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, Grey(&b));
  const Scene scene = b.Build();
  // Hypotenuses are sqrt(2), 1, sqrt(1/2), 1/2, ... as elements double from 2.
  size_t expected = 2;
  for (double hypotenuse = std::numbers::sqrt2; hypotenuse > 0.1; hypotenuse /= std::numbers::sqrt2) {
    const Mesh mesh = WithEdge(scene, static_cast<float>(hypotenuse));
    EXPECT_EQ(mesh.element_count(), expected);
    ASSERT_EQ(mesh.patches.size(), 1u);
    expected *= 2;
  }
}

TEST(TessellateTest, BisectionKeepsHalfOfTheSmallestAngle) {
  SceneBuilder b;
  b.AddTriangle({0, 0, 0}, {3.1f, 0.2f, 0.4f}, {1.2f, 1.7f, -0.3f}, Grey(&b));
  const Scene scene = b.Build();
  const auto smallest_angle = [](const std::array<Vec3, 3>& p) {
    double angle = 10;
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = (p[(k + 1) % 3] - p[k]).normalized(), c = (p[(k + 2) % 3] - p[k]).normalized();
      angle = std::min<double>(angle, std::acos(a.dot(c)));
    }
    return angle;
  };
  const double given = smallest_angle(scene.Corners(scene.faces[0]));
  const Mesh mesh = WithEdge(scene, 0.05f);
  EXPECT_GT(mesh.element_count(), 1000u);
  for (const auto& e : mesh.elements) {
    EXPECT_GE(smallest_angle({mesh.node_position[e[0]], mesh.node_position[e[1]], mesh.node_position[e[2]]}),
              0.499 * given);
  }
}

TEST(TessellateTest, CreasesSeparatePatchesAndSmoothEdgesJoin) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  b.AddBox({0, 0, 0}, {1, 2, 3}, grey);
  b.AddSphere({5, 0, 0}, 1, grey, 12);
  b.AddQuad({0, 0, 9}, {1, 0, 9}, {1, 1, 9}, {0, 1, 9}, grey);
  b.AddQuad({1, 0, 9}, {2, 0, 9}, {2, 1, 9}, {1, 1, 9}, grey);  // beside it, but a surface of its own
  const Mesh mesh = WithEdge(b.Build(), 0.3f);
  ASSERT_EQ(mesh.patches.size(), 6u + 1 + 2);
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(mesh.patches[i].planar);
  const Mesh::Patch& sphere = mesh.patches[6];
  EXPECT_FALSE(sphere.planar);
  // Euler: V - E + F = 2 and 2 E = 3 F of a closed surface.
  EXPECT_EQ(2 * (sphere.node_end - sphere.node_begin), sphere.element_end - sphere.element_begin + 4);
}

TEST(TessellateTest, CornersWeldByPositionAndNormal) {
  // Two triangles that share an edge by position only, with normals that differ by `angle`, and a gap.
  const auto patches = [](float angle, float gap, float crease) {
    SceneBuilder b;
    const Vec3 n(0, 0, 1), m(std::sin(angle), 0, std::cos(angle));
    b.AddMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, gap}, {1, 1, 0}, {0, 1, gap}}, {n, n, n, m, m, m},
              {{0, 1, 2}, {3, 4, 5}}, Grey(&b));
    return Tessellate(b.Build(), {.max_edge = 0.5f, .crease_angle = crease}).patches.size();
  };
  EXPECT_EQ(patches(0, 0, 0.0175f), 1u);
  EXPECT_EQ(patches(0.01f, 0, 0.0175f), 1u);
  EXPECT_EQ(patches(0.03f, 0, 0.0175f), 2u);
  EXPECT_EQ(patches(0.03f, 0, 0.1f), 1u);
  EXPECT_EQ(patches(0, 1e-6f, 0.0175f), 1u) << "the scene measures 1.4, so 1.4e-6 welds";
  EXPECT_EQ(patches(0, 1e-5f, 0.0175f), 2u);
}

TEST(TessellateTest, NodeNormalsInterpolateTheCorners) {
  const Vec3 n0 = Vec3(0.1f, 0.2f, 1).normalized(), n1 = Vec3(-0.3f, 0, 1).normalized(),
             n2 = Vec3(0, 0.6f, 0.8f).normalized();
  SceneBuilder b;
  b.AddMesh({{0, 0, 0}, {2, 0, 0}, {0.3f, 1.8f, 0}}, {n0, n1, n2}, {{0, 1, 2}}, Grey(&b, true));
  const Scene scene = b.Build();
  const Mesh mesh = WithEdge(scene, 0.3f);
  const auto p = scene.Corners(scene.faces[0]);
  for (size_t n = 0; n < mesh.node_count(); ++n) {
    const Vec3 q = mesh.node_position[n];
    const float v = q.y() / p[2].y(), u = (q.x() - v * p[2].x()) / p[1].x();
    Vec3 expected = ((1 - u - v) * n0 + u * n1 + v * n2).normalized();
    if (mesh.patches[mesh.node_patch[n]].side == Side::kBack) expected = -expected;
    EXPECT_LT((mesh.node_normal[n] - expected).norm(), 1e-5f);
  }
  EXPECT_EQ(mesh.patches.size(), 2u);
}

TEST(TessellateTest, NormalsBehindTheFaceAreTurnedOrReplaced) {
  const Vec3 z = Vec3::UnitZ();
  const Vec3 turned = Vec3(0.3f, 0, -1).normalized(), flat = Vec3::UnitX();
  SceneBuilder b;
  b.AddMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {turned, flat, z}, {{0, 1, 2}}, Grey(&b));
  const Mesh mesh = WithEdge(b.Build(), 2);
  ASSERT_EQ(mesh.node_count(), 3u);
  EXPECT_LT((mesh.node_normal[0] + turned).norm(), 1e-6f);
  EXPECT_LT((mesh.node_normal[1] - z).norm(), 1e-6f);
  EXPECT_LT((mesh.node_normal[2] - z).norm(), 1e-6f);
}

TEST(TessellateTest, DoubleSidedFacesHaveASetOfNodesEachSide) {
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, Grey(&b, true));
  b.AddQuad({0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, Grey(&b, false));
  const Scene scene = b.Build();
  const Mesh mesh = WithEdge(scene, 0.3f);
  ASSERT_EQ(mesh.patches.size(), 3u);
  EXPECT_NEAR(MeshArea(mesh), 3, 1e-4);
  EXPECT_EQ(mesh.patches[1].side, Side::kBack);
  for (uint32_t n = mesh.patches[1].node_begin; n < mesh.patches[1].node_end; ++n) {
    EXPECT_EQ(mesh.node_normal[n], Vec3(0, 0, -1));
    EXPECT_EQ(mesh.node_sample_normal[n], Vec3(0, 0, -1));
  }
  // A back's elements wind counter-clockwise seen from behind.
  for (uint32_t e = mesh.patches[1].element_begin; e < mesh.patches[1].element_end; ++e) {
    const auto& c = mesh.elements[e];
    const Vec3 p = mesh.node_position[c[0]];
    EXPECT_LT((mesh.node_position[c[1]] - p).cross(mesh.node_position[c[2]] - p).z(), 0);
  }
  EXPECT_EQ(mesh.Locate(2, Side::kBack, 0.2f, 0.3f).element, kNone);
}

TEST(TessellateTest, BothSidesOfAFaceAreCutAlike) {
  SceneBuilder b;
  b.AddSphere({0, 0, 0}, 1, Grey(&b, true), 5);
  b.AddBox({2, 0, 0}, {3, 0.7f, 0.4f}, Grey(&b, true));
  const Scene scene = b.Build();
  std::mt19937 bits(3);
  std::uniform_real_distribution<float> uniform;
  for (const float edge : {0.5f, 0.11f}) {
    const Mesh mesh = WithEdge(scene, edge);
    for (int i = 0; i < 2000; ++i) {
      const uint32_t f = bits() % scene.faces.size();
      float u = uniform(bits), v = uniform(bits);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const auto front = mesh.Locate(f, Side::kFront, u, v), back = mesh.Locate(f, Side::kBack, u, v);
      // Barycentrics a rounding error from a cut may fall to either half.
      if (*std::min_element(front.weight, front.weight + 3) < 1e-4f) continue;
      for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(mesh.node_position[mesh.elements[front.element][k]],
                  mesh.node_position[mesh.elements[back.element][(3 - k) % 3]]);
        ASSERT_NEAR(front.weight[k], back.weight[(3 - k) % 3], 1e-4);
      }
    }
  }
}

/// Four triangles around the middle of a unit square, seen from both sides, with Face::contact.
Scene Pinwheel(const std::array<uint32_t, 4>& contact) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b, true);
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5f, 0.5f, 0}};
  b.AddMesh(p, std::vector<Vec3>(5, Vec3::UnitZ()), {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}, grey);
  Scene scene = b.Build();
  for (int i = 0; i < 4; ++i) scene.faces[i].contact = contact[i];
  return scene;
}

TEST(TessellateTest, NodesAreNotSharedAcrossContactLines) {
  // From corner 0 by way of the middle to corner 2: edges 2 (to corner 0) and 1 (from the next corner).
  const Scene scene = Pinwheel({4, 2, 4, 2});
  const Mesh mesh = WithEdge(scene, 10);
  ASSERT_EQ(mesh.patches.size(), 4u) << "two pieces, two sides";
  for (const Mesh::Patch& p : mesh.patches) EXPECT_EQ(p.node_end - p.node_begin, 4u);
  const Mesh fine = WithEdge(scene, 0.1f);
  ASSERT_EQ(fine.patches.size(), 4u);
  ExpectMeshLaws(scene, fine, 0.1f);
  for (const Mesh::Patch& p : fine.patches) {
    for (uint32_t n = p.node_begin; n < p.node_end; ++n) {
      const Vec3& at = fine.node_position[n];
      const Vec3& sample = fine.node_sample_position[n];
      if (at.x() != at.y()) continue;
      EXPECT_GT(std::abs(sample.x() - sample.y()), 1e-5f) << "on the line itself";
    }
  }
}

TEST(TessellateTest, SurfaceHangsTogetherAroundTheEndOfAContactLine) {
  const Scene scene = Pinwheel({4, 0, 0, 2});  // from corner 0 to the middle
  const Mesh mesh = WithEdge(scene, 10);
  ASSERT_EQ(mesh.patches.size(), 2u) << "two sides";
  // Corner 0 twice; around the middle, where shadows of a wall's end begin, a node for each of four elements.
  EXPECT_EQ(mesh.node_count(), 2u * (2 + 3 + 4));
  const Mesh fine = WithEdge(scene, 0.1f);
  EXPECT_EQ(fine.patches.size(), 2u);
  EXPECT_NEAR(MeshArea(fine), 2, 1e-5);
}

TEST(TessellateTest, OnlyWantedSidesGetNodes) {
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, Grey(&b, true));
  const Scene scene = b.Build();
  const Mesh mesh = Tessellate(scene, {.max_edge = 0.3f}, {false, true, true, false});
  EXPECT_EQ(mesh.patches.size(), 2u);
  EXPECT_NEAR(MeshArea(mesh), 1, 1e-5);
  EXPECT_EQ(mesh.Locate(0, Side::kFront, 0.2f, 0.3f).element, kNone);
  EXPECT_NE(mesh.Locate(0, Side::kBack, 0.2f, 0.3f).element, kNone);
  EXPECT_THROW(Tessellate(scene, {}, {true}), std::invalid_argument);
}

TEST(TessellateTest, BorderNodesSampleInsideAndInnerNodesAtThemselves) {
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, Grey(&b));
  const Mesh mesh = WithEdge(b.Build(), 0.2f);
  int inner = 0;
  for (size_t n = 0; n < mesh.node_count(); ++n) {
    const Vec3 p = mesh.node_position[n], s = mesh.node_sample_position[n];
    EXPECT_EQ(s.z(), 0);
    const bool border = p.head<2>().minCoeff() == 0 || p.head<2>().maxCoeff() == 1;
    if (!border) {
      EXPECT_EQ(p, s);
      ++inner;
      continue;
    }
    EXPECT_GT(s.head<2>().minCoeff(), 0);
    EXPECT_LT(s.head<2>().maxCoeff(), 1);
    // Centroids of elements of edges up to 0.2 are less than 0.15 away, and the inset is 2 %.
    EXPECT_LT((s - p).norm(), 0.02f * 0.15f);
  }
  EXPECT_GT(inner, 10);
}

TEST(TessellateTest, SamplesOfCurvedSurfacesStayOnThem) {
  // The upper half of a sphere, open at the equator: samples of its border lie on faces, not inside.
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  b.AddSphere({0, 0, 0}, 1, grey, 8);
  Scene scene = b.Build();
  std::erase_if(scene.faces, [&](const Face& f) {
    const auto p = scene.Corners(f);
    return (p[0] + p[1] + p[2]).y() < 0;
  });
  const Mesh mesh = WithEdge(scene, 0.2f);
  ASSERT_EQ(mesh.patches.size(), 1u);
  for (size_t n = 0; n < mesh.node_count(); ++n) {
    const Vec3 s = mesh.node_sample_position[n];
    float nearest = 1;  // distance to the plane of the face in front of it
    for (const Face& f : scene.faces) {
      nearest = std::min(nearest, std::abs(scene.GeometricNormal(f).dot(s - scene.positions[f.vertex[0]])));
    }
    EXPECT_LT(nearest, 1e-6f);
    // At the pole every other face leans by up to 23 degrees.
    EXPECT_GT(mesh.node_sample_normal[n].dot(s.normalized()), 0.9f);
    EXPECT_NEAR(mesh.node_normal[n].dot(mesh.node_position[n].normalized()), 1, 1e-3);
  }
}

TEST(TessellateTest, NonManifoldSurfacesAreMeshedInPieces) {
  const Vec3 z = Vec3::UnitZ();
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  // Three faces on one edge with one normal, a face twice, two faces that touch in a point, and a triangle
  // with two corners nearer than the welding distance.
  b.AddMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3f, 1.2f, 0}, {0.5f, -1, 0}}, {z, z, z, z, z},
            {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {0, 1, 2}}, grey);
  b.AddMesh({{5, 0, 0}, {6, 0, 0}, {6, 1, 0}, {4, 0, 0}, {4, -1, 0}, {5, -1, 0}, {6, -1, 0}},
            {z, z, z, z, z, z, z}, {{0, 1, 2}, {0, 3, 4}, {0, 5, 6}}, grey);
  b.AddMesh({{8, 0, 0}, {8 + 1e-6f, 0, 0}, {8, 1, 0}}, {z, z, z}, {{0, 1, 2}}, grey);
  const Scene scene = b.Build();
  const Mesh mesh = WithEdge(scene, 0.3f);
  double area = 0;
  for (const Face& f : scene.faces) area += scene.Area(f);
  EXPECT_NEAR(MeshArea(mesh), area, 1e-4);
  ExpectLocateFindsPoints(scene, mesh, 500);
}

TEST(TessellateTest, SameInputGivesTheSameMesh) {
  const Scene scene = ReadGltfScene(LOBE_TEST_DATA "/scenes/lampshade.glb");
  const Mesh a = WithEdge(scene, 0.2f), b = WithEdge(scene, 0.2f);
  EXPECT_EQ(a.elements, b.elements);
  EXPECT_EQ(a.roots, b.roots);
  EXPECT_TRUE(std::equal(a.node_position.begin(), a.node_position.end(), b.node_position.begin()));
  EXPECT_TRUE(std::equal(a.node_normal.begin(), a.node_normal.end(), b.node_normal.begin()));
}

TEST(TessellateTest, TooManyElementsAreRefusedBeforeTheWork) {
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0}, Grey(&b));
  const Scene scene = b.Build();
  ExpectInputError([&] { WithEdge(scene, 0.001f); }, {"test scene", "0.001 m", "4e+10 elements", "2^31"});

  SceneBuilder far;
  far.AddTriangle({1e6f, 0, 0}, {1e6f + 1, 0, 0}, {1e6f, 1, 0}, Grey(&far));
  const Scene far_scene = far.Build();
  ExpectInputError([&] { WithEdge(far_scene, 0.01f); }, {"0.01 m", "coordinates"});
  EXPECT_THROW(WithEdge(scene, 0), std::invalid_argument);
  EXPECT_THROW(WithEdge(scene, std::nanf("")), std::invalid_argument);
}

TEST(TessellateTest, FacesOfNoAreaHaveNoNodes) {
  SceneBuilder b;
  const uint32_t grey = Grey(&b);
  b.AddMesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, std::vector<Vec3>(4, Vec3::UnitZ()),
            {{0, 1, 2}, {0, 0, 1}, {0, 1, 3}}, grey);
  const Mesh mesh = WithEdge(b.Build(), 5);
  EXPECT_EQ(mesh.element_count(), 1u);
  EXPECT_EQ(mesh.Locate(0, Side::kFront, 0.1f, 0.1f).element, kNone);
  EXPECT_NE(mesh.Locate(2, Side::kFront, 0.1f, 0.1f).element, kNone);
}

TEST(MeshTest, LocateForgivesBarycentricsARoundingErrorOutside) {
  SceneBuilder b;
  b.AddTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Grey(&b, true));
  const Mesh mesh = WithEdge(b.Build(), 0.1f);
  for (const Side side : {Side::kFront, Side::kBack}) {
    for (const auto& [u, v] : {std::pair(-1e-7f, 0.3f), std::pair(0.3f, -1e-7f), std::pair(0.6f, 0.4000002f),
                               std::pair(1.0000001f, 0.0f), std::pair(-1e-9f, 1.0000001f)}) {
      const Mesh::Location where = mesh.Locate(0, side, u, v);
      ASSERT_NE(where.element, kNone);
      Vec3 point = Vec3::Zero();
      for (int k = 0; k < 3; ++k) {
        EXPECT_GE(where.weight[k], 0);
        point += where.weight[k] * mesh.node_position[mesh.elements[where.element][k]];
      }
      EXPECT_LT((point - Vec3(u, v, 0)).norm(), 1e-6f);
    }
  }
}

TEST(MeshTest, BisectChildrenShareTheParentsAreaAndWinding) {
  const std::array<Vec3, 3> p = {Vec3(0.1f, 0, 0.3f), Vec3(2, 0.4f, 0), Vec3(0.5f, 1.7f, 1)};
  const auto cross = [](const std::array<Vec3, 3>& c) { return (c[1] - c[0]).cross(c[2] - c[0]).eval(); };
  for (int apex = 0; apex < 3; ++apex) {
    for (const auto& child : Bisect(p, apex)) EXPECT_LT((2 * cross(child) - cross(p)).norm(), 1e-5f);
  }
}

// Speed is part of the promise: a million elements in seconds.
TEST(SlowTessellateTest, MillionsOfElementsTakeSeconds) {
  const Scene scene = ReadGltfScene(LOBE_TEST_DATA "/scenes/cornell_diffuse.glb");
  const Mesh mesh = WithEdge(scene, 0.025f);
  EXPECT_GT(mesh.element_count(), 2'000'000u);
  EXPECT_NEAR(MeshArea(mesh), 281.425, 0.01);
}

}  // namespace
}  // namespace lobe
