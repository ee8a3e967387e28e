#include <chrono>
#include <memory>
#include <thread>

#include "app/browser.h"
#include "app/commands.h"
#include "app/http_server.h"
#include "app/interrupt.h"
#include "app/site.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

constexpr int kUsualPort = 8017;  // chosen: assigned to nothing that is common

struct ViewCommandFlags {
  std::string solution;
  std::optional<std::string> viewer;
  std::optional<int> port;
  bool half = false, no_browser = false;
};

/// The port asked for, or the usual one, or if that is taken any.
std::unique_ptr<HttpServer> TakePort(const std::optional<int>& port) {
  if (port) return std::make_unique<HttpServer>(*port);
  try {
    return std::make_unique<HttpServer>(kUsualPort);
  } catch (const InputError&) {
    return std::make_unique<HttpServer>(0);
  }
}

ExitCode RunView(const ViewCommandFlags& flags, Console& console) {
  if (flags.port && (*flags.port < 0 || *flags.port > 65535)) {
    throw UsageError("--port: " + std::to_string(*flags.port) + " is out of range: 0 to 65535 is expected");
  }
  SiteFiles site = ReadViewer(flags.viewer);
  const auto server = TakePort(flags.port);
  const SitePacking packing{flags.half ? ViewingPrecision::kHalf : ViewingPrecision::kFloat};
  const PackedSolution packed = AddSolution(flags.solution, packing, &site);
  if (!packed.trust.empty()) console.Warn(packed.trust);

  const std::atomic<bool>* interrupted = CatchInterrupts();
  server->Start(std::move(site));
  const std::string address = "http://127.0.0.1:" + std::to_string(server->port()) + "/";
  console.Result(address, {{"address", address},
                           {"port", server->port()},
                           {"nodes", packed.nodes},
                           {"solution_bytes", packed.bytes}});
  console.Say(Count(packed.nodes, "node") + ", " + Bytes(double(packed.bytes)) +
              "; for this machine only, until Ctrl-C");
  if (!flags.no_browser) OpenBrowser(address);
  while (!interrupted->load()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return kDone;
}

}  // namespace

void AddViewCommand(CLI::App& app, Command* command) {
  auto flags = std::make_shared<ViewCommandFlags>();
  CLI::App* sub = app.add_subcommand("view", "Walk through a solution in the browser");
  sub->footer(
      "Serves a page that shows the solution from anywhere, as its lobes say, and the lobe of any node "
      "clicked\n"
      "at. Prints the page's address, opens it if there is a desktop, and goes on until Ctrl-C (exit code "
      "0).\n"
      "Only this machine can reach it, whoever is logged in there. The solution is read once, at the start.\n"
      "\n"
      "From another machine: `ssh -L 8017:localhost:8017 HOST`, then http://localhost:8017/ there; or `lobe "
      "export`,\n"
      "which writes the same as static files.\n"
      "\n"
      "Examples:\n"
      "  lobe view solution.glb\n"
      "  lobe view solution.glb --port 9000 --no-browser\n"
      "  lobe view solution.glb --half");
  sub->add_option("SOLUTION", flags->solution, "Solution written by `lobe solve`")->type_name("")->required();
  sub->add_option(
         "--port", flags->port,
         "Port to serve at, 0 for any free one [" + std::to_string(kUsualPort) + ", or if taken any]")
      ->type_name("N");
  sub->add_flag("--no-browser", flags->no_browser, "Only print the address");
  sub->add_flag("--half", flags->half, "Send 16-bit halves: at most 0.05 % off, in half the bytes [float]");
  sub->add_option("--viewer", flags->viewer, "Folder of the built page [the one that came with Lobe]")
      ->type_name("DIR");
  sub->callback(
      [flags, command] { *command = [flags](Console& console) { return RunView(*flags, console); }; });
}

}  // namespace lobe
