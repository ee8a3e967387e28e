#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/image.h"
#include "render/png.h"
#include "solver/solution.h"
#include "tests/support/rooms/generated_room.h"

namespace lobe::test {

/// What a room is tried with.
struct TrialOptions {
  int size = 96;         ///< pixels of the square view, each way
  int samples = 16;      ///< eye rays a pixel of the solution's view
  int pass_samples = 9;  ///< and of a pass of the path tracer
  /// The path tracer goes on until the standard error of its mean is below the first, relative, and, where
  /// kBlockBound holds, until the block error is clearly on one side of it or its standard error below the
  /// second; at most so many passes.
  double mean_noise = 0.004, block_error_noise = 0.003;
  int least_passes = 8, most_passes = 112;
};

/// What must hold (the bounds of the tests).
inline constexpr int kMoreSteps = 3;            ///< than plain sweeps
inline constexpr double kMeanBound = 0.02;      ///< of the view's mean
inline constexpr double kBlockBound = 0.05;     ///< rms of 8 x 8 blocks, where IsEasy
inline constexpr double kStandardErrors = 2.5;  ///< of the path tracer, that are allowed for

/// How a solve ended.
struct Run {
  StopReason stop = StopReason::kUnfinished;
  int steps = 0;
  double residual = 0;
  double cpu_seconds = 0;
  bool converged() const { return stop == StopReason::kConverged; }
};

/// The view of a solution beside the path tracer's. Lamps, and what is beside them in the picture, are
/// masked.
struct ViewFigures {
  double bias = 0, bias_noise = 0;               ///< of the mean, relative; standard error
  double block_error = 0;                        ///< unbiased of the path tracer's noise
  double block_error_noise = 0;                  ///< standard error of that
  int passes = 0;                                ///< of the path tracer
  bool resolved = false;                         ///< did the path tracer get as far as asked for?
  double picture_seconds = 0, path_seconds = 0;  ///< CPU
  Image picture, reference;
  Mask mask;
  double reference_mean = 0;  ///< of what is not masked
};

/// A room solved with the defaults, by plain sweeps, and path traced. Plain sweeps go on until it is known
/// whether the bound on steps holds; to their end if the solve did not converge.
struct RoomTrial {
  explicit RoomTrial(const GeneratedRoom& room, const TrialOptions& options = {});

  Run solve;
  Run plain;  ///< of 0 steps if not needed
  size_t nodes = 0;
  double imbalance = 0;
  std::vector<std::string> warnings;
  std::optional<ViewFigures> view;  ///< of solves that converged
  bool block_bound_holds;           ///< is the room of the kind that kBlockBound is for?

  /// One word each: "diverged", "steps", "unresolved", "mean", "block"; none: all holds.
  std::vector<std::string> Failures() const;
};

/// As `lobe solve` takes a scene when nothing is asked for.
SolveOptions DefaultsFor(const Scene& scene);

}  // namespace lobe::test
