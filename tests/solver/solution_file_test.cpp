#include "solver/solution.h"

#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scene/input_error.h"
#include "scene/refine.h"
#include "solver/baked_colours.h"
#include "tests/support/every_kind_of_solution.h"
#include "tests/support/keep_files.h"
#include "tests/support/mesh_laws.h"
#include "tests/support/scene_builder.h"
#include "tests/support/scratch_folder.h"

namespace lobe {
namespace {

using nlohmann::json;
using test::EveryKindOfScene;
using test::EveryKindOfSolution;
using test::FillLobes;
using test::KeepForValidator;
using test::MakeSolution;
using test::ReadWholeFile;
using test::SameBits;
using test::SceneBuilder;
using test::ScratchFolder;
using test::WriteWholeFile;

constexpr const char* kExtension = "LOBE_directional_radiance";

void ExpectSameBits(const NodeLobes& a, const NodeLobes& b) {
  ASSERT_EQ(a.patch_count(), b.patch_count());
  for (uint32_t p = 0; p < a.patch_count(); ++p) {
    EXPECT_EQ(a.patch_degrees(p), b.patch_degrees(p));
    const auto va = a.patch_values(p), vb = b.patch_values(p);
    ASSERT_EQ(va.size(), vb.size());
    if (!va.empty()) {
      EXPECT_EQ(std::memcmp(va.data(), vb.data(), va.size_bytes()), 0) << "patch " << p;
    }
  }
}

Solution RoundTrip(const Solution& solution) {
  const ScratchFolder folder;
  WriteSolution(solution, folder.File("s.glb"));
  return ReadSolution(folder.File("s.glb"));
}

TEST(SolutionFileTest, LobesComeBackBitForBit) {
  const Solution s = EveryKindOfSolution(), r = RoundTrip(s);
  ExpectSameBits(s.total, r.total);
  ExpectSameBits(s.direct, r.direct);
  ExpectSameBits(s.unshot, r.unshot);
  EXPECT_TRUE(SameBits(s.hidden, r.hidden));
}

TEST(SolutionFileTest, MeshAndSceneComeBackBitForBit) {
  const Solution s = EveryKindOfSolution(), r = RoundTrip(s);
  EXPECT_TRUE(SameBits(s.scene.positions, r.scene.positions));
  EXPECT_TRUE(SameBits(s.scene.normals, r.scene.normals));
  EXPECT_TRUE(SameBits(s.scene.faces, r.scene.faces));
  EXPECT_EQ(s.scene.surface_names, r.scene.surface_names);
  test::ExpectSameMesh(s.mesh, r.mesh);
}

TEST(SolutionFileTest, ARefinedMeshComesBackBitForBitAndRefinesAlike) {
  Solution s = EveryKindOfSolution();
  std::mt19937 random(5);
  const auto every_fifth = [&random](const Mesh& mesh) {
    std::vector<float> priority(mesh.element_count());
    for (float& p : priority) p = random() % 5 == 0 ? 1.0f : 0.0f;
    return priority;
  };
  for (int i = 0; i < 3; ++i) {
    s.mesh = RefineMesh(s.scene, s.mesh, every_fifth(s.mesh), s.options.mesh, size_t{1} << 20).mesh;
  }
  FillLobes(&s);
  const Solution r = RoundTrip(s);
  test::ExpectSameMesh(s.mesh, r.mesh);
  ExpectSameBits(s.total, r.total);
  const std::vector<float> priority = every_fifth(s.mesh);
  test::ExpectSameMesh(RefineMesh(s.scene, s.mesh, priority, s.options.mesh, size_t{1} << 20).mesh,
                       RefineMesh(r.scene, r.mesh, priority, r.options.mesh, size_t{1} << 20).mesh);
}

TEST(SolutionFileTest, PointsOfFacesAreFoundInTheSameElements) {
  const Solution s = EveryKindOfSolution(), r = RoundTrip(s);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  int dead = 0, alive = 0;
  for (uint32_t f = 0; f < s.scene.faces.size(); ++f) {
    for (const Side side : {Side::kFront, Side::kBack}) {
      for (int i = 0; i < 8; ++i) {
        float u = uniform(random), v = uniform(random);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Mesh::Location a = s.mesh.Locate(f, side, u, v), b = r.mesh.Locate(f, side, u, v);
        ASSERT_EQ(a.element, b.element);
        ++(a.element == kNone ? dead : alive);
        if (a.element != kNone) {
          EXPECT_EQ(std::memcmp(a.weight, b.weight, sizeof a.weight), 0);
        }
      }
    }
  }
  EXPECT_GT(dead, 0);
  EXPECT_GT(alive, 0);
}

TEST(SolutionFileTest, MaterialsOfEveryModelComeBackUnchanged) {
  const Scene scene = EveryKindOfScene();
  const Solution r = RoundTrip(MakeSolution(scene));
  const auto same = [](const Rgb& a, const Rgb& b) { return (a == b).all(); };
  ASSERT_EQ(scene.materials.size(), r.scene.materials.size());
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const Material &a = scene.materials[i], &b = r.scene.materials[i];
    SCOPED_TRACE(a.name);
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.double_sided, b.double_sided);
    EXPECT_TRUE(same(a.emission, b.emission)) << b.emission.transpose();
    ASSERT_EQ(a.reflectance.index(), b.reflectance.index());
    if (const auto* m = std::get_if<Lambert>(&a.reflectance)) {
      EXPECT_TRUE(same(m->albedo, std::get<Lambert>(b.reflectance).albedo));
    } else if (const auto* phong = std::get_if<Phong>(&a.reflectance)) {
      EXPECT_TRUE(same(phong->albedo, std::get<Phong>(b.reflectance).albedo));
      EXPECT_EQ(phong->exponent, std::get<Phong>(b.reflectance).exponent);
    } else if (const auto* ward = std::get_if<Ward>(&a.reflectance)) {
      EXPECT_TRUE(same(ward->albedo, std::get<Ward>(b.reflectance).albedo));
      EXPECT_EQ(ward->alpha, std::get<Ward>(b.reflectance).alpha);
    } else {
      const auto &x = std::get<MetallicRoughness>(a.reflectance),
                 &y = std::get<MetallicRoughness>(b.reflectance);
      EXPECT_TRUE(same(x.base_color, y.base_color));
      EXPECT_TRUE(same(x.specular_color, y.specular_color));
      EXPECT_EQ(x.metallic, y.metallic);
      EXPECT_EQ(x.roughness, y.roughness);
      EXPECT_EQ(x.ior, y.ior);
      EXPECT_EQ(x.specular, y.specular);
      EXPECT_EQ(x.has_specular, y.has_specular);
      EXPECT_EQ(x.diffuse_transmission, y.diffuse_transmission);
      EXPECT_TRUE(same(x.diffuse_transmission_color, y.diffuse_transmission_color));
      EXPECT_EQ(x.transmission, y.transmission);
      EXPECT_EQ(x.thickness, y.thickness);
      EXPECT_TRUE(same(x.attenuation_color, y.attenuation_color));
      EXPECT_EQ(x.attenuation_distance, y.attenuation_distance);
    }
  }
}

TEST(SolutionFileTest, CamerasComeBackBitForBit) {
  const Solution s = EveryKindOfSolution(), r = RoundTrip(s);
  ASSERT_EQ(s.scene.cameras.size(), r.scene.cameras.size());
  for (size_t i = 0; i < s.scene.cameras.size(); ++i) {
    const Camera &a = s.scene.cameras[i], &b = r.scene.cameras[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.fov_y, b.fov_y);
    EXPECT_EQ(a.aspect, b.aspect);
    for (const auto axis : {&Camera::eye, &Camera::right, &Camera::up, &Camera::back})
      EXPECT_EQ(a.*axis, b.*axis);
  }
}

TEST(SolutionFileTest, SettingsLedgerAndHistoryComeBack) {
  const Solution s = EveryKindOfSolution(), r = RoundTrip(s);
  EXPECT_EQ(s.options.mesh.max_edge, r.options.mesh.max_edge);
  EXPECT_EQ(s.options.lobes.error, r.options.lobes.error);
  EXPECT_EQ(s.options.lobes.force_l_max, r.options.lobes.force_l_max);
  EXPECT_EQ(s.options.light_samples, r.options.light_samples);
  EXPECT_EQ(s.options.residual, r.options.residual);
  EXPECT_EQ(s.options.max_seconds, r.options.max_seconds);
  EXPECT_EQ(s.options.seed, r.options.seed);
  EXPECT_EQ(s.material_kinds, r.material_kinds);
  EXPECT_EQ(s.material_errors, r.material_errors);
  EXPECT_EQ(s.ledger.emitted, r.ledger.emitted);
  EXPECT_EQ(s.ledger.imbalance, r.ledger.imbalance);
  EXPECT_EQ(s.ledger.mirrored, r.ledger.mirrored);
  ASSERT_EQ(r.history.size(), 2u);
  EXPECT_EQ(r.history[1].residual, 1.0 / 7);
  EXPECT_EQ(r.history[1].rays, 12'345'678'901u);
  EXPECT_EQ(r.history[1].shooters, 4'000'000'000u);
  EXPECT_EQ(r.stop_reason, StopReason::kTimeLimit);
  EXPECT_EQ(r.solve_seconds, 1.0 / 3);
}

TEST(SolutionFileTest, ReadingAndWritingAgainGivesTheSameFile) {
  const ScratchFolder folder;
  WriteSolution(EveryKindOfSolution(), folder.File("hand-made.glb"));
  WriteSolution(ReadSolution(folder.File("hand-made.glb")), folder.File("again.glb"));
  EXPECT_TRUE(ReadWholeFile(folder.File("hand-made.glb")) == ReadWholeFile(folder.File("again.glb")));
  KeepForValidator(folder.File("hand-made.glb"));
}

TEST(SolutionFileTest, GltfWithBinaryBesideItReadsTheSame) {
  const ScratchFolder folder;
  const Solution s = EveryKindOfSolution();
  WriteSolution(s, folder.File("hand-made-separate.gltf"));
  EXPECT_EQ(folder.Entries(),
            (std::vector<std::string>{"hand-made-separate.bin", "hand-made-separate.gltf"}));
  ExpectSameBits(s.total, ReadSolution(folder.File("hand-made-separate.gltf")).total);
  KeepForValidator(folder.File("hand-made-separate.gltf"));
}

TEST(SolutionFileTest, SolutionInWhichNothingIsLitIsStillAFile) {
  SceneBuilder b;
  b.AddTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, b.AddLambert(Rgb::Constant(0.5f)));
  const Solution s = MakeSolution(b.Build(), {false, false});
  const ScratchFolder folder;
  WriteSolution(s, folder.File("unlit-scene.glb"));
  const Solution r = ReadSolution(folder.File("unlit-scene.glb"));
  EXPECT_EQ(r.mesh.patches.size(), 0u);
  EXPECT_EQ(r.scene.faces.size(), 1u);
  KeepForValidator(folder.File("unlit-scene.glb"));
}

TEST(SolutionFileTest, DivergedSolutionCanBeReadBack) {
  Solution s = EveryKindOfSolution();
  s.stop_reason = StopReason::kNotConverging;
  s.history.back().residual = std::numeric_limits<double>::infinity();
  s.ledger.unshot = {1e300, -1e300, std::numeric_limits<double>::quiet_NaN()};
  const Solution r = RoundTrip(s);
  constexpr double kLargest = std::numeric_limits<float>::max();
  EXPECT_EQ(r.history.back().residual, kLargest);
  EXPECT_EQ(r.ledger.unshot, (Ledger::Power{kLargest, -kLargest, kLargest}));
}

TEST(SolutionFileTest, WriterLeavesNothingBehindWhenItCannotWrite) {
  const ScratchFolder folder;
  EXPECT_THROW(WriteSolution(EveryKindOfSolution(), folder.File("missing/s.glb")), InputError);
  EXPECT_TRUE(folder.Entries().empty());
}

/// What reading a file says; empty if it is accepted.
std::string Complaint(const std::string& path) {
  try {
    ReadSolution(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SolutionFileTest, SceneWithoutLobesIsRefusedAndToldWhatToDo) {
  const std::string scene = std::string(LOBE_TEST_DATA) + "/scenes/cornell_glossy.glb";
  EXPECT_FALSE(IsSolution(scene));
  EXPECT_EQ(Complaint(scene), scene + " is a scene, not a solution: run `lobe solve` first");
}

TEST(SolutionFileTest, WrittenFileIsRecognised) {
  const ScratchFolder folder;
  WriteSolution(EveryKindOfSolution(), folder.File("s.glb"));
  EXPECT_TRUE(IsSolution(folder.File("s.glb")));
  EXPECT_THROW(IsSolution(folder.File("missing.glb")), InputError);
}

TEST(SolutionFileTest, TruncatedFileIsRefused) {
  const ScratchFolder folder;
  WriteSolution(EveryKindOfSolution(), folder.File("s.glb"));
  const std::string whole = ReadWholeFile(folder.File("s.glb"));
  for (const size_t size : {size_t(0), size_t(11), size_t(200), whole.size() / 2, whole.size() - 1}) {
    WriteWholeFile(folder.File("cut.glb"), whole.substr(0, size));
    EXPECT_NE(Complaint(folder.File("cut.glb")).find("cut.glb"), std::string::npos) << size;
  }
}

/// A written solution as JSON, damaged and read.
class DamagedSolutionTest : public testing::Test {
 protected:
  void SetUp() override {
    WriteSolution(EveryKindOfSolution(), folder_.File("s.gltf"));
    document_ = json::parse(ReadWholeFile(folder_.File("s.gltf")));
  }

  /// Reading after `damage` must give one sentence that names the file and contains all of `words`.
  void ExpectRefused(const std::function<void(json&)>& damage, const std::vector<std::string>& words) {
    json damaged = document_;
    damage(damaged);
    WriteWholeFile(folder_.File("s.gltf"), damaged.dump());
    const std::string complaint = Complaint(folder_.File("s.gltf"));
    EXPECT_NE(complaint.find("s.gltf"), std::string::npos)
        << "not refused, or the file is not named: " << complaint;
    EXPECT_EQ(complaint.find('\n'), std::string::npos) << complaint;
    for (const std::string& word : words) {
      EXPECT_NE(complaint.find(word), std::string::npos) << '"' << word << "\" is not in: " << complaint;
    }
  }

  static json& Root(json& d) { return d["extensions"][kExtension]; }
  static json& Patch(json& d, size_t patch = 0) {
    for (json& mesh : d["meshes"]) {
      for (json& primitive : mesh["primitives"]) {
        json& own = primitive["extensions"][kExtension];
        if (own["patch"] == patch) return own;
      }
    }
    throw std::logic_error("no such patch");
  }
  /// The first patch that has member `name`.
  static json& PatchWith(json& d, const char* name) {
    for (size_t p = 0;; ++p) {
      if (Patch(d, p).contains(name)) return Patch(d, p);
    }
  }

  ScratchFolder folder_;
  json document_;
};

TEST_F(DamagedSolutionTest, UndamagedIsAccepted) { EXPECT_EQ(Complaint(folder_.File("s.gltf")), ""); }

TEST_F(DamagedSolutionTest, NewerVersionIsRefusedWithBothNumbers) {
  ExpectRefused([](json& d) { Root(d)["version"] = 2; }, {"version 2 found, 1 expected"});
  ExpectRefused([](json& d) { Root(d).erase("version"); }, {"version", "missing"});
  ExpectRefused([](json& d) { Root(d)["version"] = "one"; }, {"version", "\"one\""});
}

TEST_F(DamagedSolutionTest, OtherBasisOrFrameIsRefused) {
  ExpectRefused([](json& d) { Root(d)["basis"] = "Y"; }, {"basis", "\"Y\"", "'H'"});
  ExpectRefused([](json& d) { Root(d)["frame"] = "frisvad"; }, {"frame", "duff2017"});
}

TEST_F(DamagedSolutionTest, MissingAndMistypedMembersOfTheDocumentAreNamed) {
  ExpectRefused([](json& d) { Root(d).erase("settings"); }, {"maxEdge"});
  ExpectRefused([](json& d) { Root(d)["settings"]["maxEdge"] = -1; }, {"longest edge -1"});
  ExpectRefused([](json& d) { Root(d)["settings"]["contactDistance"] = -1; }, {"contact distance -1"});
  ExpectRefused([](json& d) { Root(d)["settings"]["seed"] = "12x"; }, {"seed", "12x"});
  ExpectRefused([](json& d) { Root(d)["settings"]["seed"] = "99999999999999999999"; }, {"seed"});
  ExpectRefused([](json& d) { Root(d)["stopReason"] = "bored"; }, {"stopReason", "bored", "converged"});
  ExpectRefused([](json& d) { Root(d)["materials"][1]["kind"] = "velvet"; },
                {"materials 1", "velvet", "mirror"});
  ExpectRefused([](json& d) { Root(d)["materials"] = json::array(); }, {"materials"});
  ExpectRefused([](json& d) { Root(d)["ledger"]["absorbed"] = {1, 2}; }, {"ledger", "absorbed"});
  ExpectRefused([](json& d) { Root(d)["history"][1]["rays"] = -5; }, {"history 1", "rays", "-5"});
  ExpectRefused([](json& d) { Root(d)["surfaceNames"][0] = 7; }, {"surfaceNames"});
  ExpectRefused([](json& d) { Root(d) = 7; }, {kExtension});
}

TEST_F(DamagedSolutionTest, FacesThatDoNotFitAreRefused) {
  ExpectRefused([](json& d) { Root(d)["faces"].erase("normals"); }, {"normals", "missing"});
  ExpectRefused([](json& d) { Root(d)["faces"]["positions"] = 99999; }, {"positions", "99999"});
  ExpectRefused([](json& d) { Root(d)["faces"]["material"] = Root(d)["faces"]["indices"]; },
                {"material", "has"});
  ExpectRefused([](json& d) { Root(d)["surfaceNames"] = {"one"}; }, {"surface", "below 1"});
  ExpectRefused(
      [](json& d) {
        while (Root(d)["materials"].size() > 2) Root(d)["materials"].erase(2);
      },
      {"material", "below 2"});
  ExpectRefused(
      [](json& d) { Root(d)["faces"]["normals"] = d["meshes"][0]["primitives"][0]["attributes"]["NORMAL"]; },
      {"normals", "elements"});
}

TEST_F(DamagedSolutionTest, PatchNumbersMustCount) {
  ExpectRefused([](json& d) { Patch(d, 1)["patch"] = 0; }, {"primitive", "patch"});
  ExpectRefused([](json& d) { Patch(d, 1)["patch"] = 1000; }, {"patch", "1000"});
  ExpectRefused([](json& d) { Patch(d, 1).erase("patch"); }, {"patch", "missing"});
}

TEST_F(DamagedSolutionTest, PrimitivesThatDoNotFitAreRefused) {
  ExpectRefused([](json& d) { Patch(d)["side"] = "left"; },
                {"primitive 0", "side", "left", "'front' or 'back'"});
  ExpectRefused([](json& d) { Patch(d)["material"] = 50; }, {"material", "50"});
  ExpectRefused([](json& d) { Patch(d)["material"] = 3; }, {"faces", "its own material"});
  ExpectRefused([](json& d) { Patch(d)["surface"] = -1; }, {"surface", "-1"});
  ExpectRefused([](json& d) { d["meshes"][0]["primitives"][0].erase("indices"); }, {"indices", "missing"});
  ExpectRefused([](json& d) { d["meshes"][0]["primitives"][0]["attributes"].erase("POSITION"); },
                {"POSITION"});
  ExpectRefused(
      [](json& d) {
        json& primitives = d["meshes"][0]["primitives"];
        primitives[0]["indices"] = d["meshes"][1]["primitives"][0]["indices"];
      },
      {"primitive 0"});
}

TEST_F(DamagedSolutionTest, TreesThatDoNotFitTheTrianglesAreRefused) {
  const auto length = [this](const char* name) {
    return document_["accessors"][Patch(document_)[name].get<int>()]["count"].get<int>();
  };
  ASSERT_GT(length("bisections"), 2);
  const auto shorten = [](json& d, const char* name) {
    json& count = d["accessors"][Patch(d)[name].get<int>()]["count"];
    count = count.get<int>() - 1;
  };
  ExpectRefused([&](json& d) { shorten(d, "bisections"); }, {"bisections", "ends within a tree"});
  ExpectRefused([&](json& d) { shorten(d, "faces"); }, {"bisections"});
  ExpectRefused(
      [](json& d) {  // the same face twice
        json& accessor = d["accessors"][Patch(d)["faces"].get<int>()];
        accessor = {{"componentType", 5125}, {"type", "SCALAR"}, {"count", accessor["count"]}};
      },
      {"faces", "comes again"});
  ExpectRefused([](json& d) { Patch(d)["bisections"] = Patch(d)["faces"]; }, {"bisections"});
  ExpectRefused([](json& d) { Patch(d)["faces"] = Patch(d)["bisections"]; }, {"faces"});
}

TEST_F(DamagedSolutionTest, LobesOfTheWrongLengthOrDegreeAreRefused) {
  ExpectRefused([](json& d) { PatchWith(d, "gloss")["lMaxGloss"] = 9; }, {"gloss", "elements, but it has"});
  ExpectRefused([](json& d) { PatchWith(d, "gloss")["lMaxGloss"] = 65; }, {"lMaxGloss", "65", "64"});
  ExpectRefused([](json& d) { PatchWith(d, "gloss")["lMaxGloss"] = 2.5; }, {"lMaxGloss", "2.5"});
  ExpectRefused([](json& d) { PatchWith(d, "gloss").erase("lMaxGloss"); }, {"gloss", "no lMax"});
  ExpectRefused([](json& d) { PatchWith(d, "base").erase("base"); }, {"base", "missing"});
  ExpectRefused([](json& d) { PatchWith(d, "base").erase("directBase"); }, {"directBase", "missing"});
  ExpectRefused([](json& d) { PatchWith(d, "base")["base"] = PatchWith(d, "base")["faces"]; }, {"base"});
  ExpectRefused([](json& d) { PatchWith(d, "hidden")["hidden"] = PatchWith(d, "hidden")["faces"]; },
                {"hidden"});
}

TEST_F(DamagedSolutionTest, SolutionWithoutUnshotLightIsAcceptedAsDone) {
  for (json& mesh : document_["meshes"]) {
    for (json& primitive : mesh["primitives"]) {
      primitive["extensions"][kExtension].erase("unshotBase");
      primitive["extensions"][kExtension].erase("unshotGloss");
    }
  }
  WriteWholeFile(folder_.File("s.gltf"), document_.dump());
  const Solution r = ReadSolution(folder_.File("s.gltf"));
  for (uint32_t node = 0; node < r.mesh.node_count(); ++node)
    EXPECT_EQ(r.unshot.Flux(node).abs().sum(), 0.0f);
}

TEST(BakedColoursTest, DiffuseNodesShowTheirRadianceScaled) {
  SceneBuilder b;
  const uint32_t white = b.AddLambert(Rgb::Constant(0.5f));
  b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, white);
  Solution s = MakeSolution(b.Build());
  s.hidden.assign(s.mesh.node_count(), 0);
  // Radiance (3, 2, 1) everywhere: constant H_00 = 1 / sqrt(2 pi).
  for (uint32_t node = 0; node < s.mesh.node_count(); ++node) {
    for (int c = 0; c < 3; ++c) s.total.base(node)[c] = float((3 - c) * std::sqrt(2 * M_PI));
  }
  const BakedColours colours = BakeColours(s);
  EXPECT_NEAR(colours.exposure_scale, 0.8 / 3, 1e-5);  // all percentiles are 3, brought to 0.8
  ASSERT_EQ(colours.rgb.size(), 3 * s.mesh.node_count());
  for (size_t i = 0; i < colours.rgb.size(); ++i)
    EXPECT_NEAR(colours.rgb[i], 0.8 * double(3 - i % 3) / 3, 1e-5);
}

TEST(BakedColoursTest, NineteenTwentiethsOfTheAreaAreExposedAndLampsBurnOut) {
  SceneBuilder b;
  const uint32_t white = b.AddLambert(Rgb::Constant(0.5f));
  b.AddQuad({0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, white);
  b.AddQuad({0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, b.AddEmitter(Rgb(50, 40, 30)));
  Solution s = MakeSolution(b.Build());
  s.hidden.assign(s.mesh.node_count(), 0);
  for (uint32_t node = 0; node < s.mesh.node_count(); ++node) {
    for (int c = 0; c < 3; ++c)
      s.total.base(node)[c] = s.mesh.node_patch[node] == 0 ? float(std::sqrt(2 * M_PI)) : 0;
  }
  const BakedColours colours = BakeColours(s);
  EXPECT_NEAR(colours.exposure_scale, 0.8, 1e-5);
  for (uint32_t node = 0; node < s.mesh.node_count(); ++node) {
    const bool lamp = s.mesh.node_patch[node] == 1;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(colours.rgb[3 * node + c], lamp ? 1.0 : 0.8, 1e-5);
  }
}

TEST(BakedColoursTest, HiddenNodesTakeTheirNeighboursColour) {
  SceneBuilder b;
  b.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, b.AddLambert(Rgb::Constant(0.5f)));
  Solution s = MakeSolution(b.Build());
  for (uint32_t node = 0; node < s.mesh.node_count(); ++node) {
    s.hidden[node] = node == 0;
    for (int c = 0; c < 3; ++c) s.total.base(node)[c] = node == 0 ? 0.0f : 1.0f;
  }
  const BakedColours colours = BakeColours(s);
  EXPECT_NEAR(colours.rgb[0], 0.8, 1e-5);
}

TEST(BakedColoursTest, StayWithinZeroAndOneWhateverTheLobes) {
  for (const float value : BakeColours(EveryKindOfSolution()).rgb) {
    EXPECT_GE(value, 0.0f);
    EXPECT_LE(value, 1.0f);
  }
}

TEST(BakedColoursTest, DarknessIsBlackAndKeepsTheScaleAtOne) {
  SceneBuilder b;
  b.AddTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, b.AddLambert(Rgb::Constant(0.5f)));
  Solution s = MakeSolution(b.Build());
  for (uint32_t p = 0; p < s.total.patch_count(); ++p) {
    for (float& value : s.total.patch_values(p)) value = 0;
  }
  const BakedColours colours = BakeColours(s);
  EXPECT_EQ(colours.exposure_scale, 1.0f);
  for (const float value : colours.rgb) EXPECT_EQ(value, 0.0f);
}

}  // namespace
}  // namespace lobe
