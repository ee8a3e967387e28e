#include "solver/sweep_plan.h"

#include <algorithm>

namespace lobe {
namespace {

int Thinning(double dim) { return dim > 0.3 ? 1 : dim > 0.1 ? 2 : dim > 0.03 ? 4 : 8; }

// Solves whose plain sweeps leave less take few anyway, and what they leave varies. (chosen)
constexpr double kLeftInAnyCase = 0.5;

// From where nothing is cut to senders that are all diffuse.
constexpr int kDegreeCaps[] = {64, 8, 4, 2, 1, 0};
constexpr int kLastCap = 5;

}  // namespace

SweepPlan PlanSweep(const std::vector<StepRecord>& history, const SolveOptions& options) {
  SweepPlan plan;
  int failures = 0, cap = 0;
  bool failed = false, doubtful = false;
  double plain = 1;
  for (size_t step = 1;; ++step) {
    plan.ahead = 0;
    // The first sweep is plain: it tells what plain ones leave. So are those that settle dim places only.
    const bool settling = history[step - 1].residual <= options.residual;
    if (options.accelerate && step > 1 && !settling && !failed && failures < SweepPlan::kMostFailures) {
      plan.ahead = 1.0f / float(1 << failures);
      plan.most_overrated = failures > 0 ? 1 : 4;
    }
    plan.thinning = 1;
    if (options.accelerate && options.thin_late_links && cap == 0 && failures == 0) {
      plan.thinning = Thinning(history[step - 1].residual / history[0].residual);
    }
    plan.degree_cap = kDegreeCaps[cap];
    if (step == history.size()) return plan;

    const double ratio = history[step].residual / history[step - 1].residual;
    failed = false;
    if (plan.ahead == 0) {
      plain = std::max(kLeftInAnyCase, ratio);
      if (!(ratio < 1) && cap < kLastCap) ++cap;
      doubtful = false;
    } else {
      // What has been sent too far is taken back in the next sweep, which may make up for this one.
      const bool slow = !(ratio <= plain);
      failed = !(ratio < 1) || (slow && (doubtful || failures > 0));
      failures += failed;
      doubtful = slow;
    }
  }
}

}  // namespace lobe
