#include "solver/time_left.h"

#include <algorithm>
#include <cmath>

namespace lobe {
namespace {

constexpr size_t kSteps = 3;  // the last ones, which the next will be like (chosen)

}  // namespace

std::optional<double> SecondsLeft(const std::vector<StepRecord>& history, const SolveOptions& options,
                                  double fraction, double seconds_of_run) {
  if (history.size() < 3) return std::nullopt;
  const StepRecord& last = history.back();
  const size_t count = std::min(kSteps, history.size() - 1);
  const StepRecord& before = history[history.size() - 1 - count];
  const double dimming = std::log(last.residual / before.residual) / double(count);
  if (!(dimming < -1e-3)) return std::nullopt;
  double steps = std::ceil(std::log(options.residual / last.residual) / dimming);
  steps = std::min(steps, options.max_steps - double(history.size() - 1));
  const double pace = (last.seconds - before.seconds) / double(count);
  double left = std::max(0.0, steps - std::clamp(fraction, 0.0, 1.0)) * pace;
  if (options.max_seconds > 0) left = std::min(left, std::max(0.0, options.max_seconds - seconds_of_run));
  return left;
}

}  // namespace lobe
