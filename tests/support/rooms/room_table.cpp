#include "tests/support/rooms/room_table.h"

#include <iomanip>
#include <sstream>

namespace lobe::test {
namespace {

const char* const kBounds[] = {"diverged", "steps", "unresolved", "mean", "block"};

std::string Joined(const auto& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

std::string Steps(const Run& run) {
  if (run.steps == 0) return "";
  const std::string steps = std::to_string(run.steps);
  if (run.stop == StopReason::kStepLimit) return "> " + steps;
  return run.converged() ? steps : steps + " " + Name(run.stop);
}

}  // namespace

std::string RoomHeading() {
  return "| room | size m | nodes | steps | plain sweeps | mean % | block % | imbalance % | sharp % | "
         "solve, plain, picture, paths CPU s | fails | warnings | features |\n"
         "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
}

std::string RoomRow(const GeneratedRoom& room, const RoomTrial& trial) {
  std::ostringstream out;
  const auto fixed = [&](int digits) -> std::ostream& {
    return out << std::defaultfloat << std::fixed << std::setprecision(digits);
  };
  out << "| " << room.seed << " | " << std::setprecision(3) << room.size << " | " << trial.nodes << " | "
      << Steps(trial.solve) << " | " << Steps(trial.plain) << " | ";
  if (trial.view) {
    fixed(2) << std::showpos << 100 * trial.view->bias << std::noshowpos << " ± "
             << 100 * trial.view->bias_noise << " | " << 100 * trial.view->block_error << " ± "
             << 100 * trial.view->block_error_noise << (trial.block_bound_holds ? "" : " (no bound)");
  } else {
    out << "|";
  }
  fixed(2) << " | " << 100 * trial.imbalance << " | ";
  fixed(0) << 100 * room.sharp_area << " | ";
  fixed(1) << trial.solve.cpu_seconds << ", " << trial.plain.cpu_seconds << ", "
           << (trial.view ? trial.view->picture_seconds : 0) << ", "
           << (trial.view ? trial.view->path_seconds : 0);
  out << " | " << Joined(trial.Failures()) << " | " << Joined(trial.warnings) << " | "
      << Joined(room.features) << " |\n";
  return out.str();
}

void RoomTally::Add(const GeneratedRoom& room, const RoomTrial& trial) {
  std::set<std::string> features = room.features;
  features.insert("(all)");
  const std::vector<std::string> failures = trial.Failures();
  for (const std::string& feature : features) {
    Count& count = by_feature_[feature];
    ++count.rooms;
    count.failing += !failures.empty();
    count.excused += !failures.empty() && !trial.warnings.empty();
    for (const std::string& failure : failures) ++count.failures[failure];
  }
}

std::string RoomTally::Table() const {
  std::ostringstream out;
  out << "| rooms with | rooms | failing | of them with a warning |";
  for (const char* bound : kBounds) out << " " << bound << " |";
  out << "\n|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [feature, count] : by_feature_) {
    out << "| " << feature << " | " << count.rooms << " | " << count.failing << " | " << count.excused
        << " |";
    for (const char* bound : kBounds) {
      const auto found = count.failures.find(bound);
      out << " " << (found == count.failures.end() ? 0 : found->second) << " |";
    }
    out << "\n";
  }
  return out.str();
}

}  // namespace lobe::test
