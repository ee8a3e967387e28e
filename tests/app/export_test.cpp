// `lobe export`: the folder it writes, and what it leaves alone.

#include <algorithm>
#include <filesystem>
#include <memory>

#include <gtest/gtest.h>
#include <zlib.h>
#include <nlohmann/json.hpp>

#include "solver/viewing_file.h"
#include "tests/app/page_folder.h"
#include "tests/app/program.h"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;

std::string Text(const std::vector<uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

/// Names of all files in a folder and those within, sorted.
std::vector<std::string> FilesIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder).generic_string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string Gunzip(const std::string& path) {
  const gzFile file = gzopen(path.c_str(), "rb");
  std::string all, piece(1 << 16, '\0');
  for (int n; (n = gzread(file, piece.data(), unsigned(piece.size()))) > 0;) all.append(piece, 0, size_t(n));
  EXPECT_EQ(gzclose(file), Z_OK);
  return all;
}

class ExportTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new ScratchFolder;
    SolveCoarsely("cornell_glossy", shared_->File("room.glb"));
    MakePage(*shared_);
  }
  static void TearDownTestSuite() {
    delete shared_;
    shared_ = nullptr;
  }
  static std::string Solved() { return shared_->File("room.glb"); }
  static std::string Viewing(ViewingPrecision precision) {
    return Text(ViewingFile(ReadSolution(Solved()), precision, ""));
  }
  std::string Out() const { return folder_.File("out"); }
  ProgramResult Export(std::vector<std::string> more = {}, const ProgramOptions& options = {}) const {
    return ExportTo(Out(), more, options);
  }
  ProgramResult ExportTo(const std::string& folder, std::vector<std::string> more = {},
                         const ProgramOptions& options = {}) const {
    more.insert(more.begin(), {"export", Solved(), "-o", folder, "--viewer", shared_->File("page")});
    return RunLobe(more, options);
  }

  static ScratchFolder* shared_;
  ScratchFolder folder_;
};
ScratchFolder* ExportTest::shared_ = nullptr;

TEST_F(ExportTest, TheFolderHoldsThePageAndTheSolution) {
  const ProgramResult r = Export({"--json"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  EXPECT_EQ(folder_.Entries(), std::vector<std::string>{"out"});
  std::vector<std::string> wanted = FilesIn(shared_->File("page"));
  wanted.insert(wanted.end(), {"solution.glb", "view.json"});
  std::sort(wanted.begin(), wanted.end());
  EXPECT_EQ(FilesIn(Out()), wanted);
  for (const std::string& name : FilesIn(shared_->File("page"))) {
    EXPECT_EQ(ReadWholeFile(Out() + "/" + name), ReadWholeFile(shared_->File("page") + "/" + name));
  }
  EXPECT_EQ(ReadWholeFile(Out() + "/solution.glb"), Viewing(ViewingPrecision::kHalf));
  const auto view = nlohmann::json::parse(ReadWholeFile(Out() + "/view.json"));
  EXPECT_EQ(view["solution"], "solution.glb");
  EXPECT_EQ(view["title"], "room.glb");

  const auto json = nlohmann::json::parse(r.out);
  EXPECT_EQ(json["nodes"], ReadSolution(Solved()).mesh.node_count());
  EXPECT_EQ(json["solution_bytes"], fs::file_size(Out() + "/solution.glb"));
  size_t bytes = 0;
  for (const std::string& name : FilesIn(Out())) bytes += fs::file_size(Out() + "/" + name);
  EXPECT_EQ(json["bytes"], bytes);
}

TEST_F(ExportTest, FloatsAreWrittenIfAsked) {
  ASSERT_EQ(Export({"--float"}).exit_code, 0);
  EXPECT_EQ(ReadWholeFile(Out() + "/solution.glb"), Viewing(ViewingPrecision::kFloat));
}

TEST_F(ExportTest, PackedSolutionsUnpackToTheSameBytes) {
  ASSERT_EQ(Export({"--gzip"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(Out() + "/solution.glb"));
  EXPECT_EQ(Gunzip(Out() + "/solution.glb.gz"), Viewing(ViewingPrecision::kHalf));
  EXPECT_EQ(nlohmann::json::parse(ReadWholeFile(Out() + "/view.json"))["solution"], "solution.glb.gz");
}

TEST_F(ExportTest, TwoExportsAreEqual) {
  ASSERT_EQ(ExportTo(folder_.File("a"), {"--gzip"}).exit_code, 0);
  ASSERT_EQ(ExportTo(folder_.File("b"), {"--gzip"}).exit_code, 0);
  for (const std::string& name : FilesIn(folder_.File("a"))) {
    EXPECT_EQ(ReadWholeFile(folder_.File("a/" + name)), ReadWholeFile(folder_.File("b/" + name))) << name;
  }
}

TEST_F(ExportTest, AnEarlierExportOrAnEmptyFolderIsReplaced) {
  fs::create_directory(Out());
  ASSERT_EQ(Export({"--gzip"}).exit_code, 0);
  ASSERT_EQ(Export().exit_code, 0);
  EXPECT_TRUE(fs::exists(Out() + "/solution.glb"));
  EXPECT_FALSE(fs::exists(Out() + "/solution.glb.gz")) << "nothing of the earlier one is left";
  EXPECT_EQ(ExportTo(Out() + "/").exit_code, 0) << "with a slash, too";
  EXPECT_EQ(folder_.Entries(), std::vector<std::string>{"out"});
}

TEST_F(ExportTest, ASymbolicLinkStaysAndItsTargetIsReplaced) {
  fs::create_directory(folder_.File("real"));
  fs::create_directory_symlink(folder_.File("real"), Out());
  ASSERT_EQ(Export().exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(Out()));
  EXPECT_TRUE(fs::exists(folder_.File("real/view.json")));
}

TEST_F(ExportTest, AFolderOfOtherThingsIsLeftAlone) {
  fs::create_directory(Out());
  WriteWholeFile(Out() + "/thesis.tex", "years of work");
  ExpectOneSentence(Export(), 1, {Out(), "thesis.tex", "earlier export"});
  EXPECT_EQ(FilesIn(Out()), std::vector<std::string>{"thesis.tex"});
  // Beside an earlier export as well.
  fs::remove(Out() + "/thesis.tex");
  ASSERT_EQ(Export().exit_code, 0);
  WriteWholeFile(Out() + "/assets/thesis.tex", "years of work");
  ExpectOneSentence(Export({"--gzip"}), 1, {Out(), "assets/thesis.tex"});
  EXPECT_TRUE(fs::exists(Out() + "/solution.glb"));
  EXPECT_EQ(folder_.Entries(), std::vector<std::string>{"out"});
}

TEST_F(ExportTest, FoldersInAnEarlierExportAreLeftAloneToo) {
  ASSERT_EQ(Export().exit_code, 0);
  fs::create_directories(Out() + "/drafts/empty");
  ExpectOneSentence(Export(), 1, {Out(), "drafts", "earlier export"});
  EXPECT_TRUE(fs::exists(Out() + "/drafts/empty"));
}

TEST_F(ExportTest, WhatWasPrivateStaysPrivate) {
  fs::create_directory(Out());
  fs::permissions(Out(), fs::perms::owner_all);
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(Export().exit_code, 0);
    EXPECT_EQ(fs::status(Out()).permissions(), fs::perms::owner_all) << i;
  }
}

TEST_F(ExportTest, FoldersThatCannotBeReplacedAreToldBeforeTheSolutionIsRead) {
  const auto refused = [&](const std::string& place, const std::string& why) {
    ExpectOneSentence(RunLobe({"export", "no-solution.glb", "-o", place, "--viewer", shared_->File("page")}),
                      1, {place, why});
  };
  refused(".", "the folder you are in");
  fs::create_symlink("nowhere", folder_.File("link"));
  refused(folder_.File("link"), "symbolic link");
  refused("/proc", "mounted");
}

TEST_F(ExportTest, PlacesThatCannotBeWrittenAreToldBeforeTheSolutionIsRead) {
  WriteWholeFile(folder_.File("file"), "not a folder");
  const std::string page = shared_->File("page");
  for (const std::string& place :
       {folder_.File("file"), folder_.File("file/out"), folder_.File("no/such"), std::string("/proc/out")}) {
    ExpectOneSentence(RunLobe({"export", "no-solution.glb", "-o", place, "--viewer", page}), 1, {place});
  }
  EXPECT_EQ(ReadWholeFile(folder_.File("file")), "not a folder");
}

// As on a full disk.
TEST_F(ExportTest, AFullDiskIsOneSentenceAndKeepsWhatWasThere) {
  ProgramOptions options;
  options.file_size_limit = 20000;
  ExpectOneSentence(Export({}, options), 1, {Out() + ": cannot be written"});
  EXPECT_TRUE(folder_.Entries().empty());
  ASSERT_EQ(Export({"--gzip"}).exit_code, 0);
  ExpectOneSentence(Export({}, options), 1, {Out() + ": cannot be written"});
  EXPECT_TRUE(fs::exists(Out() + "/solution.glb.gz"));
  EXPECT_EQ(folder_.Entries(), std::vector<std::string>{"out"});
}

TEST_F(ExportTest, AnInterruptLeavesAllOrNothing) {
  for (int signals = 0; signals < 8; ++signals) {
    ProgramOptions options;
    auto sent = std::make_shared<bool>(false);
    // Once there is something to leave behind.
    options.on_tick = [&, sent](pid_t child) {
      if (*sent || folder_.Entries().empty()) return;
      *sent = true;
      kill(child, signals % 2 ? SIGINT : SIGTERM);
    };
    const ProgramResult r = Export({}, options);
    if (r.exit_code == 0) {
      EXPECT_EQ(folder_.Entries(), std::vector<std::string>{"out"});
      EXPECT_EQ(FilesIn(Out()).size(), FilesIn(shared_->File("page")).size() + 2);
      fs::remove_all(Out());
    } else {
      ExpectOneSentence(r, 1, {Out(), "interrupted"});
      EXPECT_TRUE(folder_.Entries().empty());
    }
  }
}

TEST_F(ExportTest, AViewingFileIsRefusedWhereASolutionIsNeeded) {
  ASSERT_EQ(Export().exit_code, 0);
  const std::string viewing = Out() + "/solution.glb";
  const std::vector<std::string> words = {viewing, "made by `lobe export`",
                                          "use the file that `lobe solve` wrote"};
  const std::string picture = folder_.File("a.png");
  ExpectOneSentence(RunQuietly({"render", viewing, "-o", picture}), 1, words);
  ExpectOneSentence(RunQuietly({"render", viewing, "--mode", "path", "-o", picture}), 1, words);
  ExpectOneSentence(RunQuietly({"inspect", viewing, "--node", "0"}), 1, words);
  ExpectOneSentence(RunQuietly({"info", viewing}), 1, words);
  ExpectOneSentence(RunQuietly({"solve", "--resume", viewing, "-o", folder_.File("b.glb")}), 1, words);
  ExpectOneSentence(
      RunQuietly({"export", viewing, "-o", folder_.File("c"), "--viewer", shared_->File("page")}), 1, words);
  ExpectOneSentence(RunQuietly({"solve", viewing, "-o", folder_.File("b.glb")}), 1, {viewing});
  EXPECT_EQ(folder_.Entries(), std::vector<std::string>{"out"});
}

TEST_F(ExportTest, WhatIsNoSolutionIsRefusedAndNothingIsWritten) {
  const std::string page = shared_->File("page"), cut = shared_->File("cut.glb");
  WriteWholeFile(cut, ReadWholeFile(Solved()).substr(0, 5000));
  ExpectOneSentence(RunLobe({"export", shared_->File("none.glb"), "-o", Out(), "--viewer", page}), 1,
                    {"none.glb"});
  ExpectOneSentence(RunLobe({"export", cut, "-o", Out(), "--viewer", page}), 1, {"cut.glb"});
  ExpectOneSentence(RunLobe({"export", ScenePath("cornell_glossy"), "-o", Out(), "--viewer", page}), 1,
                    {"scene", "lobe solve"});
  ExpectOneSentence(RunLobe({"export", Solved(), "-o", Out(), "--viewer", cut}), 1,
                    {"cut.glb", "index.html"});
  EXPECT_TRUE(folder_.Entries().empty());
}

TEST_F(ExportTest, SaysHowMuchItWrote) {
  const ProgramResult r = Export();
  EXPECT_EQ(r.out, "");
  for (const char* part : {"wrote", "files", "nodes", "bytes a node"}) {
    EXPECT_NE(r.err.find(part), std::string::npos) << r.err;
  }
}

}  // namespace
}  // namespace lobe::test
