#include "solver/solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "scene/contacts.h"
#include "scene/opposite_nodes.h"
#include "solver/coarse_transport.h"
#include "solver/exposure.h"
#include "solver/hash.h"
#include "solver/lamp_aim.h"
#include "solver/link_gather.h"
#include "solver/link_resolution.h"
#include "solver/links.h"
#include "solver/losses.h"
#include "solver/near_contacts.h"
#include "solver/planar_mirrors.h"
#include "solver/refinement.h"
#include "solver/resume.h"
#include "solver/shooting.h"
#include "solver/sweep_plan.h"
#include "solver/time_left.h"
#include "solver/unsettled.h"

namespace lobe {
namespace {

// Give up when this many steps together lower the residual by less than a per mille.
constexpr int kPatience = 25;

// A solve goes on until light is settled on all but this share of the surfaces: at the places left out, what
// is unshot is at most so many times the residual, of the light of the place. docs/validation.md#settled.
constexpr double kMostUnsettled = 0.01;
constexpr double kMostLeft = 15;

// Emission alone is worth a checkpoint if it took this share of the pause between checkpoints (chosen).
constexpr double kEmissionShare = 0.1;

// From one checkpoint to the next passes at least this many times what writing took: at most a tenth of the
// time goes into them.
constexpr double kCheckpointWork = 10;

// Refinement beside contacts, see RefineAtContacts; docs/validation.md#contact-truth.
constexpr double kContactEnds =
    2;  // ends of an edge may differ by so many of these errors in the first rounds
constexpr int kContactEndRounds = 5;  // two halve all edges of an element
constexpr int kContactRounds = 2;     // on top of RefineOptions::rounds
constexpr int kContactSamples = 8;    // of SolveOptions::light_samples: noise there would look like bends

Ledger::Power& operator+=(Ledger::Power& a, const Eigen::Array3d& b) {
  for (int c = 0; c < 3; ++c) a[c] += b[c];
  return a;
}

class ProgressiveSolver {
 public:
  ProgressiveSolver(Scene scene, const SolveOptions& options, const SolveControl& control)
      : control_(control), start_(std::chrono::steady_clock::now()), tracer_(scene), specular_(scene) {
    s_.scene = std::move(scene);
    s_.options = options;
    by_links_ = options.transport != Transport::kShooting;
  }

  /// Continues `state`, which has whole steps behind it.
  ProgressiveSolver(Solution state, const SolveControl& control)
      : control_(control),
        start_(std::chrono::steady_clock::now()),
        tracer_(state.scene),
        specular_(state.scene) {
    s_ = std::move(state);
    by_links_ = s_.options.transport != Transport::kShooting;
    seconds_before_ = s_.solve_seconds;
    rays_ = rays_before_ = s_.history.back().rays;
  }

  Solution Continue() {
    if (const auto reason = WhyDone()) {
      s_.stop_reason = *reason;
      return std::move(s_);
    }
    TimeSplit unwanted, &split = control_.time_split ? *control_.time_split : unwanted;
    const bool ready = PrepareToContinue();
    split.links += SecondsOfRun();
    if (!ready) {
      // The state is as good as it was, its ledger too.
      s_.stop_reason = WhyStop();
      return std::move(s_);
    }
    ++s_.resumed;
    const double since = SecondsOfRun();
    s_.stop_reason = Iterate();
    split.reflection += SecondsOfRun() - since;
    Close();
    return std::move(s_);
  }

  Solution Run() {
    TimeSplit unwanted, &split = control_.time_split ? *control_.time_split : unwanted;
    double since = 0;
    const auto lap = [&](double& phase) {
      const double now = Seconds();
      phase += now - since;
      since = now;
    };
    bool through = Prepare();
    lap(split.preparation);
    through = through && Emission();
    lap(split.emission);
    through = through && TraceLinks();
    lap(split.links);
    through = through && EmissionByMirrors();
    if (through) {
      s_.stop_reason = Iterate();
      lap(split.reflection);
    } else {
      // Told to stop before emission was through: all of it is still to be shot.
      gained_.SetZero();
      s_.total = s_.direct = s_.unshot = gained_;
      s_.hidden.assign(s_.mesh.node_count(), 0);
      s_.received = {};
      s_.ledger = {};
      s_.stop_reason = WhyStop();
    }
    Close();
    return std::move(s_);
  }

 private:
  // Of this run; what is recorded counts those before it too.
  double SecondsOfRun() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  double Seconds() const { return seconds_before_ + SecondsOfRun(); }
  bool Interrupted() const { return control_.stop && control_.stop->load(std::memory_order_relaxed); }
  bool OutOfTime() const { return s_.options.max_seconds > 0 && SecondsOfRun() > s_.options.max_seconds; }
  bool MustStop() const { return Interrupted() || OutOfTime(); }
  StopReason WhyStop() const { return Interrupted() ? StopReason::kInterrupted : StopReason::kTimeLimit; }

  bool Prepare() {
    emitters_ = FindEmitters(s_.scene);
    for (const auto& e : emitters_) {
      emitted_ += (e.radiance * (std::numbers::pi_v<float> * e.area)).cast<double>();
    }
    try {
      const auto poll = [this] { StopIfTold(); };
      const auto lit = FindLitSides(s_.scene, tracer_, s_.options.seed, poll);
      WarnOfLampsInsideOut(&s_.scene, tracer_, s_.options.seed);
      PrepareMaterials();
      const MeshCounts expected = ExpectCounts(s_.scene, lit, s_.options.mesh.max_edge);
      RequireMemory(control_.max_memory, s_.scene, lit, expected, materials_, s_.options);
      s_.mesh = Tessellate(s_.scene, s_.options.mesh, lit, poll);
      RequireMemory(control_.max_memory, s_.scene, lit, Counts(), materials_, s_.options);
      TellMemory();
      return true;
    } catch (const Stopped&) {
      // A solution without a node.
      s_.mesh = {};
      s_.mesh.roots.assign(2 * s_.scene.faces.size(), kNone);
      s_.material_kinds.resize(s_.scene.materials.size(), GlossKind::kNone);
      s_.material_errors.resize(s_.scene.materials.size(), 0.0);
      gained_ = NodeLobes(s_.mesh, {});
      return false;
    }
  }

  // Ends what cannot be ended otherwise.
  struct Stopped {};
  void StopIfTold() {
    Report(0, 0);
    if (MustStop()) throw Stopped();
  }

  MeshCounts Counts() const { return CountsOf(s_.mesh, s_.scene.materials.size()); }
  void TellMemory() {
    if (control_.memory) control_.memory(EstimateMemory(s_.scene, Counts(), materials_, s_.options));
  }

  // All that is not in the state follows from the scene, the mesh and the settings.
  bool PrepareToContinue() {
    emitters_ = FindEmitters(s_.scene);
    for (const auto& e : emitters_) {
      emitted_ += (e.radiance * (std::numbers::pi_v<float> * e.area)).cast<double>();
    }
    try {
      PrepareMaterials();
    } catch (const Stopped&) {
      return false;
    }
    RequireMemoryToContinue(control_.max_memory, s_, materials_);
    TellMemory();
    const std::vector<PartDegrees> degrees = Degrees();
    CheckResumable(s_, degrees);
    gained_ = NodeLobes(s_.mesh, degrees);
    got_.resize(s_.mesh.node_count());
    FindOpposite();
    const uint64_t rays = rays_;
    if (!TraceLinks()) return false;
    rays_ = rays;  // counted before
    return true;
  }

  void PrepareMaterials() {
    std::vector<GlossKind> kinds;
    std::vector<double> errors;
    TableCache cache;
    for (const auto& material : s_.scene.materials) {
      StopIfTold();
      materials_.emplace_back(material.reflectance, s_.options.lobes, cache);
      kinds.push_back(materials_.back().kind());
      errors.push_back(materials_.back().gloss.error.total);
    }
    s_.material_kinds = std::move(kinds);
    s_.material_errors = std::move(errors);
  }

  std::vector<PartDegrees> Degrees() const {
    std::vector<PartDegrees> degrees;
    for (const auto& patch : s_.mesh.patches) {
      const auto& lobes = materials_[patch.material];
      degrees.push_back({lobes.base.l_max, lobes.gloss.l_max});
    }
    return degrees;
  }

  void FindOpposite() {
    const auto transmits = [](const MaterialLobes& m) { return m.transmits(); };
    if (std::any_of(materials_.begin(), materials_.end(), transmits)) {
      opposite_ = OppositeNodes(s_.mesh, s_.scene);
    }
  }

  // Straight light of the emitters, on a mesh that is refined until it suits it.
  bool Emission() {
    const std::vector<PartDegrees> degrees = Degrees();
    phase_ = Phase::kEmission;
    gained_ = NodeLobes(s_.mesh, degrees);
    got_.clear();
    const bool at_contacts = s_.options.refine.contact_error > 0 && s_.options.refine.rounds > 0;
    std::vector<float> near;
    if (at_contacts) near = NearContacts(s_.scene, s_.mesh, s_.options.contact_distance);
    if (!Shoot(AllNodes(), s_.options.light_samples)) return false;
    const RefineOptions& options = s_.options.refine;
    Refinement refined;
    for (int round = 0; round < options.rounds && options.error > 0; ++round) {
      const std::vector<double> area = NodeAreas(s_.mesh, s_.hidden);
      const Roughness roughness(s_.mesh, gained_, area, SharpMaterials());
      refined = Refined(round == 0 ? roughness.BetweenEnds(options.error)
                                   : roughness.AtMidpoints(refined, options.error));
      if (refined.made.empty()) break;
      if (at_contacts) near = CarryOver(near, refined);
      if (!MoveTo(refined, s_.options.light_samples)) return false;
    }
    if (at_contacts && !RefineAtContacts(std::move(near))) return false;
    if (options.rounds > 0 && (options.error > 0 || at_contacts)) TellRefined();
    s_.total = s_.direct = s_.unshot = NodeLobes(s_.mesh, degrees);
    FindOpposite();
    return true;
  }

  std::vector<bool> SharpMaterials() const {
    std::vector<bool> sharp;
    for (const GlossKind kind : s_.material_kinds) sharp.push_back(kind == GlossKind::kSharp);
    return sharp;
  }

  // A finer mesh, as far as nodes and memory allow.
  Refinement Refined(const std::vector<float>& priority) {
    const size_t most_nodes = MostNodes();
    Refinement out = RefineMesh(s_.scene, s_.mesh, priority, s_.options.mesh, most_nodes);
    if (out.out_of_nodes && most_nodes < s_.options.refine.max_nodes) short_of_memory_ = true;
    return out;
  }

  // Straight light of the emitters at `nodes`.
  bool Shoot(const std::vector<uint32_t>& nodes, int samples) {
    if (!by_links_) s_.received.assign(s_.mesh.node_count(), 0.0f);
    s_.hidden.assign(s_.mesh.node_count(), 0);
    got_.resize(s_.mesh.node_count());
    return GatherShot(0, ShootingField(s_.mesh, emitters_), samples, nodes);
  }

  // Takes over a refined mesh, with straight light on its new nodes.
  bool MoveTo(Refinement& refined, int samples) {
    gained_ = CarryOver(gained_, refined);
    std::vector<Received> got(refined.mesh.node_count());
    for (uint32_t n = 0; n < got_.size(); ++n) got[refined.node_of_old[n]] = got_[n];
    got_ = std::move(got);
    s_.mesh = std::move(refined.mesh);
    return Shoot(refined.made, samples);
  }

  // Beside contacts much of the light has been reflected before and changes fast, since what stands there is
  // close: there the mesh is refined for light reflected once, too, measured against how bright that place
  // is.
  bool RefineAtContacts(std::vector<float> near) {
    const RefineOptions& options = s_.options.refine;
    const double error = options.contact_error;
    NodeLobes once = gained_;
    once.SetZero();
    std::vector<uint32_t> nodes = AllNodes();
    const int samples = s_.options.light_samples * kContactSamples;
    Refinement refined;
    for (int round = 0; round < options.rounds + kContactRounds; ++round) {
      std::vector<bool> beside(s_.mesh.node_count(), false);  // on an element that is near
      for (const auto& e : s_.mesh.elements) {
        if (near[e[0]] > 0 || near[e[1]] > 0 || near[e[2]] > 0)
          beside[e[0]] = beside[e[1]] = beside[e[2]] = true;
      }
      std::erase_if(nodes, [&](uint32_t n) { return !beside[n]; });
      if (nodes.empty()) return true;
      if (round == 0 && !Shoot(nodes, samples)) return false;
      NodeLobes light = gained_;
      std::vector<Received> got = got_;
      {
        const ShootingField field(s_.scene, s_.mesh, s_.hidden, light);
        gained_ = once;
        if (!GatherShot(0, field, s_.options.delta_areas, nodes)) return false;
        once = gained_;
      }
      gained_ = light;
      got_ = std::move(got);
      for (uint32_t n = 0; n < s_.mesh.node_count(); ++n) {
        const auto to = light.all(n);
        const auto from = once.all(n);
        for (size_t i = 0; i < to.size(); ++i) to[i] += from[i];
      }
      const std::vector<double> area = NodeAreas(s_.mesh, s_.hidden);
      const Roughness roughness(s_.mesh, light, area, SharpMaterials(), near);
      std::vector<float> priority(s_.mesh.element_count(), 0.0f);
      // Halving an element tells about its longest edge only, so all edges are looked at first.
      if (round < kContactEndRounds) priority = roughness.BetweenEnds(kContactEnds * error);
      if (round > 0) {
        const std::vector<float> bends = roughness.AtMidpoints(refined, error);
        for (size_t e = 0; e < bends.size(); ++e) priority[e] = std::max(priority[e], bends[e]);
      }
      refined = Refined(priority);
      if (refined.made.empty()) return true;
      near = CarryOver(near, refined);
      once = CarryOver(once, refined);
      nodes = refined.made;
      if (!MoveTo(refined, samples)) return false;
    }
    return true;
  }

  // As many as the options allow, and as fit.
  size_t MostNodes() const {
    const size_t asked = s_.options.refine.max_nodes;
    if (!(control_.max_memory > 0)) return asked;
    const double fit = NodesThatFit(control_.max_memory, s_.scene, Counts(), materials_, s_.options);
    return fit < double(asked) ? size_t(fit) : asked;
  }

  void TellRefined() {
    if (short_of_memory_) {
      s_.scene.warnings.push_back(s_.scene.path + ": the mesh was refined up to " +
                                  std::to_string(s_.mesh.node_count()) + " nodes only, all that fit into " +
                                  MemoryText(control_.max_memory) + " of memory");
    }
    TellMemory();
  }

  std::vector<uint32_t> AllNodes() const {
    std::vector<uint32_t> nodes(s_.mesh.node_count());
    std::iota(nodes.begin(), nodes.end(), 0u);
    return nodes;
  }

  // Also finds the hidden nodes, and takes from them what emission gave them.
  bool TraceLinks() {
    Links::Options options;
    options.links = by_links_ ? s_.options.links : Links::kProbes;
    options.follow_mirrors = by_links_;
    options.seed = s_.options.seed;
    if (by_links_) planar_mirrors_ = FindPlanarMirrors(s_.mesh, materials_, emitters_);
    options.planar_mirrors = planar_mirrors_;
    phase_ = Phase::kLinks;
    double expected_rays = 0;
    for (const auto& p : s_.mesh.patches) {
      expected_rays +=
          double(p.node_end - p.node_begin) * Links::PatternOf(materials_[p.material], options.links).count();
    }
    links_ = std::make_unique<Links>(s_.scene, s_.mesh, tracer_, materials_, options, [&](double fraction) {
      rays_under_way_ = uint64_t(fraction * expected_rays);
      Report(0, fraction);
      return MustStop();
    });
    if (links_->stopped()) return false;
    rays_ += links_->rays();
    rays_under_way_ = 0;
    s_.hidden = links_->hidden();
    area_ = NodeAreas(s_.mesh, s_.hidden);
    if (by_links_ && s_.options.accelerate) {
      coarse_ = std::make_unique<CoarseTransport>(s_.mesh, *links_, materials_, area_, opposite_);
    }
    return true;
  }

  // Light of the emitters by way of mirrors and glass: over one planar mirror by shadow rays to their images,
  // all else by links.
  bool EmissionByMirrors() {
    const bool mirrors = std::any_of(materials_.begin(), materials_.end(),
                                     [](const MaterialLobes& m) { return m.sends_on(); });
    phase_ = Phase::kMirrors;
    if (by_links_ && mirrors) {
      s_.direct = Straight();
      if (!planar_mirrors_.empty()) {
        const ShootingField images(s_.mesh, emitters_, planar_mirrors_);
        if (!AddGathered([&] { return GatherShot(0, images, s_.options.light_samples, AllNodes()); }))
          return false;
      }
      if (!AddGathered([&] { return GatherLinked(0, LinkField(s_.scene, s_.mesh), 1); })) return false;
    }
    PassThrough(gained_);
    Commit(0, {}, uint32_t(emitters_.size()));
    if (!(by_links_ && mirrors)) s_.direct = s_.total;
    return true;
  }

  // What was gained so far, as Commit will add it.
  NodeLobes Straight() {
    NodeLobes straight = gained_;
    PassThrough(straight);
    for (uint32_t n = 0; n < s_.mesh.node_count(); ++n) {
      const auto lobe = straight.all(n);
      if (s_.hidden[n]) std::fill(lobe.begin(), lobe.end(), 0.0f);
    }
    return straight;
  }

  // gather() replaces gained_ and got_; this adds to what they held.
  template <typename Gather>
  bool AddGathered(const Gather& gather) {
    const NodeLobes before = gained_;
    const std::vector<Received> got_before = got_;
    if (!gather()) return false;
    for (uint32_t n = 0; n < s_.mesh.node_count(); ++n) {
      const auto gained = gained_.all(n);
      const auto had = before.all(n);
      for (size_t i = 0; i < gained.size(); ++i) gained[i] += had[i];
      got_[n] += got_before[n];
    }
    return true;
  }

  // Is there nothing to do after the last whole step?
  std::optional<StopReason> WhyDone() const {
    const size_t n = s_.history.size();
    const bool stalls =
        n > kPatience && s_.history[n - 1].residual > 0.999 * s_.history[n - 1 - kPatience].residual;
    if (s_.residual() <= s_.options.residual && (!by_links_ || stalls || Settled())) {
      return StopReason::kConverged;
    }
    if (n > size_t(s_.options.max_steps)) return StopReason::kStepLimit;
    if (!std::isfinite(s_.residual()) || stalls) return StopReason::kNotConverging;
    return std::nullopt;
  }

  // Is light settled almost everywhere, also where there is little? With links only: their last sweeps cost
  // next to nothing.
  bool Settled() const {
    const std::vector<double> area = area_.empty() ? NodeAreas(s_.mesh, s_.hidden) : area_;
    return UnsettledArea(s_.total, s_.unshot, area, kMostLeft * s_.options.residual) <= kMostUnsettled;
  }

  StopReason Iterate() {
    phase_ = Phase::kBounces;
    rays_under_way_ = 0;
    for (;;) {
      if (const auto reason = WhyDone()) return *reason;
      if (MustStop()) return WhyStop();
      Checkpoint();
      const int step = int(s_.history.size());
      if (!(by_links_ ? Sweep(step) : ShootingStep(step))) return WhyStop();
    }
  }

  // Shows the state to whoever keeps it, when it is time.
  void Checkpoint() {
    if (!control_.checkpoint || !(control_.checkpoint_seconds > 0)) return;
    const double now = SecondsOfRun();
    // When emission has taken long, so will the steps: what there is can be looked at from here on.
    const bool emission_only = s_.history.size() == 1 && s_.resumed == 0;
    const double pause = emission_only ? kEmissionShare * control_.checkpoint_seconds
                                       : std::max(control_.checkpoint_seconds, checkpoint_pause_);
    if (now - last_checkpoint_ < pause) return;
    s_.stop_reason = StopReason::kUnfinished;
    Close();
    control_.checkpoint(s_);
    last_checkpoint_ = SecondsOfRun();
    checkpoint_pause_ = kCheckpointWork * (last_checkpoint_ - now);
  }

  // Sends all unshot light through the links, and with it what the coarse solution says will follow. If that
  // does worse than a plain sweep did, all stays as it was.
  bool Sweep(int step) {
    const SweepPlan plan = PlanSweep(s_.history, s_.options);
    std::vector<std::array<float, 3>> ahead;
    if (coarse_ && plan.ahead > 0) {
      ahead = coarse_->Ahead(s_.total, s_.direct, s_.unshot, area_, plan.most_overrated);
      for (auto& share : ahead) {
        for (float& s : share) s *= plan.ahead;
      }
    }
    shooting_ = s_.unshot;
    if (!ahead.empty()) shooting_.AddScaled(s_.total, ahead);
    const LinkField field(s_.scene, s_.mesh, shooting_,
                          SentDegrees(s_.mesh, materials_, s_.options.links, step, plan.degree_cap));
    const auto shooters = uint32_t(std::count(s_.hidden.begin(), s_.hidden.end(), 0));
    if (!GatherLinked(step, field, plan.thinning)) return false;
    PassThrough(gained_);
    if (!ahead.empty() && !(Left(ahead) < s_.residual())) {
      Record(step, s_.residual(), 0);
    } else {
      Commit(step, ahead, shooters);
    }
    return true;
  }

  // The residual that would be left if what was gathered became part of the solution.
  double Left(const std::vector<std::array<float, 3>>& ahead) {
    std::vector<double> left(s_.mesh.node_count());
    tbb::parallel_for(uint32_t(0), uint32_t(s_.mesh.node_count()), [&](uint32_t n) {
      if (s_.hidden[n]) return;
      const auto& share = ahead[s_.mesh.node_patch[n]];
      const Rgb flux = gained_.Flux(n) - s_.total.Flux(n) * Rgb(share[0], share[1], share[2]);
      left[n] = flux.cast<double>().abs().sum() * area_[n];
    });
    return std::accumulate(left.begin(), left.end(), 0.0) / emitted_.sum();
  }

  // Takes nodes in order of unshot power until step_fraction of it is covered, and shoots them.
  bool ShootingStep(int step) {
    const size_t nodes = s_.mesh.node_count();
    uint32_t shooters = 0;
    shooting_ = s_.unshot;
    if (s_.options.step_fraction < 1) {
      std::vector<double> power(nodes);
      double all = 0, covered = 0;
      for (uint32_t n = 0; n < nodes; ++n) {
        all += power[n] = std::abs(double(s_.unshot.Flux(n).sum())) * area_[n];
      }
      std::vector<uint32_t> order(nodes);
      std::iota(order.begin(), order.end(), 0u);
      std::stable_sort(order.begin(), order.end(),
                       [&](uint32_t a, uint32_t b) { return power[a] > power[b]; });
      for (const uint32_t n : order) {
        const auto shot = shooting_.all(n);
        if (covered >= s_.options.step_fraction * all) std::fill(shot.begin(), shot.end(), 0.0f);
        covered += power[n];
      }
    }
    for (uint32_t n = 0; n < nodes; ++n) {
      const auto shot = shooting_.all(n);
      shooters += std::any_of(shot.begin(), shot.end(), [](float v) { return v != 0; });
    }
    const ShootingField field(s_.scene, s_.mesh, s_.hidden, shooting_);
    if (!GatherShot(step, field, s_.options.delta_areas, AllNodes())) return false;
    PassThrough(gained_);
    Commit(step, {}, shooters);
    return true;
  }

  bool GatherShot(int step, const ShootingField& field, int samples, const std::vector<uint32_t>& nodes) {
    tbb::enumerable_thread_specific<Receiver> receivers(
        [&] { return Receiver(s_.mesh, tracer_, materials_, specular_); });
    return ForEach(nodes, step, [&](uint32_t n, float* out) {
      return receivers.local().Gather(n, field, samples, s_.received.empty() ? 0.0f : s_.received[n],
                                      Mix(Mix(s_.options.seed, 0x5ee9), uint64_t(step)), out);
    });
  }

  bool GatherLinked(int step, const LinkField& field, int thinning) {
    tbb::enumerable_thread_specific<LinkReceiver> receivers(
        [&] { return LinkReceiver(s_.mesh, *links_, materials_); });
    return ForEach(AllNodes(), step,
                   [&](uint32_t n, float* out) { return receivers.local().Gather(n, field, thinning, out); });
  }

  // gather(node, out) for every one of `nodes` that is not hidden, into gained_ and got_; false if told
  // to stop, and then nothing else has changed.
  template <typename Gather>
  bool ForEach(const std::vector<uint32_t>& nodes, int step, const Gather& gather) {
    std::atomic<size_t> done{0};
    std::atomic<bool> stop{false};
    tbb::parallel_for(tbb::blocked_range<size_t>(0, nodes.size(), 16),
                      [&](const tbb::blocked_range<size_t>& range) {
                        if (stop.load(std::memory_order_relaxed)) return;
                        if (MustStop()) {
                          stop = true;
                          return;
                        }
                        uint64_t rays = 0;
                        for (size_t i = range.begin(); i < range.end(); ++i) {
                          const uint32_t n = nodes[i];
                          auto out = gained_.all(n);
                          std::fill(out.begin(), out.end(), 0.0f);
                          got_[n] = {};
                          if (s_.hidden[n]) continue;
                          got_[n] = gather(n, out.data());
                          rays += got_[n].rays;
                        }
                        rays_under_way_ += rays;
                        Report(step, double(done += range.size()) / double(nodes.size()));
                      });
    return !stop;
  }

  // Makes a gathered step part of the solution: total = what was gathered of all that was ever shot, and
  // unshot = total - all that was ever shot. What was shot ahead is so taken back.
  void Commit(int step, const std::vector<std::array<float, 3>>& ahead, uint32_t shooters) {
    const bool all_was_shot = by_links_ || s_.options.step_fraction >= 1;
    flux_.resize(s_.mesh.node_count());
    tbb::parallel_for(uint32_t(0), uint32_t(s_.mesh.node_count()), [&](uint32_t n) {
      const auto gained = gained_.all(n);
      if (s_.hidden[n]) std::fill(gained.begin(), gained.end(), 0.0f);
      auto total = s_.total.all(n), left = s_.unshot.all(n);
      if (all_was_shot) {
        std::fill(left.begin(), left.end(), 0.0f);
      } else if (step > 0) {
        const auto shot = shooting_.all(n);
        for (size_t i = 0; i < left.size(); ++i) left[i] -= shot[i];
      }
      if (!ahead.empty()) s_.unshot.SubtractScaled(n, s_.total, ahead[s_.mesh.node_patch[n]]);
      for (size_t i = 0; i < gained.size(); ++i) {
        total[i] += gained[i];
        left[i] += gained[i];
      }
      flux_[n] = {gained_.Flux(n), s_.unshot.Flux(n)};
    });
    // In node order: sums do not depend on threads.
    Ledger& ledger = s_.ledger;
    double unshot = 0;
    for (uint32_t n = 0; n < s_.mesh.node_count(); ++n) {
      const Received& r = got_[n];
      rays_ += r.rays;
      if (s_.hidden[n]) continue;
      const double area = area_[n];
      if (!s_.received.empty()) s_.received[n] += r.delivered.sum();
      const Eigen::Array3d flux(flux_[n].gained.cast<double>());
      ledger.delivered += r.delivered.cast<double>() * area;
      ledger.absorbed += r.absorbed.cast<double>() * area;
      // Panes hinder no shadow ray.
      const uint32_t material = s_.mesh.patches[s_.mesh.node_patch[n]].material;
      const bool goes_on = by_links_ || specular_.kind(material) == SpecularSurfaces::Kind::kPane;
      (goes_on ? ledger.passed_on : ledger.mirrored) += r.mirrored.cast<double>() * area;
      ledger.reflected += flux * area;
      ledger.truncated += ((r.reflected + r.through).cast<double>() - flux) * area;
      // By absolute values: lobes are signed, and power of opposite signs is not shot yet either.
      unshot += flux_[n].unshot.cast<double>().abs().sum() * area;
      if (TimeSplit* split = control_.time_split) {
        split->lobe_reads += r.lobe_reads;
        split->lobe_writes += r.lobe_writes;
      }
    }
    Record(step, unshot / emitted_.sum(), shooters);
  }

  void Record(int step, double residual, uint32_t shooters) {
    StepRecord record;
    record.step = step;
    record.residual = residual;
    record.seconds = Seconds();
    record.rays = rays_;
    record.shooters = shooters;
    s_.history.push_back(record);
    rays_under_way_ = 0;
    Report(step, 1.0);
  }

  // What arrived on one side of a translucent sheet leaves the other, in every direction alike.
  void PassThrough(NodeLobes& gained) const {
    for (uint32_t n = 0; n < opposite_.size(); ++n) {
      const uint32_t from = opposite_[n];
      if (from == kNone || s_.hidden[from]) continue;
      const int count = gained.degrees(n).base_count();
      for (int c = 0; c < 3; ++c) {
        // Of radiance flux / pi, as the coefficient of the constant function 1 / sqrt(2 pi).
        gained.base(n)[c * count] += got_[from].through[c] * std::sqrt(2.0f / std::numbers::pi_v<float>);
      }
    }
  }

  // The ledger's entries that follow from what has been shot in all, total - unshot.
  void Close() {
    Ledger& ledger = s_.ledger;
    ledger.emitted = ledger.sent = ledger.escaped = ledger.blocked = ledger.in_glass = ledger.below_facets =
        ledger.unshot = {};
    ledger.emitted += emitted_;
    if (s_.history.empty()) {
      ledger.unshot = ledger.emitted;
    } else {
      std::vector<const MaterialLobes*> mirrors;
      for (const auto& m : materials_) {
        mirrors.push_back(by_links_ && m.sends_on() ? &m : nullptr);
      }
      const EmissionLoss emission =
          FindEmissionLoss(s_.scene, s_.mesh, tracer_, mirrors, s_.options.seed, by_links_);
      const Losses reflected = FindLosses(s_.mesh, *links_, s_.total, s_.unshot, area_);
      ledger.sent += emitted_ + reflected.sent;
      ledger.escaped += emitted_ * emission.escaped + reflected.escaped;
      ledger.blocked += emitted_ * emission.blocked + reflected.blocked;
      ledger.in_glass += emitted_ * emission.in_glass + reflected.in_glass;
      ledger.below_facets += reflected.below_facets;
      for (uint32_t n = 0; n < s_.mesh.node_count(); ++n) {
        if (area_[n] > 0) ledger.unshot += s_.unshot.Flux(n).cast<double>() * area_[n];
      }
    }
    for (int c = 0; c < 3; ++c) {
      ledger.imbalance[c] =
          ledger.delivered[c] - (ledger.sent[c] + ledger.passed_on[c] - ledger.escaped[c] -
                                 ledger.blocked[c] - ledger.in_glass[c] - ledger.below_facets[c]);
    }
    if (s_.history.empty()) ledger.imbalance = {};
    s_.solve_seconds = Seconds();
  }

  void Report(int step, double fraction) {
    if (!control_.progress) return;
    const std::unique_lock lock(report_mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return;
    const double run = SecondsOfRun();
    const uint64_t rays = rays_ + rays_under_way_;
    std::optional<double> left;
    if (phase_ == Phase::kBounces) left = SecondsLeft(s_.history, s_.options, fraction, run);
    control_.progress({phase_, step, fraction, s_.residual(), Seconds(), rays,
                       run > 0 ? double(rays - rays_before_) / run : 0.0, s_.mesh.node_count(), left});
  }

  SolveControl control_;
  std::chrono::steady_clock::time_point start_;
  RayTracer tracer_;
  SpecularSurfaces specular_;
  Solution s_;
  bool by_links_ = true;
  std::vector<Emitter> emitters_;
  std::vector<MaterialLobes> materials_;
  std::vector<PlanarMirror> planar_mirrors_;
  std::unique_ptr<Links> links_;
  std::unique_ptr<CoarseTransport> coarse_;
  std::vector<uint32_t> opposite_;  // per node, across a translucent sheet; empty if there is none
  std::vector<double> area_;
  NodeLobes shooting_, gained_;
  std::vector<Received> got_;
  struct NodeFlux {
    Rgb gained, unshot;
  };
  std::vector<NodeFlux> flux_;  // of the last step
  Eigen::Array3d emitted_ = Eigen::Array3d::Zero();
  Phase phase_ = Phase::kPreparation;
  bool short_of_memory_ = false;  // some of the mesh could not be refined
  uint64_t rays_ = 0, rays_before_ = 0;
  std::atomic<uint64_t> rays_under_way_{0};            // traced, not yet committed
  double seconds_before_ = 0;                          // in the runs that this one continues
  double last_checkpoint_ = 0, checkpoint_pause_ = 0;  // seconds of this run
  std::mutex report_mutex_;
};

}  // namespace

Solution Solve(Scene scene, const SolveOptions& options, const SolveControl& control) {
  if (const std::string wrong = options.Validate(); !wrong.empty()) throw std::invalid_argument(wrong);
  scene = CutAlongContacts(std::move(scene), {.distance = options.contact_distance});
  return ProgressiveSolver(std::move(scene), options, control).Run();
}

Solution Resume(Solution state, const SolveControl& control) {
  if (const std::string wrong = state.options.Validate(); !wrong.empty()) throw std::invalid_argument(wrong);
  // Nothing was worth keeping but the scene, which is cut along its contacts already.
  if (state.history.empty()) return ProgressiveSolver(std::move(state.scene), state.options, control).Run();
  return ProgressiveSolver(std::move(state), control).Continue();
}

}  // namespace lobe
