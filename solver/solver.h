#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "solver/memory.h"
#include "solver/solution.h"

namespace lobe {

enum class Phase {
  kPreparation,  ///< which sides light meets, tables of lobes, tessellation
  kEmission,     ///< straight light, and refinement of the mesh where it bends
  kLinks,
  kMirrors,  ///< emitters' light by way of mirrors
  kBounces,
};

struct Progress {
  Phase phase;
  int step;                  ///< 0 before light bounces
  double fraction_of_phase;  ///< 0..1, within a phase, or of kBounces within a step
  double residual;           ///< unshot over emitted power
  double seconds;            ///< of all runs
  uint64_t rays;             ///< of all runs
  double rays_per_second;    ///< of this run
  size_t nodes;
  std::optional<double> seconds_left;  ///< solver/time_left.h
};

/// Where the time of a solve went, wall seconds, and how often lobes were touched.
struct TimeSplit {
  double preparation = 0;    ///< lit sides, tessellation, lobe tables, ray tracer
  double emission = 0;       ///< shooting straight light, and refining the mesh for it
  double links = 0;          ///< tracing links, counting form factors of clusters
  double reflection = 0;     ///< sweeps, or shooting steps; light by way of mirrors
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
  /// Bytes that the solve may take, 0: any. More is refused with InputError before it is taken; a mesh is
  /// refined only as far as it fits (a warning in the solution's scene).
  double max_memory = 0;
  /// Told what the solve will need, before it is taken: when the first mesh is known, and again when it has
  /// been refined.
  std::function<void(const MemoryNeed&)> memory;
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
