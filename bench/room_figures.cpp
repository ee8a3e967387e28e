// Solves rooms drawn by a seed and holds them against the path tracer: room_figures FIRST LAST [FOLDER]. A
// row a room, then how many fail which bound, by what is in them. FOLDER gets scenes and pictures (picture,
// path tracer, difference).

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "render/compare.h"
#include "render/png.h"
#include "tests/support/rooms/room_trial.h"
#include "tests/support/scene_glb.h"

namespace lobe {
namespace {

using test::GeneratedRoom, test::RoomTrial;

std::string Joined(const auto& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

void PrintHeading() {
  std::printf(
      "| room | size m | nodes | steps | plain | mean %% | block %% | imbalance %% | sharp %% | solve, "
      "plain, picture, "
      "paths CPU s | fails | warnings | features |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void PrintRow(const GeneratedRoom& room, const RoomTrial& trial) {
  const auto steps = [](const test::Run& run) {
    return std::to_string(run.steps) + (run.converged() ? "" : std::string(" ") + Name(run.stop));
  };
  std::printf("| %llu | %.3g | %zu | %s | %s |", static_cast<unsigned long long>(room.seed),
              double(room.size), trial.nodes, steps(trial.solve).c_str(), steps(trial.plain).c_str());
  if (trial.view) {
    std::printf(" %+.2f ± %.2f | %.2f ± %.2f%s |", 100 * trial.view->bias, 100 * trial.view->bias_noise,
                100 * trial.view->block_error, 100 * trial.view->block_error_noise,
                trial.block_bound_holds ? "" : " (no bound)");
  } else {
    std::printf(" | |");
  }
  std::printf(" %.2f | %.0f | %.1f, %.1f, %.1f, %.1f | %s | %zu | %s |\n", 100 * trial.imbalance,
              100 * room.sharp_area, trial.solve.cpu_seconds, trial.plain.cpu_seconds,
              trial.view ? trial.view->picture_seconds : 0, trial.view ? trial.view->path_seconds : 0,
              Joined(trial.Failures()).c_str(), trial.warnings.size(), Joined(room.features).c_str());
  for (const std::string& warning : trial.warnings) std::printf("|   warning: %s\n", warning.c_str());
  std::fflush(stdout);
}

void WriteFiles(const GeneratedRoom& room, const RoomTrial& trial, const std::string& folder) {
  const std::string name = folder + "/room_" + std::to_string(room.seed);
  test::WriteSceneGlb(room.scene, name + ".glb");
  if (!trial.view) return;
  const Image& picture = trial.view->picture;
  const Image& reference = trial.view->reference;
  double mean = 0;
  for (const Rgb& p : reference.pixels) mean += double(p.mean()) / double(reference.pixels.size());
  Image shown = SideBySide({&picture, &reference});
  for (Rgb& p : shown.pixels) p *= float(0.3 / mean);
  const Image difference = DifferencePicture(picture, reference, nullptr, mean);
  WritePng(SideBySide({&shown, &difference}), 0, name + ".png");
}

/// Of one feature: rooms, and how many of them fail each bound.
struct Tally {
  int rooms = 0, failing = 0;
  std::map<std::string, int> failures;
};

void PrintTallies(const std::map<std::string, Tally>& tallies) {
  const char* const kBounds[] = {"diverged", "steps", "unresolved", "mean", "block"};
  std::printf("\n| feature | rooms | failing |");
  for (const char* bound : kBounds) std::printf(" %s |", bound);
  std::printf("\n|---|---|---|---|---|---|---|---|\n");
  for (const auto& [feature, tally] : tallies) {
    std::printf("| %s | %d | %d |", feature.c_str(), tally.rooms, tally.failing);
    for (const char* bound : kBounds) {
      const auto found = tally.failures.find(bound);
      std::printf(" %d |", found == tally.failures.end() ? 0 : found->second);
    }
    std::printf("\n");
  }
}

int Main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr,
                 "room_figures FIRST LAST [FOLDER]: rooms of these seeds are solved and path traced\n");
    return 2;
  }
  const std::string folder = argc > 3 ? argv[3] : "";
  if (!folder.empty()) std::filesystem::create_directories(folder);
  std::map<std::string, Tally> tallies;
  PrintHeading();
  for (uint64_t seed = std::strtoull(argv[1], nullptr, 10); seed <= std::strtoull(argv[2], nullptr, 10);
       ++seed) {
    const GeneratedRoom room(seed);
    const RoomTrial trial(room);
    PrintRow(room, trial);
    if (!folder.empty()) WriteFiles(room, trial, folder);
    std::set<std::string> features = room.features;
    features.insert("(all)");
    for (const std::string& feature : features) {
      Tally& tally = tallies[feature];
      ++tally.rooms;
      const std::vector<std::string> failures = trial.Failures();
      tally.failing += !failures.empty();
      for (const std::string& failure : failures) ++tally.failures[failure];
    }
  }
  PrintTallies(tallies);
  return 0;
}

}  // namespace
}  // namespace lobe

int main(int argc, char** argv) { return lobe::Main(argc, argv); }
