#include "scene/gltf_file.h"

#include <cstring>

#include <gtest/gtest.h>

#include "scene/gltf_scene.h"
#include "tests/support/gltf_builder.h"
#include "tests/support/input_errors.h"
#include "tests/support/scene_builder.h"
#include "tests/support/scene_glb.h"
#include "tests/support/scratch_folder.h"

namespace lobe {
namespace {

using test::ExpectInputError;
using test::GltfBuilder;
using test::ReadWholeFile;
using test::ScratchFolder;
using test::WriteWholeFile;

constexpr int kByte = 5120, kUbyte = 5121, kShort = 5122, kUshort = 5123, kUint = 5125;

/// Opens a file that holds `bytes`; expects an error with `words` and the file's name.
void ExpectRefused(const std::string& bytes, const std::string& words) {
  const ScratchFolder folder;
  WriteWholeFile(folder.File("bad.glb"), bytes);
  ExpectInputError([&] { GltfFile(folder.File("bad.glb")); }, {"bad.glb", words});
}

std::string SampleGlb() {
  GltfBuilder b;
  b.Node({{"mesh", b.TriangleMesh()}});
  return ReadWholeFile(b.Write());
}

std::string WithWord(std::string bytes, size_t at, uint32_t word) {
  std::memcpy(bytes.data() + at, &word, sizeof word);
  return bytes;
}

TEST(GltfFileTest, WhatIsNoFileIsToldApart) {
  const ScratchFolder folder;
  ExpectInputError([&] { GltfFile(folder.File("none.glb")); }, {"none.glb", "no such file"});
  ExpectInputError([&] { GltfFile(folder.path()); }, {folder.path(), "directory"});
  ExpectInputError([&] { GltfFile("/dev/zero"); }, {"/dev/zero", "not a regular file"});
}

TEST(GltfFileTest, BrokenContainersAreToldApart) {
  const std::string good = SampleGlb();
  ExpectRefused("", "empty");
  ExpectRefused("PK\x03\x04 and more", "not a glTF 2.0 file");
  ExpectRefused(" \n ", "not a glTF 2.0 file");
  ExpectRefused("glTF", "truncated");
  ExpectRefused(good.substr(0, 18), "truncated");
  ExpectRefused(good.substr(0, good.size() - 1), "truncated");
  ExpectRefused(good + "more", "declares " + std::to_string(good.size()));
  ExpectRefused(WithWord(good, 4, 1), "version is 1, expected 2");
  ExpectRefused(WithWord(good, 12, 1u << 30), "chunk 0 reaches beyond");
  ExpectRefused(WithWord(good, 16, 0), "first chunk is not JSON");
}

TEST(GltfFileTest, BrokenJsonIsToldWithItsPlace) {
  ExpectRefused("{\"asset\": ", "malformed at byte 11");
  ExpectRefused("{\"asset\": {\"version\": \"1.0\"}}", "asset.version is '1.0', expected '2.0'");
  ExpectRefused("{}", "asset.version");
  ExpectRefused("{\"asset\": 3}", "asset is 3, expected an object");
  ExpectRefused("{\"asset\": {\"version\": \"2.0\"}, \"x\": 1e999}", "out of range");
  ExpectRefused("{\"asset\": {\"version\": \"2.0\"}, \"buffers\": {}}", "buffers is {}, expected an array");
  ExpectRefused("{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [7]}",
                "buffer 0: it is 7, expected an object");
  ExpectRefused("{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{}]}", "byteLength is missing");
  std::string deep = "{\"asset\": {\"version\": \"2.0\"}, \"extras\": ";
  for (int i = 0; i < 100000; ++i) deep += "[";
  ExpectRefused(deep, "nested");
}

TEST(GltfFileTest, BuffersComeFromDataUrisAndFiles) {
  const ScratchFolder folder;
  // 0, 1, 2 as bytes and four more in a file that is longer than declared.
  WriteWholeFile(folder.File("my data.bin"), std::string("\x05\x06\x07\x08 and more"));
  WriteWholeFile(folder.File("a.gltf"), R"({"asset": {"version": "2.0"},
    "buffers": [{"uri": "data:application/octet-stream;base64,AAEC", "byteLength": 3},
                {"uri": "my%20data.bin", "byteLength": 4}],
    "bufferViews": [{"buffer": 0, "byteLength": 3}, {"buffer": 1, "byteLength": 3, "byteOffset": 1}],
    "accessors": [{"bufferView": 0, "componentType": 5121, "type": "SCALAR", "count": 3},
                  {"bufferView": 1, "componentType": 5121, "type": "SCALAR", "count": 2, "byteOffset": 1}]})");
  const GltfFile file(folder.File("a.gltf"));
  EXPECT_EQ(file.ReadIndices(0, "first"), (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(file.ReadIndices(1, "second"), (std::vector<uint32_t>{7, 8}));
  EXPECT_EQ(file.AccessorCount(1), 2);
}

TEST(GltfFileTest, MissingBufferNamesFileAndIndex) {
  const ScratchFolder folder;
  const auto refused = [&](const std::string& buffer, const std::string& words) {
    WriteWholeFile(folder.File("a.gltf"), R"({"asset": {"version": "2.0"}, "buffers": [)" + buffer + "]}");
    ExpectInputError([&] { GltfFile(folder.File("a.gltf")); }, {"a.gltf", "buffer 0", words});
  };
  WriteWholeFile(folder.File("short.bin"), "abc");
  refused(R"({"uri": "gone.bin", "byteLength": 4})", "'gone.bin' is missing");
  refused(R"({"uri": "short.bin", "byteLength": 4})", "holds 3 bytes, expected 4");
  refused(R"({"uri": "data:application/octet-stream;base64,AAEC", "byteLength": 4})",
          "holds 3 bytes, expected 4");
  refused(R"({"uri": "data:application/octet-stream;base64,A*EC", "byteLength": 3})", "cannot be read");
  refused(R"({"uri": "data:video/mp4;base64,AAEC", "byteLength": 3})", "media type");
  refused(R"({"uri": "https://example.org/a.bin", "byteLength": 3})", "only files");
  refused(R"({"uri": 5, "byteLength": 3})", "uri is 5");
  refused(R"({"uri": "", "byteLength": 3})", "missing");
  refused(R"({"uri": "short.bin", "byteLength": -3})", "byteLength is -3");
  refused(R"({"uri": "short.bin", "byteLength": 1e18})", "byteLength is 1e+18");
}

TEST(GltfFileTest, NormalisedIntegersSpanTheirRange) {
  GltfBuilder b;
  const int ubytes = b.Packed({0, 51, 255, 0}, kUbyte, "VEC2", 2, true);
  const int bytes = b.Packed({0x80, 0x81, 0, 0x7f}, kByte, "SCALAR", 4, true);
  const int shorts = b.Packed({0x00, 0x80, 0xff, 0x7f}, kShort, "SCALAR", 2, true);
  const int ushorts = b.Packed({0xff, 0xff, 0x33, 0x33}, kUshort, "SCALAR", 2, true);
  const int plain = b.Packed({0xfe, 0xff, 0x03, 0x00}, kShort, "SCALAR", 2);
  const int uints = b.Packed({1, 0, 0, 128}, kUint, "SCALAR", 1);
  const GltfFile file(b.Write());
  EXPECT_EQ(file.ReadFloats(ubytes, 2, "x"), (std::vector<float>{0, 0.2f, 1, 0}));
  EXPECT_EQ(file.ReadFloats(bytes, 1, "x"), (std::vector<float>{-1, -1, 0, 1}));
  EXPECT_EQ(file.ReadFloats(shorts, 1, "x"), (std::vector<float>{-1, 1}));
  EXPECT_EQ(file.ReadFloats(ushorts, 1, "x"), (std::vector<float>{1, 0.2f}));
  EXPECT_EQ(file.ReadFloats(plain, 1, "x"), (std::vector<float>{-2, 3}));
  EXPECT_EQ(file.ReadFloats(uints, 1, "x"), (std::vector<float>{2147483649.0f}));
}

TEST(GltfFileTest, IndicesOfEveryWidth) {
  GltfBuilder b;
  const int bytes = b.Packed({0, 7, 255}, kUbyte, "SCALAR", 3);
  const int shorts = b.Packed({1, 2, 0xff, 0xff}, kUshort, "SCALAR", 2);
  const int ints = b.Uints({5, 0xfffffffeu});
  const int floats = b.Floats({1, 2, 3}, "SCALAR");
  const int pairs = b.Packed({1, 2}, kUbyte, "VEC2", 1);
  const GltfFile file(b.Write());
  EXPECT_EQ(file.ReadIndices(bytes, "x"), (std::vector<uint32_t>{0, 7, 255}));
  EXPECT_EQ(file.ReadIndices(shorts, "x"), (std::vector<uint32_t>{513, 65535}));
  EXPECT_EQ(file.ReadIndices(ints, "x"), (std::vector<uint32_t>{5, 0xfffffffeu}));
  ExpectInputError([&] { file.ReadIndices(floats, "indices of 'box'"); },
                   {"test.glb", "indices of 'box'", "accessor 3", "componentType is 5126"});
  ExpectInputError([&] { file.ReadIndices(pairs, "x"); }, {"type is \"VEC2\", expected SCALAR"});
  ExpectInputError([&] { file.ReadFloats(floats, 3, "x"); }, {"type is \"SCALAR\", expected VEC3"});
  ExpectInputError([&] { file.ReadFloats(9, 3, "x"); }, {"accessor 9 does not exist; the file has 5"});
  ExpectInputError([&] { file.ReadFloats(-1, 3, "x"); }, {"accessor -1 does not exist"});
}

TEST(GltfFileTest, InterleavedElementsAreReadByStride) {
  GltfBuilder b;
  const int a = b.Floats({1, 2, 3, 4, 5, 6, 7, 8}, "SCALAR");
  b.document()["bufferViews"][a]["byteStride"] = 16;
  b.document()["accessors"][a]["type"] = "VEC2";
  b.document()["accessors"][a]["count"] = 2;
  b.document()["accessors"][a]["byteOffset"] = 4;
  EXPECT_EQ(GltfFile(b.Write()).ReadFloats(a, 2, "x"), (std::vector<float>{2, 3, 6, 7}));
}

TEST(GltfFileTest, SparseValuesReplaceTheirElements) {
  GltfBuilder b;
  const int base = b.Floats({1, 2, 3, 4, 5, 6}, "VEC2");
  const int indices = b.Packed({2, 0}, kUbyte, "SCALAR", 2);
  const int values = b.Floats({50, 60, 10, 20}, "VEC2");
  const nlohmann::json sparse = {{"count", 2},
                                 {"indices", {{"bufferView", indices}, {"componentType", kUbyte}}},
                                 {"values", {{"bufferView", values}}}};
  b.document()["accessors"][base]["sparse"] = sparse;
  // Without a view the rest is zero.
  b.document()["accessors"].push_back(
      {{"componentType", 5126}, {"type", "VEC2"}, {"count", 4}, {"sparse", sparse}});
  const GltfFile file(b.Write());
  EXPECT_EQ(file.ReadFloats(base, 2, "x"), (std::vector<float>{10, 20, 3, 4, 50, 60}));
  EXPECT_EQ(file.ReadFloats(3, 2, "x"), (std::vector<float>{10, 20, 0, 0, 50, 60, 0, 0}));

  b.document()["accessors"][base]["count"] = 2;
  ExpectInputError([&] { GltfFile(b.Write()).ReadFloats(base, 2, "x"); },
                   {"sparse index 0 is 2, expected below 2"});
  b.document()["accessors"][base]["sparse"].erase("indices");
  ExpectInputError([&] { GltfFile(b.Write()).ReadFloats(base, 2, "x"); },
                   {"sparse.indices.componentType is missing"});
}

TEST(GltfFileTest, AccessorsOutsideTheirDataAreRefused) {
  struct Case {
    const char* pointer;
    nlohmann::json value;
    const char* words;
  };
  const Case cases[] = {
      {"/accessors/0/count", 4, "4 elements end at byte 48 of bufferView 0, which has 36"},
      {"/accessors/0/count", 0, "count is 0, expected at least 1"},
      {"/accessors/0/count", -1, "count is -1"},
      {"/accessors/0/count", 2147483648u, "2147483648 elements end at byte"},
      {"/accessors/0/count", 9007199254740992u, "count is 9007199254740992"},
      {"/accessors/0/count", 1e300, "count is 1e+300"},
      {"/accessors/0/byteOffset", 1, "end at byte 37"},
      {"/accessors/0/byteOffset", 9007199254740992u, "3 elements end at byte 9007199254741028"},
      {"/accessors/0/bufferView", 1, "bufferView is 1, expected an index of at most 0"},
      {"/accessors/0/bufferView", "x", "bufferView is \"x\""},
      {"/accessors/0/componentType", 5124, "componentType is 5124"},
      {"/accessors/0/type", "VEC9", "type is \"VEC9\", expected VEC3"},
      {"/bufferViews/0/byteLength", 400, "spans bytes 0 to 400, but buffer 0 has 36"},
      {"/bufferViews/0/byteOffset", 4, "spans bytes 4 to 40"},
      {"/bufferViews/0/buffer", 3, "buffer is 3"},
      {"/bufferViews/0/byteStride", 8, "byteStride is 8, expected at least 12"},
      {"/bufferViews/0", 5, "it is 5, expected an object"},
  };
  for (const Case& c : cases) {
    GltfBuilder b;
    b.TriangleMesh();
    b.document()[nlohmann::json::json_pointer(c.pointer)] = c.value;
    const GltfFile file(b.Write());
    ExpectInputError([&] { file.ReadFloats(0, 3, "positions"); },
                     {"test.glb", "positions", "accessor 0", c.words});
  }
  GltfBuilder b;
  b.document()["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", 1u << 31}});
  ExpectInputError([&] { GltfFile(b.Write()).ReadFloats(0, 3, "x"); },
                   {"count is 2147483648", "without a bufferView"});
}

TEST(GltfFileTest, DamagedFilesGiveASentenceOrAScene) {
  test::SceneBuilder scene;
  const uint32_t wood = scene.AddMaterial("wood", MetallicRoughness{}, Rgb(1, 2, 3), true);
  scene.AddBox({0, 0, 0}, {1, 2, 3}, wood);
  scene.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, scene.AddLambert(Rgb::Constant(0.3f)));
  scene.AddCamera("view0", {0, 0, 5}, {0, 0, 0});
  const ScratchFolder folder;
  test::WriteSceneGlb(scene.Build(), folder.File("good.glb"));
  const std::string good = ReadWholeFile(folder.File("good.glb"));

  int read = 0, refused = 0;
  const auto attempt = [&](const std::string& bytes) {
    try {
      const Scene s = ReadGltfScene(GltfFile("bad.glb", {bytes.begin(), bytes.end()}));
      for (const Face& f : s.faces) {
        for (const uint32_t v : f.vertex) ASSERT_LT(v, s.positions.size());
        ASSERT_LT(f.material, s.materials.size());
        ASSERT_LT(f.surface, s.surface_names.size());
      }
      ++read;
    } catch (const InputError& error) {
      ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      ASSERT_NE(std::string(error.what()).find("bad.glb"), std::string::npos) << error.what();
      ++refused;
    }
  };
  for (size_t n = 0; n < good.size(); n += 7) attempt(good.substr(0, n));
  // And with the declared length mended, so that what is inside breaks off.
  for (size_t n = 20; n < good.size(); n += 7)
    attempt(WithWord(good.substr(0, n), 8, static_cast<uint32_t>(n)));
  for (size_t at = 0; at < good.size(); ++at) {
    for (const int flip : {0x01, 0x10, 0x80}) {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ flip);
      attempt(bad);
    }
  }
  // Digits and punctuation of the JSON changed so that it stays JSON more often.
  const size_t json_end = good.find("BIN");
  for (size_t at = 20; at + 4 < json_end; ++at) {
    for (const char c : {'9', '-', 'e', '[', '"', ' '}) {
      std::string bad = good;
      bad[at] = c;
      attempt(bad);
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(read, 1000);
}

}  // namespace
}  // namespace lobe
