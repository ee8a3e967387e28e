#include "scene/gltf_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "scene/gltf_nodes.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/input_errors.h"
#include "tests/support/scene_builder.h"
#include "tests/support/scene_glb.h"

namespace lobe {
namespace {

using nlohmann::json;
using test::ExpectInputError;
using test::GltfBuilder;

void ExpectWarning(const Scene& scene, std::initializer_list<std::string> words) {
  for (const std::string& warning : scene.warnings) {
    if (std::all_of(words.begin(), words.end(),
                    [&](const std::string& w) { return warning.find(w) != std::string::npos; })) {
      return;
    }
  }
  std::string all;
  for (const std::string& warning : scene.warnings) all += "\n  " + warning;
  ADD_FAILURE() << "no warning with '" << *words.begin() << "' among:" << all;
}

/// A scene of one node with `node`'s properties and a triangle (0,0,0), (1,0,0), (0,1,0) facing +z.
Scene TriangleUnder(json node) {
  GltfBuilder b;
  node["mesh"] = b.TriangleMesh();
  b.Node(std::move(node));
  return ReadGltfScene(b.Write());
}

/// Positions, flat, of faces.
std::vector<float> Corners(const Scene& scene) {
  std::vector<float> flat;
  for (const Face& f : scene.faces) {
    for (const Vec3& p : scene.Corners(f)) flat.insert(flat.end(), p.data(), p.data() + 3);
  }
  return flat;
}

// ---- Geometry

TEST(GltfSceneTest, SceneMadeInCodeSurvivesTheTrip) {
  test::SceneBuilder b;
  MetallicRoughness coat{Rgb(0.1f, 0.2f, 0.3f), 0.25f, 0.6f, 1.7f, 0.8f, Rgb(0.9f, 1, 2), true};
  const uint32_t coated = b.AddMaterial("coated", coat, Rgb(3, 2, 1), true);
  const uint32_t phong = b.AddMaterial("phong", Phong{Rgb(0.5f, 0.6f, 0.7f), 33});
  const uint32_t ward = b.AddMaterial("ward", Ward{Rgb(0.5f, 0.6f, 0.7f), 0.15f});
  b.AddBox({0, 0, 0}, {1, 2, 3}, coated);
  b.AddSphere({4, 0, 0}, 1, phong, 6);
  b.AddQuad({0, 0, 9}, {1, 0, 9}, {1, 1, 9}, {0, 1, 9}, ward);
  b.AddCamera("view0", {1, 2, 8}, {0.3f, 0.1f, 0}, Vec3::UnitY(), 0.9f);
  const Scene before = b.Build();
  for (const char* name : {"/a.glb", "/a.gltf"}) {
    const test::ScratchFolder folder;
    test::WriteSceneGlb(before, folder.path() + name);
    const Scene after = ReadGltfScene(folder.path() + name);
    EXPECT_TRUE(after.warnings.empty()) << after.warnings[0];
    EXPECT_EQ(after.path, folder.path() + name);
    ASSERT_EQ(after.faces.size(), before.faces.size());
    EXPECT_EQ(Corners(after), Corners(before));
    for (size_t f = 0; f < after.faces.size(); ++f) {
      EXPECT_EQ(after.faces[f].material, before.faces[f].material);
      EXPECT_EQ(after.faces[f].surface, before.faces[f].surface);
      for (int k = 0; k < 3; ++k) {
        EXPECT_LT(
            (after.normals[after.faces[f].vertex[k]] - before.normals[before.faces[f].vertex[k]]).norm(),
            1e-6f);
      }
    }
    EXPECT_EQ(after.surface_names, before.surface_names);
    ASSERT_EQ(after.materials.size(), 3u);
    EXPECT_TRUE(after.materials[0].double_sided);
    EXPECT_FALSE(after.materials[1].double_sided);
    EXPECT_TRUE(after.materials[0].emission.isApprox(Rgb(3, 2, 1), 1e-6f));
    const auto& m = std::get<MetallicRoughness>(after.materials[0].reflectance);
    EXPECT_TRUE(m.base_color.isApprox(coat.base_color));
    EXPECT_EQ(m.metallic, coat.metallic);
    EXPECT_EQ(m.roughness, coat.roughness);
    EXPECT_EQ(m.ior, coat.ior);
    EXPECT_EQ(m.specular, coat.specular);
    EXPECT_TRUE(m.specular_color.isApprox(coat.specular_color));
    EXPECT_TRUE(m.has_specular);
    EXPECT_EQ(std::get<Phong>(after.materials[1].reflectance).exponent, 33);
    EXPECT_EQ(std::get<Ward>(after.materials[2].reflectance).alpha, 0.15f);
    const Camera &c = after.FindCamera("view0"), &d = before.cameras[0];
    EXPECT_EQ(c.fov_y, d.fov_y);
    EXPECT_LT(
        (c.eye - d.eye).norm() + (c.right - d.right).norm() + (c.up - d.up).norm() + (c.back - d.back).norm(),
        1e-6f);
  }
}

TEST(GltfSceneTest, MissingNormalsAreFlatWithVerticesPerFace) {
  GltfBuilder b;
  // Two triangles folded along the edge from (0,0,0) to (0,1,0), which they share.
  const int positions = b.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
  b.Node({{"mesh",
           b.Mesh({{"attributes", {{"POSITION", positions}}}, {"indices", b.Uints({0, 1, 2, 0, 2, 3})}})}});
  const Scene scene = ReadGltfScene(b.Write());
  ASSERT_EQ(scene.faces.size(), 2u);
  EXPECT_EQ(scene.positions.size(), 6u);
  for (const Face& f : scene.faces) {
    for (const uint32_t v : f.vertex) EXPECT_LT((scene.normals[v] - scene.GeometricNormal(f)).norm(), 1e-6f);
  }
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfSceneTest, TransformsComposeDownTheHierarchy) {
  GltfBuilder b;
  const float s = std::sqrt(0.5f);
  const int mesh = b.TriangleMesh();
  // Quarter turn about z, then scale in the child: (x, y, z) -> (2x, 3y, z) -> (-3y, 2x, z) + (5, 6, 7).
  b.document()["nodes"] = {{{"translation", {5, 6, 7}}, {"rotation", {0, 0, s, s}}, {"children", {1}}},
                           {{"scale", {2, 3, 1}}, {"mesh", mesh}, {"name", "leaf"}}};
  b.document()["scenes"] = {{{"nodes", {0}}}};
  const Scene scene = ReadGltfScene(b.Write());
  const std::vector<float> expected = {5, 6, 7, 5, 8, 7, 2, 6, 7};
  const std::vector<float> found = Corners(scene);
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(found[i], expected[i], 1e-6);
  EXPECT_EQ(scene.surface_names, std::vector<std::string>{"leaf"});
}

TEST(GltfSceneTest, MatrixIsColumnMajor) {
  const Scene scene = TriangleUnder({{"matrix", {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}});
  EXPECT_EQ(Corners(scene), (std::vector<float>{5, 6, 7, 5, 8, 7, 2, 6, 7}));
}

TEST(GltfSceneTest, NegativeScaleMirrorsButKeepsTheFront) {
  GltfBuilder b;
  const Vec3 n = Vec3(0.3f, 0.2f, 1).normalized();
  const int positions = b.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int normals = b.Floats({n.x(), n.y(), n.z(), 0, 0, 1, 0, 0, 1}, "VEC3");
  const int mesh = b.Mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
  b.Node({{"mesh", mesh}, {"scale", {-1, 1, 1}}});
  b.Node({{"mesh", mesh}, {"scale", {1, 1, -2}}});
  b.Node({{"mesh", mesh}, {"scale", {-1, -1, -1}}});
  b.Node({{"mesh", mesh}, {"scale", {-2, -1, 1}}, {"translation", {0, 0, 5}}});
  const Scene scene = ReadGltfScene(b.Write());
  ASSERT_EQ(scene.faces.size(), 4u);
  // The mirror image of a triangle facing +z faces +z if x is mirrored, -z if z is.
  const float z[] = {1, -1, -1, 1};
  // Inverse transpose: (n.x / scale.x, n.y / scale.y, n.z / scale.z), normalised.
  const Vec3 shading[] = {{-n.x(), n.y(), n.z()},
                          {n.x(), n.y(), -n.z() / 2},
                          {-n.x(), -n.y(), -n.z()},
                          {-n.x() / 2, -n.y(), n.z()}};
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT((scene.GeometricNormal(scene.faces[i]) - Vec3(0, 0, z[i])).norm(), 1e-6f) << i;
    EXPECT_LT((scene.normals[scene.faces[i].vertex[0]] - shading[i].normalized()).norm(), 1e-6f) << i;
  }
}

TEST(GltfSceneTest, StripsAndFansKeepTheirWinding) {
  GltfBuilder b;
  const int strip = b.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3");
  const int fan = b.Floats({0, 0, 5, 1, 0, 5, 1, 1, 5, 0, 1, 5, -1, 1, 5}, "VEC3");
  b.Node({{"mesh", b.Mesh({{"attributes", {{"POSITION", strip}}}, {"mode", 5}})}});
  b.Node(
      {{"mesh",
        b.Mesh({{"attributes", {{"POSITION", fan}}}, {"mode", 6}, {"indices", b.Uints({0, 1, 2, 3, 4})}})}});
  const Scene scene = ReadGltfScene(b.Write());
  ASSERT_EQ(scene.faces.size(), 6u);
  float strip_area = 0, fan_area = 0;
  for (const Face& f : scene.faces) {
    EXPECT_LT((scene.GeometricNormal(f) - Vec3::UnitZ()).norm(), 1e-6f);
    (f.surface == 0 ? strip_area : fan_area) += scene.Area(f);
  }
  EXPECT_NEAR(strip_area, 1.5, 1e-6);
  EXPECT_NEAR(fan_area, 1.5, 1e-6);
}

TEST(GltfSceneTest, IndicesOfEveryWidthAndNone) {
  GltfBuilder b;
  const int positions = b.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int bytes = b.Packed({0, 1, 2}, 5121, "SCALAR", 3);
  const int shorts = b.Packed({0, 0, 1, 0, 2, 0}, 5123, "SCALAR", 3);
  for (const json& indices : {json(bytes), json(shorts), json(b.Uints({0, 1, 2})), json()}) {
    json primitive = {{"attributes", {{"POSITION", positions}}}};
    if (!indices.is_null()) primitive["indices"] = indices;
    b.Node({{"mesh", b.Mesh(primitive)}, {"translation", {0, 0, b.document()["meshes"].size()}}});
  }
  const Scene scene = ReadGltfScene(b.Write());
  ASSERT_EQ(scene.faces.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    const float z = float(i + 1);
    EXPECT_EQ(scene.Corners(scene.faces[i]),
              (std::array<Vec3, 3>{Vec3(0, 0, z), Vec3(1, 0, z), Vec3(0, 1, z)}));
  }
}

TEST(GltfSceneTest, QuantisedAndSparsePositionsAreRead) {
  GltfBuilder b;
  // Bytes normalised to -1..1, padded to 4, scaled back by the node.
  const int quantised = b.Packed({0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0}, 5120, "VEC3", 3, true);
  b.document()["bufferViews"][quantised]["byteStride"] = 4;
  b.document()["extensionsUsed"] = b.document()["extensionsRequired"] = {"KHR_mesh_quantization"};
  b.Node({{"mesh", b.Mesh({{"attributes", {{"POSITION", quantised}}}})}, {"scale", {2, 2, 2}}});

  const int sparse = b.Floats({0, 0, 0, 1, 0, 0, 9, 9, 9}, "VEC3");
  const int index = b.Packed({2}, 5121, "SCALAR", 1), value = b.Floats({0, 1, 0}, "VEC3");
  b.document()["accessors"][sparse]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", index}, {"componentType", 5121}}},
      {"values", {{"bufferView", value}}}};
  b.Node({{"mesh", b.Mesh({{"attributes", {{"POSITION", sparse}}}})}, {"translation", {0, 0, 3}}});
  const Scene scene = ReadGltfScene(b.Write());
  EXPECT_EQ(Corners(scene), (std::vector<float>{0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 3, 1, 0, 3, 0, 1, 3}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfSceneTest, NormalsAgainstTheWindingAreToldOfOncePerMesh) {
  GltfBuilder b;
  const auto primitive = [&b](float first, float second, float z) {
    return json{{"attributes",
                 {{"POSITION", b.Floats({0, 0, z, 1, 0, z, 0, 1, z}, "VEC3")},
                  {"NORMAL", b.Floats({0, 0, first, 0, 0, second, 0, 0.6f, 0.8f}, "VEC3")}}}};
  };
  const int some = b.Mesh(primitive(-1, 1, 0), "some"), none = b.Mesh(primitive(1, 1, 1), "none");
  b.document()["meshes"][some]["primitives"].push_back(primitive(-1, -1, 2));
  b.Node({{"mesh", some}});
  b.Node({{"mesh", some}, {"scale", {-1, 1, 1}}, {"translation", {-1, 0, 0}}});  // mirrors both
  b.Node({{"mesh", none}});
  const Scene scene = ReadGltfScene(b.Write());
  ASSERT_EQ(scene.warnings.size(), 1u);
  ExpectWarning(scene, {"mesh 0 'some'", "the normals of 3 of 6 corners point behind their triangle"});
  EXPECT_GT(scene.CornerNormal(scene.faces[0], 0).z(), 0) << "turned";
}

TEST(GltfSceneTest, InstancesAreSurfacesOfTheirOwn) {
  GltfBuilder b;
  const int mesh = b.TriangleMesh();
  const int above = b.Floats({0, 0, 1, 1, 0, 1, 0, 1, 1}, "VEC3");
  b.document()["meshes"][mesh]["primitives"].push_back({{"attributes", {{"POSITION", above}}}});
  b.Node({{"mesh", mesh}, {"name", "left"}});
  b.Node({{"mesh", mesh}, {"translation", {5, 0, 0}}});
  const Scene scene = ReadGltfScene(b.Write());
  ASSERT_EQ(scene.faces.size(), 4u);
  for (uint32_t i = 0; i < 4; ++i) EXPECT_EQ(scene.faces[i].surface, i);
  EXPECT_EQ(scene.surface_names, (std::vector<std::string>{"left", "left", "node 1", "node 1"}));
  EXPECT_EQ(scene.Corners(scene.faces[2])[0], Vec3(5, 0, 0));
}

TEST(GltfSceneTest, ZeroAreaTrianglesAreDroppedAndCounted) {
  GltfBuilder b;
  const int positions = b.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, 0.5f, 1e-9f, 0}, "VEC3");
  b.Node({{"mesh", b.Mesh({{"attributes", {{"POSITION", positions}}},
                           {"indices", b.Uints({0, 1, 2, 0, 1, 3, 0, 0, 1, 0, 1, 4})}},
                          "plate")}});
  const Scene scene = ReadGltfScene(b.Write());
  EXPECT_EQ(scene.faces.size(), 1u);
  ASSERT_EQ(scene.warnings.size(), 1u);
  ExpectWarning(scene, {"mesh 0 'plate'", "3 triangles of no area are left out"});
}

TEST(GltfSceneTest, BadNormalsAreReplacedByTheFacesAndCounted) {
  GltfBuilder b;
  const float inf = std::numeric_limits<float>::infinity();
  const int positions = b.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int normals = b.Floats({0, 0, 0, 0, inf, 0, 0.6f, 0, 8e5f}, "VEC3");
  b.document()["accessors"][normals].erase("max");
  b.document()["accessors"][normals].erase("min");
  b.Node({{"mesh", b.Mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}})}});
  const Scene scene = ReadGltfScene(b.Write());
  const Face& f = scene.faces[0];
  EXPECT_EQ(scene.normals[f.vertex[0]], Vec3(0, 0, 1));
  EXPECT_EQ(scene.normals[f.vertex[1]], Vec3(0, 0, 1));
  EXPECT_NEAR(scene.normals[f.vertex[2]].norm(), 1, 1e-6);
  ExpectWarning(scene, {"mesh 0", "2 corners have a normal that is zero or not finite"});
}

TEST(GltfSceneTest, OnlyTheDefaultSceneIsRead) {
  GltfBuilder b;
  const int mesh = b.TriangleMesh();
  b.document()["nodes"] = {{{"mesh", mesh}, {"name", "zero"}}, {{"mesh", mesh}, {"name", "one"}}};
  b.document()["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  EXPECT_EQ(ReadGltfScene(b.Write()).surface_names, std::vector<std::string>{"zero"});
  b.document()["scene"] = 1;
  const Scene scene = ReadGltfScene(b.Write());
  EXPECT_EQ(scene.surface_names, std::vector<std::string>{"one"});
  ExpectWarning(scene, {"2 scenes", "only scene 1"});
  b.document().erase("scenes");
  b.document().erase("scene");
  EXPECT_EQ(ReadGltfScene(b.Write()).surface_names, (std::vector<std::string>{"zero", "one"}));
}

TEST(GltfSceneTest, BadGeometryIsRefusedWithItsPlace) {
  const auto refused = [](const auto& bend, std::initializer_list<std::string> words) {
    GltfBuilder b;
    const int positions = b.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int indices = b.Uints({0, 1, 2});
    b.Node({{"mesh", b.Mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}}, "plate")},
            {"name", "root"}});
    bend(&b, &b.document());
    std::string path = b.Write();
    ExpectInputError([&] { ReadGltfScene(path); }, words);
    ExpectInputError([&] { ReadGltfScene(path); }, {path});
  };
  const float nan = std::nanf("");
  refused(
      [&](GltfBuilder* b, json* d) {
        (*d)["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = b->writer.AddFloats(
            std::vector<float>{0, 0, 0, 1, nan, 0, 0, 1, 0}, "VEC3", GlbWriter::Target::kVertices);
      },
      {"mesh 0 'plate'", "primitive 0", "accessor 2", "vertex 1 is not finite"});
  refused(
      [](GltfBuilder* b, json* d) {
        (*d)["meshes"][0]["primitives"][0]["indices"] = b->Uints({0, 1, 3});
      },
      {"mesh 0 'plate'", "accessor 2", "index 2 is 3, expected below the 3 vertices"});
  refused(
      [](GltfBuilder* b, json* d) {
        (*d)["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = b->Floats({0, 0, 1, 0, 0, 1}, "VEC3");
      },
      {"mesh 0 'plate'", "NORMAL", "has 2 elements, expected 3"});
  refused(
      [](GltfBuilder* b, json* d) {
        (*d)["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = b->Floats({0, 0, 1, 0}, "VEC2");
      },
      {"POSITION", "type is \"VEC2\", expected VEC3"});
  refused([](GltfBuilder*, json* d) { (*d)["meshes"][0]["primitives"][0]["mode"] = 7; },
          {"plate", "mode is 7"});
  refused([](GltfBuilder*, json* d) { (*d)["meshes"][0]["primitives"][0]["material"] = 0; },
          {"plate", "material is 0", "nothing of that kind"});
  refused([](GltfBuilder*, json* d) { (*d)["nodes"][0]["mesh"] = 4; }, {"node 0 'root'", "mesh is 4"});
  refused([](GltfBuilder*, json* d) { (*d)["nodes"][0]["children"] = {0}; },
          {"node 0 'root'", "reached twice"});
  refused([](GltfBuilder*, json* d) { (*d)["nodes"][0]["children"] = {5}; },
          {"node 0 'root'", "children contains 5"});
  refused(
      [](GltfBuilder*, json* d) {
        (*d)["scenes"][0]["nodes"] = {0, 0};
      },
      {"node 0 'root'", "reached twice"});
  refused([](GltfBuilder*, json* d) { (*d)["scenes"][0]["nodes"] = {9}; }, {"scene 0", "nodes contains 9"});
  refused([](GltfBuilder*, json* d) { (*d)["scene"] = 2; }, {"scene is 2"});
  refused(
      [](GltfBuilder*, json* d) {
        (*d)["nodes"][0]["scale"] = {1, 2};
      },
      {"node 0 'root'", "scale is [1,2]"});
  refused([](GltfBuilder*, json* d) { (*d)["nodes"][0]["scale"] = {1, 2, 1e39}; }, {"scale is"});
  refused(
      [](GltfBuilder*, json* d) {
        (*d)["nodes"][0]["rotation"] = {0, 0, 0, 0};
      },
      {"rotation", "unit quaternion"});
  refused([](GltfBuilder*,
             json* d) { (*d)["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
          {"matrix", "last row"});
  refused(
      [](GltfBuilder*, json* d) {
        (*d)["nodes"][0]["scale"] = {1e30, 1e30, 1e30};
        (*d)["nodes"][0]["children"] = {1};
        (*d)["nodes"].push_back({{"scale", {1e30, 1, 1}}});
      },
      {"node 1", "not finite"});
  refused(
      [](GltfBuilder*, json* d) {
        (*d)["nodes"][0]["scale"] = {0, 1, 1};
      },
      {"the scene has no triangles"});
  refused([](GltfBuilder*, json* d) { (*d)["nodes"][0].erase("mesh"); }, {"the scene has no triangles"});
  refused([](GltfBuilder*, json* d) { (*d)["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
          {"requires the extension KHR_draco_mesh_compression"});
  refused([](GltfBuilder*, json* d) { (*d)["extensionsRequired"] = {"EXT_meshopt_compression"}; },
          {"requires the extension EXT_meshopt_compression"});
}

TEST(GltfSceneTest, DeepHierarchiesDoNotExhaustTheStack) {
  GltfBuilder b;
  const int mesh = b.TriangleMesh();
  constexpr int kDepth = 20000;
  for (int i = 0; i < kDepth; ++i) b.document()["nodes"].push_back({{"children", {i + 1}}});
  b.document()["nodes"].push_back({{"mesh", mesh}});
  b.document()["scenes"] = {{{"nodes", {0}}}};
  EXPECT_EQ(ReadGltfScene(b.Write()).faces.size(), 1u);
}

TEST(GltfSceneTest, WhatIsNotReadIsNamed) {
  GltfBuilder b;
  const int positions = b.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  json& d = b.document();
  const int mesh = b.Mesh({{"attributes", {{"POSITION", positions}, {"COLOR_0", positions}}},
                           {"targets", {{{"POSITION", positions}}}}},
                          "plate");
  d["meshes"][mesh]["primitives"].push_back({{"attributes", {{"POSITION", positions}}}, {"mode", 1}});
  d["meshes"][mesh]["primitives"].push_back({{"attributes", json::object()}});
  d["meshes"][mesh]["primitives"].push_back(
      {{"attributes", {{"POSITION", b.Floats({0, 0, 1, 1, 0, 1, 0, 1, 1}, "VEC3")}}},
       {"indices", b.Uints({0, 1, 2, 0})}});
  b.Node({{"mesh", mesh}, {"name", "moving"}, {"skin", 0}, {"camera", 0}});
  d["cameras"] = {{{"type", "orthographic"}, {"name", "plan"}, {"orthographic", json::object()}}};
  d["animations"] = {json::object()};
  d["extensions"]["KHR_lights_punctual"]["lights"] = {json::object(), json::object()};
  d["extensionsRequired"] = {"KHR_lights_punctual", "KHR_texture_transform"};
  const Scene scene = ReadGltfScene(b.Write());
  EXPECT_EQ(scene.faces.size(), 2u);
  EXPECT_TRUE(scene.cameras.empty());
  ExpectWarning(scene, {"mesh 0 'plate', primitive 0", "morph targets are not read"});
  ExpectWarning(scene, {"mesh 0 'plate', primitive 0", "COLOR_0 is not read"});
  ExpectWarning(scene, {"mesh 0 'plate', primitive 1", "mode 1 (points or lines) is not read"});
  ExpectWarning(scene, {"mesh 0 'plate', primitive 2", "no POSITION"});
  ExpectWarning(scene, {"mesh 0 'plate', primitive 3", "4 corners are not a multiple of 3"});
  ExpectWarning(scene, {"node 0 'moving'", "skin is not read"});
  ExpectWarning(scene, {"camera 0 'plan'", "type orthographic is not read"});
  ExpectWarning(scene, {"1 animation is not read"});
  ExpectWarning(scene, {"KHR_lights_punctual is not read; 2 lights are left out"});
  ExpectWarning(scene, {"requires the extension KHR_texture_transform"});
  for (const std::string& warning : scene.warnings) EXPECT_EQ(warning.find('\n'), std::string::npos);
}

// ---- Materials

Material ReadMaterial(json material, std::vector<std::string>* warnings = nullptr) {
  GltfBuilder b;
  b.document()["materials"] = {std::move(material)};
  std::vector<std::string> unused;
  const auto materials = ReadMaterials(GltfFile(b.Write()), warnings ? warnings : &unused);
  EXPECT_EQ(materials.size(), 1u);
  return materials[0];
}

TEST(GltfMaterialTest, EmptyMaterialHasTheDefaultsOfTheSpecification) {
  const Material material = ReadMaterial(json::object());
  EXPECT_EQ(material.name, "material 0");
  EXPECT_FALSE(material.double_sided);
  EXPECT_FALSE(material.emits());
  const auto& m = std::get<MetallicRoughness>(material.reflectance);
  EXPECT_TRUE((m.base_color == 1).all());
  EXPECT_EQ(m.metallic, 1);
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_EQ(m.specular, 1);
  EXPECT_TRUE((m.specular_color == 1).all());
  EXPECT_FALSE(m.has_specular);
}

TEST(GltfMaterialTest, PrimitivesWithoutMaterialGetTheDefaultOne) {
  const Scene scene = TriangleUnder({});
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].name, "default");
  EXPECT_EQ(std::get<MetallicRoughness>(scene.materials[0].reflectance).roughness, 1);

  // It is added once, after those of the file, and only if it is needed.
  GltfBuilder b;
  const int mesh = b.TriangleMesh();
  b.document()["materials"] = {{{"name", "own"}}};
  b.Node({{"mesh", mesh}});
  b.Node({{"mesh", mesh}, {"translation", {0, 0, 1}}});
  const Scene two = ReadGltfScene(b.Write());
  ASSERT_EQ(two.materials.size(), 2u);
  EXPECT_EQ(two.faces[0].material, 1u);
  EXPECT_EQ(two.faces[1].material, 1u);
  b.document()["meshes"][mesh]["primitives"][0]["material"] = 0;
  EXPECT_EQ(ReadGltfScene(b.Write()).materials.size(), 1u);
}

TEST(GltfMaterialTest, EmissionIsFactorTimesStrength) {
  const Material m =
      ReadMaterial({{"emissiveFactor", {1, 0.5, 0.25}},
                    {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 12}}}}}});
  EXPECT_TRUE(m.emission.isApprox(Rgb(12, 6, 3)));
  EXPECT_TRUE(m.emits());
  EXPECT_TRUE(ReadMaterial({{"emissiveFactor", {1, 0.5, 0.25}}}).emission.isApprox(Rgb(1, 0.5f, 0.25f)));
}

TEST(GltfMaterialTest, SpecularAndIorAreRead) {
  const Material a = ReadMaterial({{"extensions", {{"KHR_materials_specular", json::object()}}}});
  EXPECT_TRUE(std::get<MetallicRoughness>(a.reflectance).has_specular);
  const Material b = ReadMaterial(
      {{"extensions",
        {{"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {0.1, 0.2, 3}}}},
         {"KHR_materials_ior", {{"ior", 0}}}}}});
  const auto& m = std::get<MetallicRoughness>(b.reflectance);
  EXPECT_EQ(m.specular, 0.5f);
  EXPECT_TRUE(m.specular_color.isApprox(Rgb(0.1f, 0.2f, 3)));
  // "The Fresnel term evaluates to 1": through f0 = ((0 - 1) / (0 + 1))^2.
  EXPECT_EQ(m.ior, 0);
}

TEST(GltfMaterialTest, LobeExtensionSelectsModelsGltfLacks) {
  const auto read = [](json brdf) {
    return ReadMaterial({{"extensions", {{"LOBE_materials_brdf", std::move(brdf)}}}}).reflectance;
  };
  const auto lambert = read({{"model", "lambert"}, {"albedo", {0.1, 0.2, 0.3}}});
  EXPECT_TRUE(std::get<Lambert>(lambert).albedo.isApprox(Rgb(0.1f, 0.2f, 0.3f)));
  EXPECT_EQ(std::get<Phong>(read({{"model", "phong"}, {"exponent", 64}})).exponent, 64);
  EXPECT_EQ(std::get<Ward>(read({{"model", "ward"}, {"alpha", 0.1}})).alpha, 0.1f);
}

TEST(GltfMaterialTest, DiffuseTransmissionIsReadAndTakenAsDoubleSided) {
  const auto sheet = [](json extension, json rest = json::object()) {
    rest["name"] = "shade";
    rest["pbrMetallicRoughness"]["metallicFactor"] = 0.5;
    rest["extensions"]["KHR_materials_diffuse_transmission"] = std::move(extension);
    return rest;
  };
  std::vector<std::string> warnings;
  const Material shade = ReadMaterial(
      sheet({{"diffuseTransmissionFactor", 0.25}, {"diffuseTransmissionColorFactor", {0.9, 0.65, 0.35}}},
            {{"doubleSided", true}}),
      &warnings);
  const auto& m = std::get<MetallicRoughness>(shade.reflectance);
  EXPECT_EQ(m.diffuse_transmission, 0.25f);
  EXPECT_TRUE((m.diffuse_transmission_color == Rgb(0.9f, 0.65f, 0.35f)).all());
  EXPECT_TRUE(shade.transmits());
  EXPECT_EQ(warnings, std::vector<std::string>{});

  // Defaults: nothing goes through, and what would is white.
  const Material opaque = ReadMaterial(sheet(json::object()), &warnings);
  EXPECT_EQ(std::get<MetallicRoughness>(opaque.reflectance).diffuse_transmission, 0);
  EXPECT_TRUE((std::get<MetallicRoughness>(opaque.reflectance).diffuse_transmission_color == 1).all());
  EXPECT_FALSE(opaque.double_sided);
  EXPECT_EQ(warnings, std::vector<std::string>{});

  const Material thin = ReadMaterial(sheet({{"diffuseTransmissionFactor", 1},
                                            {"diffuseTransmissionTexture", {{"index", 0}}},
                                            {"diffuseTransmissionColorTexture", {{"index", 0}}}},
                                           {{"extensions", {{"KHR_materials_volume", json::object()}}}}),
                                     &warnings);
  EXPECT_TRUE(thin.double_sided);
  std::sort(warnings.begin(), warnings.end());
  EXPECT_EQ(warnings,
            (std::vector<std::string>{
                "material 0 'shade': KHR_materials_volume is not read; the material is taken without it",
                "material 0 'shade': diffuseTransmissionColorTexture is not read; its factor is used",
                "material 0 'shade': diffuseTransmissionTexture is not read; its factor is used",
                "material 0 'shade': it lets light through by KHR_materials_diffuse_transmission but is not "
                "doubleSided; it is taken as double-sided"}));
}

json GlassMaterial(json transmission, json volume, json rest = json::object()) {
  rest["name"] = "glass";
  rest["pbrMetallicRoughness"]["metallicFactor"] = 0;
  if (!rest["pbrMetallicRoughness"].contains("roughnessFactor")) {
    rest["pbrMetallicRoughness"]["roughnessFactor"] = 0;
  }
  rest["extensions"]["KHR_materials_transmission"] = std::move(transmission);
  if (!volume.is_null()) rest["extensions"]["KHR_materials_volume"] = std::move(volume);
  return rest;
}

TEST(GltfMaterialTest, GlassIsReadAsABodyOrAsAPane) {
  std::vector<std::string> warnings;
  const Material body = ReadMaterial(
      GlassMaterial(
          {{"transmissionFactor", 0.75}},
          {{"thicknessFactor", 0.5}, {"attenuationDistance", 0.25}, {"attenuationColor", {0.5, 0.75, 1}}},
          {{"extensions", {{"KHR_materials_ior", {{"ior", 1.33}}}}}}),
      &warnings);
  const auto& m = std::get<MetallicRoughness>(body.reflectance);
  EXPECT_EQ(m.transmission, 0.75f);
  EXPECT_EQ(m.thickness, 0.5f);
  EXPECT_EQ(m.attenuation_distance, 0.25f);
  EXPECT_TRUE((m.attenuation_color == Rgb(0.5f, 0.75f, 1)).all());
  EXPECT_EQ(m.ior, 1.33f);
  EXPECT_TRUE(body.glass() && body.body() && !body.pane());
  EXPECT_FALSE(body.double_sided) << "its back is the inside";
  EXPECT_EQ(warnings, std::vector<std::string>{});

  const Material pane = ReadMaterial(
      GlassMaterial({{"transmissionFactor", 1}, {"transmissionTexture", {{"index", 0}}}}, nullptr),
      &warnings);
  EXPECT_TRUE(pane.pane() && pane.double_sided);
  EXPECT_FALSE(std::isfinite(std::get<MetallicRoughness>(pane.reflectance).attenuation_distance));
  EXPECT_EQ(warnings,
            (std::vector<std::string>{
                "material 0 'glass': transmissionTexture is not read; its factor is used",
                "material 0 'glass': it lets light through by KHR_materials_transmission but is not "
                "doubleSided; it is taken as double-sided"}));
}

TEST(GltfMaterialTest, RoughGlassIsTakenAsClearAndSaysSo) {
  std::vector<std::string> warnings;
  const json rough = {{"pbrMetallicRoughness", {{"roughnessFactor", 0.25}}}};
  const Material m =
      ReadMaterial(GlassMaterial({{"transmissionFactor", 1}}, {{"thicknessFactor", 1}}, rough), &warnings);
  EXPECT_TRUE(m.body());
  EXPECT_EQ(std::get<MetallicRoughness>(m.reflectance).roughness, 0);
  EXPECT_EQ(warnings, (std::vector<std::string>{
                          "material 0 'glass': it transmits light with roughness 0.25, but only ideal "
                          "glass is read; it is taken as roughness 0"}));
  // Where nothing goes through, the coat stays as rough as it is.
  warnings.clear();
  const Material opaque = ReadMaterial(GlassMaterial({{"transmissionFactor", 0}}, nullptr, rough), &warnings);
  EXPECT_FALSE(opaque.glass());
  EXPECT_EQ(std::get<MetallicRoughness>(opaque.reflectance).roughness, 0.25f);
  json metal = GlassMaterial({{"transmissionFactor", 1}}, nullptr, rough);
  metal["pbrMetallicRoughness"]["metallicFactor"] = 1;
  EXPECT_FALSE(ReadMaterial(metal, &warnings).glass());
  EXPECT_EQ(warnings, std::vector<std::string>{});
}

TEST(GltfMaterialTest, GlassOutOfRangeNamesMaterialPropertyValueAndRange) {
  const auto refused = [](json transmission, json volume, const std::string& words) {
    const json properties = GlassMaterial(std::move(transmission), std::move(volume));
    ExpectInputError([&] { ReadMaterial(properties); }, {"test.glb: material 0 'glass': " + words});
  };
  const json clear = {{"transmissionFactor", 1}};
  refused({{"transmissionFactor", 1.5}}, nullptr,
          "KHR_materials_transmission.transmissionFactor is 1.5, expected 0 to 1");
  refused({{"transmissionFactor", "all"}}, nullptr,
          "KHR_materials_transmission.transmissionFactor is \"all\"");
  refused(clear, {{"thicknessFactor", -1}}, "KHR_materials_volume.thicknessFactor is -1");
  refused(clear, {{"attenuationDistance", 0}},
          "KHR_materials_volume.attenuationDistance is 0, expected more than 0");
  refused(clear, {{"attenuationDistance", nullptr}}, "KHR_materials_volume.attenuationDistance is null");
  refused(clear, {{"attenuationColor", {1, 2, 1}}},
          "KHR_materials_volume.attenuationColor is [1,2,1], expected 3 numbers, each 0 to 1");
}

TEST(GltfMaterialTest, OurOwnModelsStayOpaqueAndSaySo) {
  std::vector<std::string> warnings;
  const Material m =
      ReadMaterial({{"extensions",
                     {{"LOBE_materials_brdf", {{"model", "lambert"}}},
                      {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.5}}}}}},
                   &warnings);
  EXPECT_FALSE(m.transmits());
  EXPECT_FALSE(m.double_sided);
  EXPECT_EQ(warnings,
            (std::vector<std::string>{"material 0: KHR_materials_diffuse_transmission is not read; the "
                                      "surface is opaque"}));
}

TEST(GltfMaterialTest, ValuesOutOfRangeNameMaterialPropertyValueAndRange) {
  const auto refused = [](json properties, std::initializer_list<std::string> words) {
    properties["name"] = "oak";
    ExpectInputError([&] { ReadMaterial(properties); }, {"test.glb: material 0 'oak': "});
    ExpectInputError([&] { ReadMaterial(properties); }, words);
  };
  const auto pbr = [](const char* key, json value) { return json{{"pbrMetallicRoughness", {{key, value}}}}; };
  const auto extension = [](const char* name, const char* key, json value) {
    return json{{"extensions", {{name, {{key, value}}}}}};
  };
  refused(pbr("roughnessFactor", 1.5), {"pbrMetallicRoughness.roughnessFactor is 1.5, expected 0 to 1"});
  refused(pbr("roughnessFactor", -0.1), {"roughnessFactor is -0.1, expected 0 to 1"});
  refused(pbr("roughnessFactor", "rough"), {"roughnessFactor is \"rough\", expected 0 to 1"});
  refused(pbr("roughnessFactor", nullptr), {"roughnessFactor is null"});
  refused(pbr("metallicFactor", 2), {"metallicFactor is 2, expected 0 to 1"});
  refused(pbr("baseColorFactor", {0.5, -0.5, 0.5, 1}),
          {"baseColorFactor is [0.5,-0.5,0.5,1], expected 4 numbers, each 0 to 1"});
  refused(pbr("baseColorFactor", {0.5, 0.5, 0.5}), {"baseColorFactor", "4 numbers"});
  refused({{"emissiveFactor", {-1, 0, 0}}}, {"emissiveFactor is [-1,0,0]", "at least 0"});
  refused({{"emissiveFactor", {1e300, 0, 0}}}, {"emissiveFactor", "finite"});
  refused({{"emissiveFactor", {1e30, 0, 0}},
           {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1e30}}}}}},
          {"emissiveFactor times emissiveStrength is not finite"});
  // Each channel is, their sum is not.
  refused({{"emissiveFactor", {1, 1, 1}},
           {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 2e38}}}}}},
          {"emissiveFactor times emissiveStrength is not finite"});
  refused(extension("KHR_materials_emissive_strength", "emissiveStrength", -2),
          {"KHR_materials_emissive_strength.emissiveStrength is -2"});
  refused(extension("KHR_materials_ior", "ior", 0.5),
          {"KHR_materials_ior.ior is 0.5, expected 0 or at least 1"});
  refused(extension("KHR_materials_ior", "ior", -1), {"ior is -1"});
  refused(extension("KHR_materials_specular", "specularFactor", 1.1),
          {"specularFactor is 1.1, expected 0 to 1"});
  refused(extension("KHR_materials_specular", "specularColorFactor", {1, 1, -1}), {"specularColorFactor"});
  refused(extension("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", 1.5),
          {"KHR_materials_diffuse_transmission.diffuseTransmissionFactor is 1.5, expected 0 to 1"});
  refused(extension("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", "half"),
          {"diffuseTransmissionFactor is \"half\", expected 0 to 1"});
  refused(extension("KHR_materials_diffuse_transmission", "diffuseTransmissionColorFactor", {1, 1.1, 1}),
          {"diffuseTransmissionColorFactor is [1,1.1,1], expected 3 numbers, each 0 to 1"});
  refused(extension("LOBE_materials_brdf", "model", "toon"),
          {"LOBE_materials_brdf.model is \"toon\"", "\"ward\""});
  refused(extension("LOBE_materials_brdf", "albedo", {1, 1, 1}), {"LOBE_materials_brdf.model is missing"});
  refused({{"extensions", {{"LOBE_materials_brdf", {{"model", "phong"}, {"exponent", -1}}}}}},
          {"exponent is -1"});
  refused({{"extensions", {{"LOBE_materials_brdf", {{"model", "ward"}, {"alpha", 0}}}}}},
          {"alpha is 0, expected 0.001 to 1"});
  refused({{"extensions", {{"LOBE_materials_brdf", {{"model", "ward"}, {"albedo", {2, 0, 0}}}}}}},
          {"albedo is [2,0,0]"});
  refused({{"extensions", 5}}, {"extensions is 5, expected an object"});
  refused({{"doubleSided", 1}}, {"doubleSided is 1, expected true or false"});
}

TEST(GltfMaterialTest, WhatIsNotReadIsNamedWithWhatIsUsed) {
  std::vector<std::string> warnings;
  ReadMaterial({{"name", "oak"},
                {"alphaMode", "BLEND"},
                {"normalTexture", {{"index", 0}}},
                {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                {"extensions",
                 {{"KHR_materials_clearcoat", json::object()},
                  {"KHR_materials_iridescence", json::object()},
                  {"KHR_materials_specular", {{"specularColorTexture", {{"index", 0}}}}},
                  {"KHR_materials_emissive_strength", json::object()}}}},
               &warnings);
  std::sort(warnings.begin(), warnings.end());
  EXPECT_EQ(warnings,
            (std::vector<std::string>{
                "material 0 'oak': KHR_materials_clearcoat is not read; the material is taken without it",
                "material 0 'oak': KHR_materials_iridescence is not read; the material is taken without it",
                "material 0 'oak': alphaMode BLEND is not read; the surface is opaque",
                "material 0 'oak': baseColorTexture is not read; its factor is used",
                "material 0 'oak': normalTexture is not read; the surface is taken without it",
                "material 0 'oak': specularColorTexture is not read; its factor is used"}));
}

TEST(GltfMaterialTest, TexturedFilesAreReadWithoutTheirImages) {
  GltfBuilder b;
  b.document()["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  b.document()["textures"] = {{{"source", 0}}};
  b.document()["images"] = {{{"uri", "missing.png"}}};
  b.Node({{"mesh", b.TriangleMesh()}});
  EXPECT_EQ(ReadGltfScene(b.Write()).faces.size(), 1u);
}

// ---- Cameras

GltfBuilder* WithCamera(GltfBuilder* b, json perspective, json node, const char* name = nullptr) {
  json camera = {{"type", "perspective"}, {"perspective", std::move(perspective)}};
  if (name) camera["name"] = name;
  b->document()["cameras"].push_back(camera);
  node["camera"] = b->document()["cameras"].size() - 1;
  b->Node(std::move(node));
  return b;
}

TEST(GltfCameraTest, LooksAlongMinusZOfItsNodeWhateverTheScale) {
  GltfBuilder b;
  const float s = std::sqrt(0.5f);
  // A quarter turn about y takes -z to -x.
  WithCamera(&b, {{"yfov", 0.8}, {"aspectRatio", 1.5}, {"znear", 0.1}},
             {{"translation", {1, 2, 3}}, {"rotation", {0, s, 0, s}}, {"scale", {2, -3, 4}}}, "eye");
  const auto cameras = ReadCameras(GltfFile(b.Write()));
  ASSERT_EQ(cameras.size(), 1u);
  const Camera& c = cameras[0];
  EXPECT_EQ(c.eye, Vec3(1, 2, 3));
  EXPECT_LT((c.back - Vec3(1, 0, 0)).norm(), 1e-6f);
  EXPECT_LT((c.up - Vec3(0, -1, 0)).norm(), 1e-6f) << "a camera scaled upside down is upside down";
  EXPECT_LT((c.right.cross(c.up) - c.back).norm(), 1e-6f) << "but never a mirror image";
  EXPECT_EQ(c.fov_y, 0.8f);
  EXPECT_EQ(c.aspect, 1.5f);
}

TEST(GltfCameraTest, NamesComeFromCameraOrNodeAndAreUnique) {
  GltfBuilder b;
  WithCamera(&b, {{"yfov", 1}}, {{"name", "node name"}}, "lens");
  WithCamera(&b, {{"yfov", 1}}, {{"name", "node name"}});
  WithCamera(&b, {{"yfov", 1}}, json::object());
  b.Node({{"camera", 0}});
  b.Node({{"camera", 0}});
  WithCamera(&b, {{"yfov", 1}}, json::object(), "");
  std::vector<std::string> names;
  for (const Camera& c : ReadCameras(GltfFile(b.Write()))) {
    names.push_back(c.name);
    EXPECT_EQ(c.aspect, 1);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"lens", "node name", "node 2", "lens-2", "lens-3", "node 5"}));
}

TEST(GltfCameraTest, BadCamerasAreRefused) {
  const auto refused = [](json perspective, json node, std::initializer_list<std::string> words) {
    GltfBuilder b;
    WithCamera(&b, std::move(perspective), std::move(node), "lens");
    const std::string path = b.Write();
    ExpectInputError([&] { ReadCameras(GltfFile(path)); }, {"camera 0 'lens'"});
    ExpectInputError([&] { ReadCameras(GltfFile(path)); }, words);
  };
  refused(json::object(), json::object(), {"perspective.yfov is missing"});
  refused({{"yfov", 0}}, json::object(), {"yfov is 0"});
  refused({{"yfov", 3.2}}, json::object(), {"yfov is 3.2", "less than pi"});
  refused({{"yfov", 1}, {"aspectRatio", -1}}, json::object(), {"aspectRatio is -1"});
  refused({{"yfov", 1}}, {{"scale", {0, 0, 0}}}, {"scales its axes to nothing"});
}

}  // namespace
}  // namespace lobe
