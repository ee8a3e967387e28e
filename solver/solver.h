#pragma once

#include <atomic>
#include <functional>

#include "solver/solution.h"

namespace lobe {

struct Progress {
  int step;                 ///< 0: emission
  double fraction_of_step;  ///< 0..1
  double residual;          ///< unshot over emitted power
  double seconds;
  uint64_t rays;
  size_t nodes;
};

/// Where the time of the inner loop went, summed over threads, and how often lobes were touched. Times are
/// measured on one receiver in 16 and scaled, so that the clock does not slow what it measures.
struct TimeSplit {
  double choosing = 0;       ///< seconds: choosing delta areas, reading the shooters' lobes included
  double rays = 0;           ///< seconds: shadow rays
  double accumulation = 0;   ///< seconds: from arriving light to the receiver's lobe; reading links
  uint64_t lobe_reads = 0;   ///< directional evaluations of a shooter's lobe; 0 in a diffuse scene
  uint64_t lobe_writes = 0;  ///< contributions accumulated into a glossy receiver; 0 in a diffuse scene
};

struct SolveControl {
  /// Called from time to time, from one thread at a time.
  std::function<void(const Progress&)> progress;
  /// Set by a signal handler: the solver finishes nothing more and returns what it has, with kInterrupted.
  const std::atomic<bool>* stop = nullptr;
  TimeSplit* time_split = nullptr;
  /// Called between steps with a solution that is whole (kUnfinished): it renders, and Resume continues it.
  /// At least `checkpoint_seconds` apart (0: never) and ten times as long as a call takes; for the first time
  /// after emission, unless that was quick.
  std::function<void(const Solution&)> checkpoint;
  double checkpoint_seconds = 60;
};

/// Solves `scene`: exposure, tessellation, lobes, then progressive shooting until a limit of `options`.
/// A solution that did not converge is a result with a reason. Throws InputError if nothing emits light,
/// std::invalid_argument if options.Validate() complains. Same bits for any number of threads.
Solution Solve(Scene scene, const SolveOptions& options, const SolveControl& control = {});

/// Continues a solution that stopped early, with its own settings; of these the limits (`residual`,
/// `max_steps`, `max_seconds`, which counts this run alone) may be changed before. Links are traced anew, as
/// they were. The result has the bits of the run that was never stopped, seconds aside; a solution whose
/// limits are reached comes back at once. Throws InputError if `state` cannot be continued.
Solution Resume(Solution state, const SolveControl& control = {});

}  // namespace lobe
