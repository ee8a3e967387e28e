#pragma once

#include <vector>

#include "solver/ledger.h"
#include "solver/options.h"

namespace lobe {

/// How the next sweep through the links is to be done. All of it follows from the residuals so far, so that a
/// solve that is resumed goes on as it would have gone.
struct SweepPlan {
  /// Shoot ahead this share of what a coarse solution suggests; 0: a plain sweep. A sweep that leaves no less
  /// than there was is taken back.
  float ahead = 0;
  /// Where the coarse solution says that more than this many times what came should have come, it is
  /// corrected (CoarseTransport). Ordinary rooms have 0.4 to 2.4 (docs/validation.md#coarse). After a failure
  /// every cluster that is overrated is.
  double most_overrated = 4;
  /// Every so many-th link: sparse links suffice for light that is dim against the first bounce, since the
  /// noise of a step is in proportion to what it moves. After a failure all links: they settle slow light
  /// sooner.
  int thinning = 1;
  /// Limit on the degree of what is sent. Lowered each time that a plain sweep leaves no less than there was.
  /// At 0 all senders are diffuse; then a sweep multiplies the largest radiance by at most the largest
  /// albedo, so solves of albedos below 1 end.
  int degree_cap = 64;

  /// Failures after which a solve shoots ahead no more: sweeps that left no less than there was and were
  /// taken back, and such as left more than a plain sweep, the first time twice in a row. So a solve takes at
  /// most three sweeps more than plain ones do.
  static constexpr int kMostFailures = 2;
};

/// For the step that follows `history` (one record at least, that of emission).
SweepPlan PlanSweep(const std::vector<StepRecord>& history, const SolveOptions& options);

}  // namespace lobe
