// LOBE_materials_brdf: every model there and back, and measured data by file or embedded.

#include "scene/gltf_brdf.h"

#include <gtest/gtest.h>

#include "scene/gltf_output.h"
#include "scene/gltf_scene.h"
#include "tests/support/brdf_models.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/input_errors.h"
#include "tests/support/scene_builder.h"
#include "tests/support/scene_glb.h"

namespace lobe {
namespace {

using nlohmann::json;
using test::ExpectInputError;
using test::GltfBuilder;

// A file whose materials have this extension, with `files` (name, bytes) beside it.
Scene ReadBrdfs(const std::vector<json>& brdfs,
                const std::vector<std::pair<std::string, std::string>>& files = {}) {
  GltfBuilder b;
  for (const json& brdf : brdfs) {
    b.document()["materials"].push_back({{"name", "paint"}, {"extensions", {{kBrdfExtension, brdf}}}});
  }
  b.Node({{"mesh", b.TriangleMesh()}});
  for (const auto& [name, bytes] : files) test::WriteWholeFile(b.folder().File(name), bytes);
  return ReadGltfScene(b.Write());
}

Material Of(const Reflectance& r) {
  Material m;
  m.reflectance = r;
  return m;
}

const char* const kTable =
    "0 0 0 0.1\n0 0 180 0.1\n0 60 0 0.2\n0 60 180 0.2\n60 0 0 0.2\n60 0 180 0.2\n60 60 0 0.3\n"
    "60 60 180 0.4\n";

TEST(GltfBrdfTest, ParametersAreRead) {
  const Scene s =
      ReadBrdfs({{{"model", "blinn-phong"}, {"albedo", {0.1, 0.2, 0.3}}, {"exponent", 77}},
                 {{"model", "cook-torrance"}, {"f0", {0.9, 0.8, 0.1}}, {"alpha", 0.11}},
                 {{"model", "oren-nayar"}, {"albedo", {0.1, 0.2, 0.3}}, {"sigma", 0.4}},
                 {{"model", "ashikhmin-shirley"},
                  {"diffuse", {0.1, 0.2, 0.3}},
                  {"specular", {0.05, 0.06, 0.07}},
                  {"exponent", 123}},
                 {{"model", "plastic"}, {"albedo", {0.1, 0.2, 0.3}}, {"ior", 1.4}, {"roughness", 0.25}}});
  const auto& blinn = std::get<BlinnPhong>(s.materials[0].reflectance);
  EXPECT_EQ(blinn.exponent, 77);
  EXPECT_EQ(blinn.albedo[2], 0.3f);
  const auto& cook = std::get<CookTorrance>(s.materials[1].reflectance);
  EXPECT_EQ(cook.alpha, 0.11f);
  EXPECT_EQ(cook.f0[1], 0.8f);
  const auto& oren = std::get<OrenNayar>(s.materials[2].reflectance);
  EXPECT_EQ(oren.sigma, 0.4f);
  EXPECT_EQ(oren.albedo[1], 0.2f);
  const auto& ashikhmin = std::get<AshikhminShirley>(s.materials[3].reflectance);
  EXPECT_EQ(ashikhmin.diffuse[0], 0.1f);
  EXPECT_EQ(ashikhmin.specular[2], 0.07f);
  EXPECT_EQ(ashikhmin.exponent, 123);
  const auto& plastic = std::get<Plastic>(s.materials[4].reflectance);
  EXPECT_EQ(plastic.ior(), 1.4f);
  EXPECT_EQ(plastic.roughness(), 0.25f);
  EXPECT_EQ(plastic.albedo()[0], 0.1f);
  EXPECT_TRUE(s.warnings.empty());
}

TEST(GltfBrdfTest, EveryModelComesBackAsItself) {
  test::SceneBuilder b;
  std::vector<test::ModelCase> models = test::AllModelCases();
  for (const auto& m : models) b.AddMaterial(Describe(m.r), m.r, Rgb::Zero(), true);
  b.AddTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
  const test::ScratchFolder folder;
  test::WriteSceneGlb(b.Build(), folder.File("a.glb"));
  const Scene after = ReadGltfScene(folder.File("a.glb"));
  ASSERT_EQ(after.materials.size(), models.size());
  const Vec3d wi = SphericalDirection(0.7, 0.2), wo = SphericalDirection(0.4, 2.9);
  for (size_t i = 0; i < models.size(); ++i) {
    const Reflectance &before = models[i].r, &back = after.materials[i].reflectance;
    EXPECT_EQ(Describe(back), Describe(before));
    EXPECT_TRUE((EvaluateBrdf(back, wi, wo) == EvaluateBrdf(before, wi, wo)).all()) << Describe(before);
    // As a second writing tells them, parameter by parameter.
    EXPECT_EQ(GltfMaterial(Of(back)), GltfMaterial(Of(before)));
    if (const auto* data = std::get_if<Measured>(&before)) {
      EXPECT_EQ(std::get<Measured>(back).data->values(), data->data->values()) << "bit for bit";
    }
  }
}

TEST(GltfBrdfTest, OutOfRangeParametersNameMaterialValueAndRange) {
  const auto refused = [](json brdf, std::initializer_list<std::string> words) {
    ExpectInputError([&] { ReadBrdfs({brdf}); }, {"test.glb: material 0 'paint': LOBE_materials_brdf"});
    ExpectInputError([&] { ReadBrdfs({brdf}); }, words);
  };
  refused({{"model", "toon"}}, {"model is \"toon\"", "\"oren-nayar\"", "\"measured\""});
  refused({{"model", "blinn-phong"}, {"exponent", 1e7}}, {"exponent is 10000000.0", "0 to 1e+06"});
  refused({{"model", "cook-torrance"}, {"alpha", 0}}, {"alpha is 0, expected 0.001 to 1"});
  refused({{"model", "cook-torrance"}, {"f0", {1.5, 0, 0}}}, {"f0 is [1.5,0,0]"});
  refused({{"model", "oren-nayar"}, {"sigma", 2}}, {"sigma is 2, expected 0 to 1.5708"});
  refused({{"model", "ashikhmin-shirley"}, {"specular", {0, 0, -1}}}, {"specular is [0,0,-1]"});
  refused({{"model", "plastic"}, {"ior", 0.9}}, {"ior is 0.9, expected 1 to 4"});
  refused({{"model", "plastic"}, {"roughness", 0}}, {"roughness is 0, expected 0.01 to 1"});
  refused({{"model", "measured"}}, {"neither uri nor values"});
  refused({{"model", "measured"}, {"uri", "a"}, {"values", 0}}, {"both uri and values"});
  refused({{"model", "measured"}, {"uri", 5}}, {"uri is 5, expected a string"});
  refused({{"model", "measured"}, {"uri", "http://x/y.csv"}},
          {"uri is \"http://x/y.csv\", expected a file beside"});
  refused({{"model", "measured"}, {"uri", "gone.binary"}}, {"uri: its file \"gone.binary\" is missing"});
  refused({{"model", "measured"}, {"values", 0}}, {"coordinates is missing"});
  refused({{"model", "measured"}, {"values", 0}, {"coordinates", "polar"}}, {"coordinates is \"polar\""});
}

TEST(GltfBrdfTest, MeasuredFilesBesideTheSceneAreReadOnceAndShared) {
  const json brdf = {{"model", "measured"}, {"uri", "my%20paint.csv"}};
  const Scene s = ReadBrdfs({brdf, brdf}, {{"my paint.csv", kTable}});
  const auto &a = std::get<Measured>(s.materials[0].reflectance),
             &b = std::get<Measured>(s.materials[1].reflectance);
  EXPECT_EQ(a.data, b.data) << "one copy";
  EXPECT_EQ(Describe(a), "measured my paint.csv");
  EXPECT_TRUE(s.warnings.empty());
  ExpectInputError(
      [&] {
        ReadBrdfs({brdf}, {{"my paint.csv", "rubbish\n0 0 0\n"}});
      },
      {"my paint.csv: line 2"});
  ExpectInputError(
      [&] {
        ReadBrdfs({{{"model", "measured"}, {"uri", "a.binary"}}}, {{"a.binary", "short"}});
      },
      {"a.binary: ends after 5 bytes"});
}

TEST(GltfBrdfTest, DataThatGainsEnergyIsWarnedOf) {
  std::string bright = kTable;
  for (size_t at; (at = bright.find("0.")) != std::string::npos;) bright.replace(at, 2, "3.");
  const Scene s = ReadBrdfs({{{"model", "measured"}, {"uri", "a.csv"}}}, {{"a.csv", bright}});
  ASSERT_EQ(s.warnings.size(), 1u);
  EXPECT_NE(s.warnings[0].find("material 0 'paint': its measured data reflects"), std::string::npos)
      << s.warnings[0];
}

TEST(GltfBrdfTest, EmbeddedDataIsWrittenOnceForAllItsMaterialsAndCheckedWhenRead) {
  const Measured data = test::MeasuredFrom(Ward{test::kModelColour, 0.3f}, 12, 6);
  GltfBuilder b;
  for (int i = 0; i < 2; ++i) b.document()["materials"].push_back(GltfMaterial(Of(data), &b.writer));
  EXPECT_EQ(b.document()["accessors"].size(), 4u);
  b.Node({{"mesh", b.TriangleMesh()}});
  const Scene s = ReadGltfScene(b.Write());
  const auto& read = std::get<Measured>(s.materials[0].reflectance);
  EXPECT_EQ(read.data, std::get<Measured>(s.materials[1].reflectance).data);
  EXPECT_EQ(read.data->digest(), data.data->digest());

  json& brdf = b.document()["materials"][0]["extensions"][kBrdfExtension];
  const json good = brdf;
  const auto refused = [&](std::initializer_list<std::string> words) {
    const std::string path = b.Write("bad.glb");
    ExpectInputError([&] { ReadGltfScene(path); }, {"bad.glb: material 0: LOBE_materials_brdf"});
    ExpectInputError([&] { ReadGltfScene(path); }, words);
    brdf = good;
  };
  brdf["axes"] = {0, 1};
  refused({"axes is [0,1], expected three accessors"});
  brdf["axes"] = {0, 1, 99};
  refused({"axes contains 99"});
  brdf["axes"] = {0, 1, 0};  // 12 instead of 6
  refused({"values, expected"});
  brdf["values"] = b.Floats(std::vector<float>(12 * 6 * 6 * 3, -1.0f), "SCALAR");
  refused({"value 0 is -1", "expected 0 to 1e9"});
}

// Materials of several kinds may point at one accessor.
TEST(GltfBrdfTest, EmbeddedDataFollowsFromItsCoordinatesAxesAndNameToo) {
  GltfBuilder b;
  const int angles = b.Floats({0, 1}, "SCALAR"), others = b.Floats({0, 1.5f}, "SCALAR");
  // The same for directions exchanged, so both kinds of coordinates take them.
  const int values = b.Floats(std::vector<float>(24, 0.1f), "SCALAR");
  const json first = {{"model", "measured"},
                      {"name", "paint"},
                      {"coordinates", "half-difference"},
                      {"axes", {angles, angles, angles}},
                      {"values", values}};
  const auto with = [&](const char* member, const json& value) {
    json brdf = first;
    brdf[member] = value;
    return brdf;
  };
  const auto read = [&](const std::vector<json>& brdfs) {
    json& materials = b.document()["materials"] = json::array();
    for (const json& brdf : brdfs) materials.push_back({{"extensions", {{kBrdfExtension, brdf}}}});
    std::vector<std::shared_ptr<const MeasuredBrdf>> data;
    const Scene s = ReadGltfScene(b.Write());
    for (size_t i = 0; i < brdfs.size(); ++i) {
      data.push_back(std::get<Measured>(s.materials[i].reflectance).data);
    }
    return data;
  };
  b.Node({{"mesh", b.TriangleMesh()}});
  const auto data = read({first, with("coordinates", "incident-outgoing"),
                          with("axes", {angles, angles, others}), with("name", "varnish"), first});
  EXPECT_EQ(data[1]->coordinates(), MeasuredBrdf::Coordinates::kIncidentOutgoing);
  EXPECT_EQ(data[2]->axes()[2][1], 1.5f);
  EXPECT_EQ(data[3]->name(), "varnish");
  for (const size_t i : {size_t{0}, size_t{4}}) {
    EXPECT_EQ(data[i]->coordinates(), MeasuredBrdf::Coordinates::kHalfDifference);
    EXPECT_EQ(data[i]->axes()[2][1], 1);
    EXPECT_EQ(data[i]->name(), "paint");
  }
  EXPECT_EQ(data[4], data[0]) << "one copy of what is the same";

  ExpectInputError(
      [&] {
        read({first, with("coordinates", "polar")});
      },
      {"material 1: LOBE_materials_brdf", "coordinates is \"polar\""});
  ExpectInputError([&] { read({first, with("axes", {angles, angles})}); }, {"material 1", "three accessors"});
  ExpectInputError([&] { read({first, with("name", 7)}); }, {"material 1", "name is 7"});
}

TEST(GltfBrdfTest, EqualDataOfTwoNamesIsWrittenOnceAndReadWithBoth) {
  const Measured paint = test::MeasuredFrom(Ward{test::kModelColour, 0.3f}, 12, 6);
  GltfBuilder b;
  for (const Measured& m : {paint, test::Renamed(paint, "varnish")}) {
    b.document()["materials"].push_back(GltfMaterial(Of(m), &b.writer));
  }
  EXPECT_EQ(b.document()["accessors"].size(), 4u);
  b.Node({{"mesh", b.TriangleMesh()}});
  const Scene s = ReadGltfScene(b.Write());
  EXPECT_EQ(std::get<Measured>(s.materials[0].reflectance).data->name(), paint.data->name());
  EXPECT_EQ(std::get<Measured>(s.materials[1].reflectance).data->name(), "varnish");
}

}  // namespace
}  // namespace lobe
