#include <memory>

#include "app/commands.h"
#include "app/export_folder.h"
#include "app/interrupt.h"
#include "app/site.h"

namespace lobe {
namespace {

struct ExportFlags {
  std::string solution, folder;
  std::optional<std::string> viewer;
  bool full = false, gzip = false;
};

ExitCode RunExport(const ExportFlags& flags, Console& console) {
  const std::atomic<bool>* interrupted = CatchInterrupts();
  SiteFiles site = ReadViewer(flags.viewer);
  CheckExportFolder(flags.folder);
  const SitePacking packing{flags.full ? ViewingPrecision::kFloat : ViewingPrecision::kHalf, flags.gzip};
  const PackedSolution packed = AddSolution(flags.solution, packing, &site);
  if (!packed.trust.empty()) console.Warn(packed.trust);
  WriteExportFolder(flags.folder, site, *interrupted);

  const double per_node = packed.nodes > 0 ? double(packed.bytes) / double(packed.nodes) : 0;
  const size_t bytes = TotalBytes(site);
  console.Say("wrote " + flags.folder + ": " + Count(site.size(), "file") + ", " + Bytes(double(bytes)) +
              "; " + packed.file + " holds " + Count(packed.nodes, "node") + " in " +
              Bytes(double(packed.bytes)) + Format(", %.0f bytes a node", per_node));
  if (console.json()) {
    console.Result("", {{"output", flags.folder},
                        {"files", site.size()},
                        {"bytes", bytes},
                        {"solution", packed.file},
                        {"solution_bytes", packed.bytes},
                        {"nodes", packed.nodes},
                        {"bytes_per_node", per_node}});
  }
  return kDone;
}

}  // namespace

void AddExportCommand(CLI::App& app, Command* command) {
  auto flags = std::make_shared<ExportFlags>();
  CLI::App* sub = app.add_subcommand("export", "Write a folder for the web: a solution and its viewer");
  sub->footer(
      "The folder is what `lobe view` shows, as static files: a page to walk through the solution with, and "
      "the\n"
      "solution reduced to what looking needs (docs/format.md, \"Viewing files\"). Put it on any web "
      "server.\n"
      "Browsers do not open it from disk; to try it, `python3 -m http.server -d DIR`.\n"
      "\n"
      "Coefficients are 16-bit halves with a scale for each patch: at most 0.05 % off, in half the bytes.\n"
      "--gzip packs the solution, which the page unpacks itself: for servers that do not compress.\n"
      "An earlier export of that name is replaced, once the new one is complete; nothing else ever is.\n"
      "`lobe render` and the others still need the file that `lobe solve` wrote.\n"
      "\n"
      "Examples:\n"
      "  lobe export solution.glb -o public/room\n"
      "  lobe export solution.glb -o public/room --gzip\n"
      "  lobe export solution.glb -o public/room --float");
  sub->add_option("SOLUTION", flags->solution, "Solution written by `lobe solve`")->type_name("")->required();
  sub->add_option("-o,--output", flags->folder, "Folder to write")->type_name("DIR")->required();
  sub->add_flag("--float", flags->full, "Coefficients as 32-bit floats, bit for bit [half]");
  sub->add_flag("--gzip", flags->gzip, "Write solution.glb.gz in place of solution.glb");
  sub->add_option("--viewer", flags->viewer, "Folder of the built page [the one that came with Lobe]")
      ->type_name("DIR");
  sub->callback(
      [flags, command] { *command = [flags](Console& console) { return RunExport(*flags, console); }; });
}

}  // namespace lobe
