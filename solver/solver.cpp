#include "solver/solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <numeric>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "scene/contacts.h"
#include "solver/exposure.h"
#include "solver/hash.h"
#include "solver/shooting.h"

namespace lobe {
namespace {

// Give up when this many steps together lower the residual by less than a per mille.
constexpr int kPatience = 25;

Ledger::Power& operator+=(Ledger::Power& a, const Eigen::Array3d& b) {
  for (int c = 0; c < 3; ++c) a[c] += b[c];
  return a;
}

class ProgressiveSolver {
 public:
  ProgressiveSolver(Scene scene, const SolveOptions& options, const SolveControl& control)
      : control_(control), start_(std::chrono::steady_clock::now()), tracer_(scene) {
    s_.scene = std::move(scene);
    s_.options = options;
    const auto lit = FindLitSides(s_.scene, tracer_, options.seed);
    s_.mesh = Tessellate(s_.scene, options.mesh, lit);
    exposure_ = FindExposure(s_.scene, s_.mesh, tracer_, options.seed);
    s_.hidden = exposure_.hidden;
    rays_ = exposure_.rays;
    area_ = NodeAreas(s_.mesh, s_.hidden);
    emitters_ = FindEmitters(s_.scene);

    TableCache cache;
    for (const auto& material : s_.scene.materials) {
      materials_.emplace_back(material.reflectance, options.lobes, cache);
      s_.material_kinds.push_back(materials_.back().kind());
      s_.material_errors.push_back(materials_.back().gloss.error);
    }
    std::vector<PartDegrees> degrees;
    for (const auto& patch : s_.mesh.patches) {
      const auto& lobes = materials_[patch.material];
      degrees.push_back({lobes.base.l_max, lobes.gloss.l_max});
    }
    s_.total = s_.direct = s_.unshot = gained_ = NodeLobes(s_.mesh, degrees);
    received_.assign(s_.mesh.node_count(), 0.0f);
    for (const auto& e : emitters_) {
      emitted_ += (e.radiance * (std::numbers::pi_v<float> * e.area)).cast<double>();
    }
    s_.ledger.emitted += emitted_;
  }

  Solution Run() {
    s_.ledger.sent += emitted_;
    s_.ledger.escaped += emitted_ * exposure_.emission_escaped;
    s_.ledger.blocked += emitted_ * exposure_.emission_blocked;
    const ShootingField emission(s_.mesh, emitters_);
    if (Step(0, emission, s_.options.light_samples, 0)) {
      s_.direct = s_.total;
      s_.stop_reason = Iterate();
    } else {
      // Told to stop before emission was through: all of it is still to be shot.
      s_.ledger.sent = s_.ledger.escaped = s_.ledger.blocked = {};
      s_.ledger.unshot += emitted_;
      s_.stop_reason = WhyStop();
    }
    Close();
    return std::move(s_);
  }

 private:
  double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  bool Interrupted() const { return control_.stop && control_.stop->load(std::memory_order_relaxed); }
  bool OutOfTime() const { return s_.options.max_seconds > 0 && Seconds() > s_.options.max_seconds; }
  StopReason WhyStop() const { return Interrupted() ? StopReason::kInterrupted : StopReason::kTimeLimit; }

  StopReason Iterate() {
    for (int step = 1;; ++step) {
      if (s_.residual() <= s_.options.residual) return StopReason::kConverged;
      if (step > s_.options.max_steps) return StopReason::kStepLimit;
      if (Interrupted() || OutOfTime()) return WhyStop();
      const size_t n = s_.history.size();
      if (!std::isfinite(s_.residual())) return StopReason::kNotConverging;
      if (n > kPatience && s_.history[n - 1].residual > 0.999 * s_.history[n - 1 - kPatience].residual) {
        return StopReason::kNotConverging;
      }
      if (!ReflectedStep(step)) return WhyStop();
    }
  }

  // Takes nodes in order of unshot power until step_fraction of it is covered, and shoots them.
  bool ReflectedStep(int step) {
    const size_t nodes = s_.mesh.node_count();
    std::vector<double> power(nodes);
    double all = 0;
    for (uint32_t n = 0; n < nodes; ++n) {
      all += power[n] = std::abs(double(s_.unshot.Flux(n).sum())) * area_[n];
    }
    std::vector<uint32_t> order(nodes);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return power[a] > power[b]; });
    NodeLobes shooting = s_.unshot, kept = s_.unshot;
    uint32_t shooters = 0;
    double covered = 0;
    for (const uint32_t n : order) {
      const bool shoots = s_.options.step_fraction >= 1.0 || covered < s_.options.step_fraction * all;
      auto cleared = shoots ? kept.all(n) : shooting.all(n);
      std::fill(cleared.begin(), cleared.end(), 0.0f);
      covered += power[n];
      shooters += shoots && power[n] > 0;
    }
    const ShootingField field(s_.scene, s_.mesh, s_.hidden, shooting);
    std::swap(s_.unshot, kept);
    if (!Step(step, field, s_.options.delta_areas, shooters)) {
      std::swap(s_.unshot, kept);  // as if the step had not begun
      return false;
    }
    AccountSent(shooting);
    return true;
  }

  // Every node gathers `field`; false if told to stop, and then nothing has changed.
  bool Step(int step, const ShootingField& field, int samples, uint32_t shooters) {
    const size_t nodes = s_.mesh.node_count();
    std::vector<Received> received(nodes);
    tbb::enumerable_thread_specific<Receiver> receivers(
        [&] { return Receiver(s_.mesh, tracer_, materials_); });
    std::atomic<size_t> done{0};
    std::atomic<bool> stop{false};
    tbb::parallel_for(tbb::blocked_range<size_t>(0, nodes, 16), [&](const tbb::blocked_range<size_t>& range) {
      if (stop.load(std::memory_order_relaxed)) return;
      if (Interrupted() || OutOfTime()) {
        stop = true;
        return;
      }
      Receiver& receiver = receivers.local();
      for (size_t n = range.begin(); n < range.end(); ++n) {
        auto out = gained_.all(uint32_t(n));
        std::fill(out.begin(), out.end(), 0.0f);
        if (s_.hidden[n]) continue;
        const bool timed = control_.time_split && n % 16 == 0;
        received[n] = receiver.Gather(uint32_t(n), field, samples, received_[n],
                                      Mix(Mix(s_.options.seed, 0x5ee9), uint64_t(step)), out.data(), timed);
      }
      Report(step, double(done += range.size()) / double(nodes));
    });
    if (stop) return false;
    Commit(received);
    StepRecord record;
    record.step = step;
    record.residual = UnshotMagnitude() / emitted_.sum();
    record.seconds = Seconds();
    record.rays = rays_;
    record.shooters = step == 0 ? uint32_t(emitters_.size()) : shooters;
    s_.history.push_back(record);
    Report(step, 1.0);
    return true;
  }

  // Adds what was gained to total and unshot. In node order: sums do not depend on threads.
  void Commit(const std::vector<Received>& received) {
    Ledger& ledger = s_.ledger;
    for (uint32_t n = 0; n < received.size(); ++n) {
      const Received& r = received[n];
      const double area = area_[n];
      rays_ += r.rays;
      received_[n] += r.delivered.sum();
      const Eigen::Array3d flux =
          s_.hidden[n] ? Eigen::Array3d::Zero() : Eigen::Array3d(gained_.Flux(n).cast<double>());
      ledger.delivered += r.delivered.cast<double>() * area;
      ledger.absorbed += r.absorbed.cast<double>() * area;
      ledger.mirrored += r.mirrored.cast<double>() * area;
      ledger.reflected += flux * area;
      ledger.truncated += (r.reflected.cast<double>() - flux) * area;
      const auto gained = gained_.all(n);
      auto total = s_.total.all(n), unshot = s_.unshot.all(n);
      for (size_t i = 0; i < gained.size(); ++i) {
        total[i] += gained[i];
        unshot[i] += gained[i];
      }
      if (TimeSplit* split = control_.time_split) {
        // One receiver in 16 was timed and stands for the others.
        split->rays += 16 * r.seconds_rays;
        split->cutting += 16 * r.seconds_cutting;
        split->accumulation += 16 * r.seconds_accumulating;
        split->lobe_reads += r.lobe_reads;
        split->lobe_writes += r.lobe_writes;
      }
    }
  }

  // Power that left with `shooting`, and what of it the probes say reaches no node.
  void AccountSent(const NodeLobes& shooting) {
    std::vector<float> basis(kMaxBasisSize);
    for (uint32_t n = 0; n < s_.mesh.node_count(); ++n) {
      s_.ledger.sent += shooting.Flux(n).cast<double>() * area_[n];
      for (uint32_t i = exposure_.lost_begin[n]; i < exposure_.lost_begin[n + 1]; ++i) {
        const auto& lost = exposure_.lost[i];
        const Rgb radiance = shooting.Radiance(n, lost.direction_local, basis.data());
        (lost.escaped ? s_.ledger.escaped : s_.ledger.blocked) +=
            radiance.cast<double>() * (std::numbers::pi / Exposure::kProbes * area_[n]);
      }
    }
  }

  Eigen::Array3d UnshotPower() const {
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (uint32_t n = 0; n < s_.mesh.node_count(); ++n) sum += s_.unshot.Flux(n).cast<double>() * area_[n];
    return sum;
  }

  // By absolute values: lobes are signed, and power of opposite signs is not shot yet either.
  double UnshotMagnitude() const {
    double sum = 0;
    for (uint32_t n = 0; n < s_.mesh.node_count(); ++n) {
      sum += s_.unshot.Flux(n).cast<double>().abs().sum() * area_[n];
    }
    return sum;
  }

  void Close() {
    Ledger& ledger = s_.ledger;
    ledger.unshot += UnshotPower();
    for (int c = 0; c < 3; ++c) {
      ledger.imbalance[c] = ledger.delivered[c] - (ledger.sent[c] - ledger.escaped[c] - ledger.blocked[c]);
    }
    s_.solve_seconds = Seconds();
  }

  void Report(int step, double fraction) {
    if (!control_.progress) return;
    const std::unique_lock lock(report_mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return;
    control_.progress({step, fraction, s_.residual(), Seconds(), rays_, s_.mesh.node_count()});
  }

  SolveControl control_;
  std::chrono::steady_clock::time_point start_;
  RayTracer tracer_;
  Solution s_;
  Exposure exposure_;
  std::vector<Emitter> emitters_;
  std::vector<MaterialLobes> materials_;
  std::vector<double> area_;
  std::vector<float> received_;  // per node: irradiance so far, summed over channels
  NodeLobes gained_;
  Eigen::Array3d emitted_ = Eigen::Array3d::Zero();
  uint64_t rays_ = 0;
  std::mutex report_mutex_;
};

}  // namespace

Solution Solve(Scene scene, const SolveOptions& options, const SolveControl& control) {
  if (const std::string wrong = options.Validate(); !wrong.empty()) throw std::invalid_argument(wrong);
  scene = CutAlongContacts(std::move(scene), {.distance = options.contact_distance});
  return ProgressiveSolver(std::move(scene), options, control).Run();
}

}  // namespace lobe
