#include "solver/viewing_file.h"

#include <cmath>
#include <cstring>
#include <set>

#include <gtest/gtest.h>

#include "scene/gltf_file.h"
#include "solver/half_values.h"
#include "solver/solution_document.h"
#include "tests/support/every_kind_of_solution.h"
#include "tests/support/input_errors.h"
#include "tests/support/keep_files.h"
#include "tests/support/scratch_folder.h"

namespace lobe {
namespace {

using nlohmann::json;
using test::EveryKindOfSolution;
using test::ExpectInputError;
using test::KeepForValidator;
using test::ScratchFolder;
using test::WriteWholeFile;

constexpr const char* kExtension = "LOBE_directional_radiance";

std::string Write(const ScratchFolder& folder, const std::string& name, const Solution& s,
                  ViewingPrecision precision) {
  const std::vector<uint8_t> bytes = ViewingFile(s, precision, name);
  const std::string path = folder.File(name);
  WriteWholeFile(path, {bytes.begin(), bytes.end()});
  KeepForValidator(path);
  return path;
}

/// The extensions on primitives, by patch.
std::vector<json> Patches(const GltfFile& file) {
  std::vector<json> patches;
  for (const json& mesh : file.json()["meshes"]) {
    for (const json& primitive : mesh["primitives"]) {
      const json& own = primitive["extensions"][kExtension];
      patches.resize(std::max(patches.size(), own["patch"].get<size_t>() + 1));
      patches[own["patch"].get<size_t>()] = own;
    }
  }
  return patches;
}

/// Lobes as a reader of halves makes them.
NodeLobes ReadHalves(const GltfFile& file, const Solution& s) {
  NodeLobes lobes = s.total;
  const std::vector<json> patches = Patches(file);
  for (uint32_t p = 0; p < patches.size(); ++p) {
    const PartDegrees& d = lobes.patch_degrees(p);
    const auto part = [&](const char* name, const char* scale) {
      std::vector<float> values;
      if (!patches[p].contains(name)) return values;
      for (const uint32_t bits : file.ReadIndices(patches[p][name], name)) {
        values.push_back(FromHalf(uint16_t(bits), patches[p][scale].get<float>()));
      }
      return values;
    };
    const std::vector<float> base = part("base", "baseScale"), gloss = part("gloss", "glossScale");
    const size_t nodes = s.mesh.patches[p].node_end - s.mesh.patches[p].node_begin;
    const size_t b = size_t(3) * d.base_count(), g = size_t(3) * d.gloss_count();
    EXPECT_EQ(base.size(), b * nodes);
    EXPECT_EQ(gloss.size(), g * nodes);
    float* to = lobes.patch_values(p).data();
    for (size_t i = 0; i < nodes; ++i) {
      to = std::copy_n(base.data() + i * b, b, to);
      to = std::copy_n(gloss.data() + i * g, g, to);
    }
  }
  return lobes;
}

TEST(ViewingFileTest, FloatsAreTheSolutionsBitForBit) {
  const ScratchFolder folder;
  const Solution s = EveryKindOfSolution();
  const GltfFile file(Write(folder, "viewing_float.glb", s, ViewingPrecision::kFloat));
  const std::vector<json> patches = Patches(file);
  ASSERT_EQ(patches.size(), s.mesh.patches.size());
  for (uint32_t p = 0; p < patches.size(); ++p) {
    for (const bool gloss : {false, true}) {
      const std::vector<float> wanted = PartValues(s.total, p, gloss);
      const char* name = gloss ? "gloss" : "base";
      ASSERT_EQ(patches[p].contains(name), !wanted.empty());
      if (wanted.empty()) continue;
      const std::vector<float> found = file.ReadFloats(patches[p][name], 1, name);
      ASSERT_EQ(found.size(), wanted.size());
      EXPECT_EQ(std::memcmp(found.data(), wanted.data(), sizeof(float) * found.size()), 0);
    }
  }
}

TEST(ViewingFileTest, HalvesKeepEveryCoefficientAndTheFlux) {
  const ScratchFolder folder;
  const Solution s = EveryKindOfSolution();
  const GltfFile file(Write(folder, "viewing_half.glb", s, ViewingPrecision::kHalf));
  const NodeLobes halves = ReadHalves(file, s);
  for (uint32_t p = 0; p < s.mesh.patches.size(); ++p) {
    const auto a = s.total.patch_values(p), b = halves.patch_values(p);
    float largest = 0;
    for (const float v : a) largest = std::max(largest, std::abs(v));
    for (size_t i = 0; i < a.size(); ++i) {
      // solver/half_values.h; the largest of both parts is no less than that of one.
      EXPECT_LE(std::abs(b[i] - a[i]), std::max(std::ldexp(std::abs(a[i]), -11), std::ldexp(largest, -39)));
    }
  }
  const std::vector<double> area = NodeAreas(s.mesh, s.hidden);
  Eigen::Array3d before = Eigen::Array3d::Zero(), after = before;
  for (uint32_t i = 0; i < s.mesh.node_count(); ++i) {
    before += area[i] * s.total.Flux(i).cast<double>();
    after += area[i] * halves.Flux(i).cast<double>();
  }
  // Each coefficient keeps 2^-11 = 4.9e-4 of itself at worst, and roundings go both ways.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c] / before[c], 1, 5e-4);
}

TEST(ViewingFileTest, HoldsWhatLookingNeedsAndNothingElse) {
  const ScratchFolder folder;
  for (const auto precision : {ViewingPrecision::kFloat, ViewingPrecision::kHalf}) {
    const GltfFile file(Write(folder, "v.glb", EveryKindOfSolution(), precision));
    const json& record = file.json()["extensions"][kExtension];
    EXPECT_EQ(record["version"], 1);
    EXPECT_EQ(record["viewing"], true);
    EXPECT_FALSE(record.contains("faces"));
    for (const char* name : {"basis", "frame", "surfaceNames", "exposureScale", "settings", "ledger"}) {
      EXPECT_TRUE(record.contains(name)) << name;
    }
    const std::set<std::string> known = {"patch",  "material",  "surface",  "side",
                                         "planar", "hidden",    "lMaxBase", "lMaxGloss",
                                         "base",   "baseScale", "gloss",    "glossScale"};
    for (const json& patch : Patches(file)) {
      for (const auto& [name, value] : patch.items()) EXPECT_TRUE(known.count(name)) << name;
      EXPECT_EQ(patch.contains("baseScale"), precision == ViewingPrecision::kHalf && patch.contains("base"));
    }
    EXPECT_EQ(file.json()["cameras"].size(), 2u);
  }
}

TEST(ViewingFileTest, MaterialsTellTheirHemisphericalAlbedo) {
  const ScratchFolder folder;
  const Solution s = EveryKindOfSolution();
  const GltfFile file(Write(folder, "v.glb", s, ViewingPrecision::kHalf));
  const json& materials = file.json()["extensions"][kExtension]["materials"];
  ASSERT_EQ(materials.size(), s.scene.materials.size());
  for (size_t m = 0; m < materials.size(); ++m) {
    const Rgb albedo(materials[m]["albedo"][0].get<float>(), materials[m]["albedo"][1].get<float>(),
                     materials[m]["albedo"][2].get<float>());
    if (const auto* lambert = std::get_if<Lambert>(&s.scene.materials[m].reflectance)) {
      EXPECT_TRUE((albedo == lambert->albedo).all()) << "exact";
    }
    EXPECT_TRUE((albedo >= 0).all() && (albedo < 1).all());
  }
}

TEST(ViewingFileTest, IsRefusedWhereASolutionIsNeeded) {
  const ScratchFolder folder;
  const std::string path = Write(folder, "v.glb", EveryKindOfSolution(), ViewingPrecision::kFloat);
  EXPECT_TRUE(IsSolution(path));
  ExpectInputError([&] { ReadSolution(path); }, {"v.glb", "lobe export", "viewing", "lobe solve"});
}

}  // namespace
}  // namespace lobe
