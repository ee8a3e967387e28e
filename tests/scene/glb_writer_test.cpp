#include "scene/glb_writer.h"

#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include <gtest/gtest.h>

#include "scene/gltf_file.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace lobe {
namespace {

using test::ExpectInputError;
using test::ReadWholeFile;
using test::ScratchFolder;
using test::WriteWholeFile;
using Target = GlbWriter::Target;

uint32_t WordAt(const std::string& bytes, size_t at) {
  uint32_t word;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

std::vector<uint8_t> Bytes(const std::string& text) { return {text.begin(), text.end()}; }

GlbWriter Sample() {
  GlbWriter writer;
  EXPECT_EQ(writer.AddBytes(std::vector<uint8_t>{7, 8, 255}), 0);
  EXPECT_EQ(writer.AddFloats(std::vector<float>{1, -2, 3, 0.5f, 5, -6}, "VEC3", Target::kVertices, true), 1);
  EXPECT_EQ(writer.AddUints(std::vector<uint32_t>{0, 1, 4000000000u}, Target::kIndices), 2);
  writer.document["extras"]["note"] = "é";
  return writer;
}

void ExpectSample(const GltfFile& file) {
  EXPECT_EQ(file.ReadIndices(0, "bytes"), (std::vector<uint32_t>{7, 8, 255}));
  EXPECT_EQ(file.ReadFloats(1, 3, "positions"), (std::vector<float>{1, -2, 3, 0.5f, 5, -6}));
  EXPECT_EQ(file.ReadIndices(2, "indices"), (std::vector<uint32_t>{0, 1, 4000000000u}));
  EXPECT_EQ(file.json()["extras"]["note"], "é");
  EXPECT_EQ(file.json()["accessors"][1]["min"], (std::vector<float>{0.5f, -2, -6}));
  EXPECT_EQ(file.json()["accessors"][1]["max"], (std::vector<float>{1, 5, 3}));
  EXPECT_EQ(file.json()["bufferViews"][1]["target"], 34962);
  EXPECT_EQ(file.json()["bufferViews"][2]["target"], 34963);
  EXPECT_FALSE(file.json()["bufferViews"][0].contains("target"));
  for (const auto& view : file.json()["bufferViews"]) EXPECT_EQ(view["byteOffset"].get<int>() % 4, 0);
}

TEST(GlbWriterTest, GlbReadsBack) {
  const ScratchFolder folder;
  Sample().Write(folder.File("a.glb"));
  ExpectSample(GltfFile(folder.File("a.glb")));
  EXPECT_EQ(folder.Entries(), std::vector<std::string>{"a.glb"});
}

TEST(GlbWriterTest, BytesInMemoryAreThoseOfTheFile) {
  const ScratchFolder folder;
  GlbWriter writer = Sample();
  writer.AddShorts(std::vector<uint16_t>{1, 65535, 3});  // six bytes: the end is padded
  const std::vector<uint8_t> bytes = writer.Glb("sample.glb");
  writer.Write(folder.File("sample.glb"));
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), ReadWholeFile(folder.File("sample.glb")));
  const GltfFile file(folder.File("sample.glb"));
  EXPECT_EQ(file.ReadIndices(3, "shorts"), (std::vector<uint32_t>{1, 65535, 3}));
}

TEST(GlbWriterTest, ChunksArePaddedAndCounted) {
  const ScratchFolder folder;
  Sample().Write(folder.File("a.glb"));
  const std::string bytes = ReadWholeFile(folder.File("a.glb"));
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(WordAt(bytes, 4), 2u);
  EXPECT_EQ(WordAt(bytes, 8), bytes.size());
  const uint32_t json = WordAt(bytes, 12);
  EXPECT_EQ(json % 4, 0u);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  const uint32_t binary = WordAt(bytes, 20 + json);
  EXPECT_EQ(binary % 4, 0u);
  EXPECT_EQ(bytes.substr(24 + json, 4), std::string("BIN\0", 4));
  EXPECT_EQ(28 + json + binary, bytes.size());
}

TEST(GlbWriterTest, GltfKeepsItsDataInABinBesideIt) {
  const ScratchFolder folder;
  Sample().Write(folder.File("two words+100%.gltf"));
  EXPECT_EQ(folder.Entries(), (std::vector<std::string>{"two words+100%.bin", "two words+100%.gltf"}));
  const GltfFile file(folder.File("two words+100%.gltf"));
  ExpectSample(file);
  EXPECT_EQ(file.json()["buffers"][0]["uri"], "two%20words%2B100%25.bin");
}

TEST(GlbWriterTest, NeverReplacesABinaryThatBelongsToAnotherFile) {
  const ScratchFolder folder;
  Sample().Write(folder.File("a.gltf"));
  Sample().Write(folder.File("a.gltf"));  // its own may be replaced
  std::filesystem::rename(folder.File("a.gltf"), folder.File("other.gltf"));
  const std::string before = ReadWholeFile(folder.File("a.bin"));
  ExpectInputError([&] { Sample().Write(folder.File("a.gltf")); }, {"a.bin", "does not belong to", "a.gltf"});
  ExpectInputError([&] { CheckWritable(folder.File("a.gltf")); }, {"a.bin"});
  EXPECT_EQ(ReadWholeFile(folder.File("a.bin")), before);
  EXPECT_EQ(folder.Entries(), (std::vector<std::string>{"a.bin", "other.gltf"}));
}

TEST(GlbWriterTest, DocumentWithoutDataHasNoBinaryChunk) {
  const ScratchFolder folder;
  GlbWriter().Write(folder.File("a.glb"));
  const std::string bytes = ReadWholeFile(folder.File("a.glb"));
  EXPECT_EQ(20 + WordAt(bytes, 12), bytes.size());
  EXPECT_EQ(GltfFile(folder.File("a.glb")).json()["asset"]["version"], "2.0");
}

TEST(GlbWriterTest, NamesThatAreNotUtf8AreMended) {
  const ScratchFolder folder;
  GlbWriter writer;
  writer.document["extras"]["name"] = "caf\xe9";
  writer.Write(folder.File("a.glb"));
  EXPECT_EQ(GltfFile(folder.File("a.glb")).json()["extras"]["name"], "caf\xef\xbf\xbd");
}

TEST(GlbWriterTest, EmptyOrRaggedAccessorsAreAMistakeOfTheCaller) {
  GlbWriter writer;
  EXPECT_THROW(writer.AddUints({}, Target::kNone), std::invalid_argument);
  EXPECT_THROW(writer.AddFloats(std::vector<float>{1, 2}, "VEC3", Target::kNone), std::invalid_argument);
}

TEST(WriteFileAtomicallyTest, ReplacesWhatWasThere) {
  const ScratchFolder folder;
  WriteWholeFile(folder.File("a"), "old and longer");
  WriteFileAtomically(folder.File("a"), Bytes("new"));
  EXPECT_EQ(ReadWholeFile(folder.File("a")), "new");
  EXPECT_EQ(folder.Entries(), std::vector<std::string>{"a"});
}

TEST(WriteFileAtomicallyTest, SymbolicLinksStayAndTheirTargetIsReplaced) {
  const ScratchFolder folder;
  WriteWholeFile(folder.File("target"), "old");
  std::filesystem::create_symlink("target", folder.File("link"));
  WriteFileAtomically(folder.File("link"), Bytes("new"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.File("link")));
  EXPECT_EQ(ReadWholeFile(folder.File("target")), "new");
}

TEST(WriteFileAtomicallyTest, UnwritablePlacesAreToldInOneSentence) {
  const ScratchFolder folder;
  const auto bytes = Bytes("x");
  ExpectInputError([&] { WriteFileAtomically(folder.path(), bytes); }, {folder.path(), "is a directory"});
  ExpectInputError([&] { WriteFileAtomically(folder.File("no/such/a"), bytes); },
                   {"no/such/a", "No such file or directory"});
  WriteWholeFile(folder.File("file"), "");
  ExpectInputError([&] { WriteFileAtomically(folder.File("file/a"), bytes); }, {"file/a", "Not a directory"});
  ExpectInputError([&] { WriteFileAtomically("", bytes); }, {"empty"});
  ExpectInputError([&] { WriteFileAtomically(folder.File(std::string(300, 'a')), bytes); }, {"too long"});
  EXPECT_EQ(folder.Entries(), std::vector<std::string>{"file"});
}

TEST(WriteFileAtomicallyTest, DevicesAreWrittenAndNotReplaced) {
  WriteFileAtomically("/dev/null", Bytes("x"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  ExpectInputError([] { WriteFileAtomically("/dev/full", Bytes("x")); }, {"/dev/full", "No space left"});
}

TEST(WriteFileAtomicallyTest, FailureHalfwayKeepsTheOldFileAndLeavesNoOther) {
  const ScratchFolder folder;
  WriteWholeFile(folder.File("a.glb"), "old");
  // A limit on file sizes stands in for a full disk.
  rlimit before;
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 1000;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  GlbWriter writer;
  writer.AddFloats(std::vector<float>(10000), "SCALAR", Target::kNone);
  ExpectInputError([&] { writer.Write(folder.File("a.glb")); }, {"a.glb", "File too large"});
  ExpectInputError([&] { writer.Write(folder.File("a.gltf")); }, {"File too large"});
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(ReadWholeFile(folder.File("a.glb")), "old");
  EXPECT_EQ(folder.Entries(), std::vector<std::string>{"a.glb"});
}

TEST(CheckWritableTest, AgreesWithWritingAndLeavesNothing) {
  const ScratchFolder folder;
  CheckWritable(folder.File("a"));
  WriteWholeFile(folder.File("b"), "kept");
  CheckWritable(folder.File("b"));
  EXPECT_EQ(ReadWholeFile(folder.File("b")), "kept");
  EXPECT_EQ(folder.Entries(), std::vector<std::string>{"b"});
  ExpectInputError([&] { CheckWritable(folder.path()); }, {"is a directory"});
  ExpectInputError([&] { CheckWritable(folder.File("no/a")); }, {"no/a", "No such file"});
  ExpectInputError([&] { CheckWritable("/proc/nothing.glb"); }, {"/proc/nothing.glb", "cannot be written"});
}

}  // namespace
}  // namespace lobe
