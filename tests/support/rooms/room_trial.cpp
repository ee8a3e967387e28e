#include "tests/support/rooms/room_trial.h"

#include <cmath>
#include <ctime>

#include "render/compare.h"
#include "render/emitter_mask.h"
#include "render/path_tracing.h"
#include "render/renderer.h"
#include "solver/solver.h"

namespace lobe::test {
namespace {

/// CPU seconds of the process from construction on.
class Stopwatch {
 public:
  double seconds() const { return Now() - start_; }

 private:
  static double Now() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
  }
  double start_ = Now();
};

/// Independent pictures of one view, summed in two halves.
class PathTracedHalves {
 public:
  PathTracedHalves(const Scene& scene, const CameraView& view, const RenderOptions& options, const Mask& mask)
      : paths_(scene), view_(view), options_(options), mask_(mask) {
    for (Image& half : sums_) half = Image(options.width, options.height);
  }

  void AddPass() {
    options_.seed = 1000 + means_.size();
    const Image pass = RenderPathTraced(paths_, view_, options_);
    Image& sum = sums_[means_.size() % 2];
    double mean = 0, count = 0;
    for (size_t i = 0; i < pass.pixels.size(); ++i) {
      sum.pixels[i] += pass.pixels[i];
      if (mask_.set[i]) continue;
      mean += double(pass.pixels[i].mean());
      ++count;
    }
    means_.push_back(mean / count);
  }

  int passes() const { return static_cast<int>(means_.size()); }
  Image Half(int which) const {
    Image half = sums_[which];
    const auto passes_of_half = static_cast<float>((passes() + 1 - which) / 2);
    for (Rgb& pixel : half.pixels) pixel /= passes_of_half;
    return half;
  }
  /// Standard error of the mean over the unmasked pixels, relative to it.
  double MeanNoise() const {
    const double n = passes();
    double sum = 0, squares = 0;
    for (const double m : means_) sum += m, squares += m * m;
    const double mean = sum / n;
    return std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1)) / mean;
  }

 private:
  PathTracer paths_;
  CameraView view_;
  RenderOptions options_;
  const Mask& mask_;
  Image sums_[2];
  std::vector<double> means_;
};

Run RunOf(const Solution& solution, double cpu_seconds) {
  return {solution.stop_reason, solution.history.empty() ? 0 : solution.history.back().step,
          solution.residual(), cpu_seconds};
}

// The estimate of the squared error is a mean over blocks of (d + n)(d + n'), d their errors, n and n' noise
// of this rms: its variance is 2 d^2 n^2 + n^4 over the number of blocks.
double NoiseOfBlockError(double error, double noise, double blocks) {
  const double of_square = std::sqrt((2 * error * error * noise * noise + std::pow(noise, 4)) / blocks);
  return error > 0 ? std::min(of_square / (2 * error), std::sqrt(of_square)) : std::sqrt(of_square);
}

/// Takes the figures from the two halves. `block_bound_holds`: is the block error to be told from
/// kBlockBound?
void ReadFigures(const PathTracedHalves& halves, const TrialOptions& options, bool block_bound_holds,
                 ViewFigures* out) {
  const Image a = halves.Half(0), b = halves.Half(1);
  const Comparison comparison = Compare(out->picture, a, &b, &out->mask);
  constexpr double kPixelsOfBlock = 64;
  out->passes = halves.passes();
  out->bias = comparison.bias;
  out->bias_noise = halves.MeanNoise();
  out->block_error = comparison.block_error;
  out->block_error_noise = NoiseOfBlockError(comparison.block_error, *comparison.reference_block_noise,
                                             double(comparison.pixels) / kPixelsOfBlock);
  out->reference = MiddleOf(a, &b);
  out->reference_mean = comparison.reference_mean;
  const bool blocks_told =
      !block_bound_holds || out->block_error_noise < options.block_error_noise ||
      std::abs(out->block_error - kBlockBound) > kStandardErrors * out->block_error_noise;
  out->resolved = blocks_told && out->bias_noise < options.mean_noise;
}

ViewFigures LookAtView(const Solution& solution, const Scene& scene, const TrialOptions& options,
                       bool block_bound_holds) {
  RenderOptions render;
  render.width = render.height = options.size;
  render.samples_per_pixel = options.samples;
  const CameraView view(scene.cameras[0], options.size, options.size);
  ViewFigures out;
  const Stopwatch picture_time;
  const Renderer renderer(solution);
  out.picture = renderer.Render(view, render, nullptr);
  out.picture_seconds = picture_time.seconds();

  const Stopwatch path_time;
  out.mask = EmitterMask(scene, RayTracer(scene), view, render);
  render.samples_per_pixel = options.pass_samples;
  PathTracedHalves halves(scene, view, render, out.mask);
  while (halves.passes() < options.most_passes && !out.resolved) {
    do {
      halves.AddPass();
    } while (halves.passes() < options.least_passes || halves.passes() % 4 != 0);
    ReadFigures(halves, options, block_bound_holds, &out);
  }
  out.path_seconds = path_time.seconds();
  return out;
}

}  // namespace

SolveOptions DefaultsFor(const Scene& scene) {
  SolveOptions options;
  options.mesh.max_edge = scene.Bounds().sizes().maxCoeff() / 15;
  return options;
}

RoomTrial::RoomTrial(const GeneratedRoom& room, const TrialOptions& options)
    : block_bound_holds(room.sharp_area < 0.1 && !room.solid_glass && room.lamps_seen_directly) {
  SolveOptions solve_options = DefaultsFor(room.scene);
  const Stopwatch solve_time;
  const Solution solution = Solve(room.scene, solve_options);
  solve = RunOf(solution, solve_time.seconds());
  nodes = solution.mesh.node_count();
  imbalance = solution.ledger.RelativeImbalance();
  warnings = solution.scene.warnings;

  // Only as many plain sweeps as tell whether the bound holds.
  if (solve.steps > kMoreSteps + 1) {
    solve_options.accelerate = false;
    if (solve.converged()) solve_options.max_steps = solve.steps - kMoreSteps - 1;
    const Stopwatch plain_time;
    const Solution plain_solution = Solve(room.scene, solve_options);
    plain = RunOf(plain_solution, plain_time.seconds());
  }

  if (solve.converged()) view = LookAtView(solution, room.scene, options, block_bound_holds);
}

std::vector<std::string> RoomTrial::Failures() const {
  std::vector<std::string> out;
  if (!solve.converged()) out.push_back("diverged");
  if (plain.converged() && solve.steps > plain.steps + kMoreSteps) out.push_back("steps");
  if (!view) return out;
  if (!view->resolved) out.push_back("unresolved");
  if (std::abs(view->bias) > kMeanBound + kStandardErrors * view->bias_noise) out.push_back("mean");
  if (block_bound_holds && view->block_error > kBlockBound + kStandardErrors * view->block_error_noise) {
    out.push_back("block");
  }
  return out;
}

}  // namespace lobe::test
