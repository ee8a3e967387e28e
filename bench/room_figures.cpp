// Solves rooms drawn by a seed and holds them against the path tracer: room_figures FIRST LAST [FOLDER]. A
// row a room, then how many fail which bound, by what is in them. FOLDER gets scenes and pictures (the
// solution's, the path tracer's, their difference).

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "render/compare.h"
#include "render/png.h"
#include "tests/support/rooms/room_table.h"
#include "tests/support/scene_glb.h"

namespace lobe {
namespace {

void WriteFiles(const test::GeneratedRoom& room, const test::RoomTrial& trial, const std::string& folder) {
  const std::string name = folder + "/room_" + std::to_string(room.seed);
  test::WriteSceneGlb(room.scene, name + ".glb");
  if (!trial.view) return;
  const Image& picture = trial.view->picture;
  const Image& reference = trial.view->reference;
  Image shown = SideBySide({&picture, &reference});
  constexpr double kGrey = 0.3;  // of what is not masked
  for (Rgb& p : shown.pixels) p *= float(kGrey / trial.view->reference_mean);
  const Image difference =
      DifferencePicture(picture, reference, &trial.view->mask, trial.view->reference_mean);
  WritePng(SideBySide({&shown, &difference}), 0, name + ".png");
}

int Main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "room_figures FIRST LAST [FOLDER]: rooms of these seeds, solved and path traced\n");
    return 2;
  }
  const std::string folder = argc > 3 ? argv[3] : "";
  if (!folder.empty()) std::filesystem::create_directories(folder);
  test::RoomTally tally;
  std::printf("%s", test::RoomHeading().c_str());
  const uint64_t last = std::strtoull(argv[2], nullptr, 10);
  for (uint64_t seed = std::strtoull(argv[1], nullptr, 10); seed <= last; ++seed) {
    const test::GeneratedRoom room(seed);
    const test::RoomTrial trial(room);
    std::printf("%s", test::RoomRow(room, trial).c_str());
    std::fflush(stdout);
    tally.Add(room, trial);
    if (!folder.empty()) WriteFiles(room, trial, folder);
  }
  std::printf("\n%s", tally.Table().c_str());
  return 0;
}

}  // namespace
}  // namespace lobe

int main(int argc, char** argv) { return lobe::Main(argc, argv); }
