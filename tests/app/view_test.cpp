// `lobe view`: what it serves, to whom, and how it ends.

#include <cstdlib>
#include <filesystem>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "solver/viewing_file.h"
#include "tests/app/http_client.h"
#include "tests/app/page_folder.h"
#include "tests/app/program.h"
#include "tests/app/running_lobe.h"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string Text(const std::vector<uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

/// A socket that listens, so that nobody else can.
class TakenPort {
 public:
  explicit TakenPort(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(uint16_t(port));
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    // If it is another's already, it is taken as well.
    (void)!bind(socket_, reinterpret_cast<sockaddr*>(&at), size);
    listen(socket_, 1);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&at), &size);
    port_ = ntohs(at.sin_port);
  }
  ~TakenPort() { close(socket_); }
  int port() const { return port_; }

 private:
  int socket_, port_;
};

class ViewTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new ScratchFolder;
    SolveCoarsely("cornell_glossy", shared_->File("room.glb"));
    MakePage(*shared_);
    WriteWholeFile(shared_->File("secret.txt"), "secret");
  }
  static void TearDownTestSuite() {
    delete shared_;
    shared_ = nullptr;
  }
  static std::string Solution() { return shared_->File("room.glb"); }
  static std::vector<std::string> Arguments(const std::string& solution, std::vector<std::string> more = {},
                                            const std::string& page = shared_->File("page")) {
    more.insert(more.begin(), {"view", solution, "--viewer", page, "--no-browser", "--quiet"});
    return more;
  }
  /// Serves at any free port, until the end of the test.
  int Serve(std::vector<std::string> more = {}, const std::string& page = shared_->File("page")) {
    more.insert(more.end(), {"--port", "0"});
    view_ = std::make_unique<RunningLobe>(Arguments(Solution(), more, page));
    EXPECT_THAT(view_->first_line(), StartsWith("http://127.0.0.1:"));
    return std::atoi(view_->first_line().substr(17).c_str());
  }

  static ScratchFolder* shared_;
  std::unique_ptr<RunningLobe> view_;
};
ScratchFolder* ViewTest::shared_ = nullptr;

TEST_F(ViewTest, ServesThePageAndTheSolution) {
  const int port = Serve();
  EXPECT_THAT(Ask(port, "/").body, HasSubstr("stand-in"));
  EXPECT_EQ(Ask(port, "/index.html?a=b").body, Ask(port, "/").body);
  EXPECT_EQ(Ask(port, "/assets/index.js").body, "this is index.js");
  const auto view = nlohmann::json::parse(Ask(port, "/view.json").body);
  EXPECT_EQ(view["solution"], "solution.glb");
  EXPECT_EQ(view["title"], "room.glb");
  EXPECT_FALSE(view["version"].get<std::string>().empty());
  const HttpAnswer solution = Ask(port, "/solution.glb");
  EXPECT_EQ(solution.body, Text(ViewingFile(ReadSolution(Solution()), ViewingPrecision::kFloat, "")));
  const HttpAnswer head = Ask(port, "/solution.glb", "localhost", "HEAD");
  EXPECT_EQ(head.body, "");
  EXPECT_EQ(head.headers.at("Content-Length"), std::to_string(solution.body.size()));
}

TEST_F(ViewTest, EveryFileHasItsTypeAndIsNotCached) {
  const int port = Serve();
  for (const auto& [path, type] : {std::pair("/", "text/html; charset=utf-8"),
                                   {"/assets/index.js", "text/javascript; charset=utf-8"},
                                   {"/assets/index.css", "text/css; charset=utf-8"},
                                   {"/assets/draco.wasm", "application/wasm"},
                                   {"/assets/icon.svg", "image/svg+xml"},
                                   {"/assets/font.woff2", "font/woff2"},
                                   {"/assets/empty.json", "application/json"},
                                   {"/view.json", "application/json"},
                                   {"/solution.glb", "model/gltf-binary"}}) {
    const HttpAnswer answer = Ask(port, path);
    EXPECT_EQ(answer.status, 200) << path;
    EXPECT_EQ(answer.headers.at("Content-Type"), type) << path;
    EXPECT_EQ(answer.headers.at("Cache-Control"), "no-store") << path;
  }
}

TEST_F(ViewTest, SendsHalvesIfAsked) {
  const int port = Serve({"--half"});
  EXPECT_EQ(Ask(port, "/solution.glb").body,
            Text(ViewingFile(ReadSolution(Solution()), ViewingPrecision::kHalf, "")));
}

TEST_F(ViewTest, NamesThatLeadElsewhereAreNotFound) {
  const int port = Serve();
  for (const char* path : {"/no-such-file", "/../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt",
                           "/assets/../../secret.txt", "/assets/%2e%2e/%2e%2e/secret.txt", "/..\\secret.txt",
                           "//etc/passwd", "/etc/passwd", "/assets", "/assets/", "/index.html%00.txt",
                           "/./index.html", "secret.txt", "file:///etc/passwd", "/%ff%fe", "*"}) {
    const HttpAnswer answer = Ask(port, path);
    EXPECT_THAT(answer.status, ::testing::AnyOf(404, 400)) << path;
    EXPECT_LT(answer.body.size(), 100u) << path;
  }
  EXPECT_NE(Ask(port, "/" + std::string(100'000, 'a')).status, 200);
  EXPECT_EQ(Ask(port, "/").status, 200) << "still there";
}

// Against DNS rebinding: a page from elsewhere whose name was given this address.
TEST_F(ViewTest, OnlyThisMachinesOwnNamesAreAnswered) {
  const int port = Serve();
  for (const char* host :
       {"evil.example", "evil.example:80", "127.0.0.1.evil.example", "localhost.evil.example", "127.0.0.2",
        "[::2]", "[::1]evil", "localhost:1:2", "[", "", ":80"}) {
    const HttpAnswer answer = Ask(port, "/solution.glb", host);
    EXPECT_EQ(answer.status, 403) << host;
    EXPECT_LT(answer.body.size(), 100u);
  }
  for (const char* host : {"127.0.0.1", "localhost", "LocalHost:9000", "[::1]:8017"}) {
    EXPECT_EQ(Ask(port, "/", host).status, 200) << host;
  }
}

TEST_F(ViewTest, AnswersAtTheLoopbackAddressAlone) {
  const int port = Serve();
  EXPECT_TRUE(Connection(port).open());
  // Whoever listens at every address of the machine listens at this one too.
  EXPECT_FALSE(Connection(port, "127.0.0.2").open());
}

TEST_F(ViewTest, NothingCanBeWrittenAndNoPartIsSent) {
  const int port = Serve();
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "PATCH"}) {
    EXPECT_EQ(Ask(port, "/index.html", "localhost", method, "Content-Length: 0\r\n").status, 405) << method;
  }
  for (const char* range : {"bytes=0-999999999", "bytes=5-3", "bytes=0-0,2-3"}) {
    const HttpAnswer answer =
        Ask(port, "/index.html", "localhost", "GET", std::string("Range: ") + range + "\r\n");
    EXPECT_EQ(answer.status, 416) << range;
    EXPECT_LT(answer.body.size(), 500u);
  }
}

TEST_F(ViewTest, SignalsEndItWithinASecond) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Serve();
    const RunningLobe::End end = view_->Stop(signal);
    EXPECT_EQ(end.exit_code, 0);
    EXPECT_LT(end.seconds, 1);
  }
}

TEST_F(ViewTest, ClientsThatDawdleAreNotWaitedFor) {
  const ScratchFolder folder;
  const std::string page = MakePage(folder);
  WriteWholeFile(page + "/large.bin", std::string(30'000'000, 'x'));  // more than sockets hold
  const int port = Serve({}, page);
  Connection says_nothing(port), says_half(port), takes_nothing(port);
  says_half.Send("GET / HTTP/1.1\r\nHost: local");
  takes_nothing.Send("GET /large.bin HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(Ask(port, "/").status, 200) << "others are served meanwhile";
  const RunningLobe::End end = view_->Stop(SIGINT);
  EXPECT_EQ(end.exit_code, 0);
  EXPECT_LT(end.seconds, 1);
}

TEST_F(ViewTest, ATakenPortIsOneSentenceIfItWasNamed) {
  const TakenPort taken(0);
  const std::string port = std::to_string(taken.port());
  ExpectOneSentence(RunLobe(Arguments(Solution(), {"--port", port})), 1, {"port " + port, "in use"});
}

TEST_F(ViewTest, TwoServersDoNotShareAPort) {
  const std::string port = std::to_string(Serve());
  ExpectOneSentence(RunLobe(Arguments(Solution(), {"--port", port})), 1, {"port " + port, "in use"});
}

TEST_F(ViewTest, AnotherPortIsFoundIfTheUsualOneIsTaken) {
  const TakenPort taken(8017);
  RunningLobe view(Arguments(Solution(), {}));
  EXPECT_TRUE(view.first_line().starts_with("http://127.0.0.1:")) << view.first_line();
  EXPECT_NE(view.first_line(), "http://127.0.0.1:8017/");
  EXPECT_EQ(view.Stop(SIGINT).exit_code, 0);
}

TEST_F(ViewTest, ADesktopIsAskedToShowThePage) {
  const ScratchFolder folder;
  const std::string opened = folder.File("opened");
  WriteWholeFile(folder.File("xdg-open"), "#!/bin/sh\necho \"$1\" > '" + opened + ".part'\nmv '" + opened +
                                              ".part' '" + opened + "'\n");
  std::filesystem::permissions(folder.File("xdg-open"), std::filesystem::perms::owner_all);
  setenv("PATH", (folder.path() + ":" + std::getenv("PATH")).c_str(), 1);
  setenv("DISPLAY", ":7", 1);
  RunningLobe view({"view", Solution(), "--viewer", shared_->File("page"), "--port", "0", "--quiet"});
  for (int i = 0; i < 500 && !std::filesystem::exists(opened); ++i) usleep(10'000);
  EXPECT_EQ(ReadWholeFile(opened), view.first_line() + "\n");
  EXPECT_EQ(view.Stop(SIGINT).exit_code, 0);
}

TEST_F(ViewTest, AMissingPageSaysHowToGetIt) {
  const ScratchFolder folder;
  ExpectOneSentence(RunLobe({"view", Solution(), "--viewer", folder.path()}), 1,
                    {folder.path(), "Node.js 18", "npm", "--viewer"});
}

TEST_F(ViewTest, TheSourceOfThePageIsNotThePage) {
  const ScratchFolder folder;
  WriteWholeFile(folder.File("index.html"), "<!doctype html>");
  WriteWholeFile(folder.File("package.json"), "{}");
  ExpectOneSentence(RunLobe({"view", Solution(), "--viewer", folder.path()}), 1, {folder.path(), "source"});
}

TEST_F(ViewTest, SolutionsOfTwoFilesAreServedToo) {
  const ScratchFolder folder;
  SolveCoarsely("cornell_diffuse", folder.File("two.gltf"));
  RunningLobe view(Arguments(folder.File("two.gltf"), {"--port", "0"}));
  EXPECT_THAT(Ask(std::atoi(view.first_line().substr(17).c_str()), "/solution.glb").body, StartsWith("glTF"));
}

TEST_F(ViewTest, WhatIsNoSolutionIsRefused) {
  const ScratchFolder folder;
  WriteWholeFile(folder.File("cut.glb"), ReadWholeFile(Solution()).substr(0, 5000));
  WriteWholeFile(folder.File("viewing.glb"),
                 Text(ViewingFile(ReadSolution(Solution()), ViewingPrecision::kHalf, "")));
  ExpectOneSentence(RunLobe(Arguments(folder.File("none.glb"))), 1, {"none.glb"});
  ExpectOneSentence(RunLobe(Arguments(folder.File("cut.glb"))), 1, {"cut.glb"});
  ExpectOneSentence(RunLobe(Arguments(ScenePath("cornell_glossy"))), 1, {"scene", "lobe solve"});
  ExpectOneSentence(RunLobe(Arguments(folder.File("viewing.glb"))), 1, {"viewing.glb", "lobe export"});
}

TEST_F(ViewTest, PortsOutOfRangeAreWrongUsage) {
  ExpectOneSentence(RunLobe(Arguments("no.glb", {"--port", "65536"})), 2, {"--port", "65536"});
  ExpectOneSentence(RunLobe(Arguments("no.glb", {"--port", "-1"})), 2, {"--port", "-1"});
  ExpectOneSentence(RunLobe(Arguments("no.glb", {"--port", "http"})), 2, {"--port", "http"});
}

}  // namespace
}  // namespace lobe::test
