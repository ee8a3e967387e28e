#pragma once

#include <cstdint>
#include <vector>

#include "render/curved_elements.h"
#include "render/lobe_lookup.h"
#include "render/path_scene.h"
#include "render/renderer.h"
#include "solver/hash.h"

namespace lobe {

/// What the light an eye ray brings is made of. Their sum is the picture; `clamped` is a part of it.
struct EyeLight {
  Rgb direct = Rgb::Zero();    ///< emission seen, and lamps' light reflected once by what the ray met
  Rgb indirect = Rgb::Zero();  ///< the rest of what that reflects
  Rgb specular = Rgb::Zero();  ///< everything by way of ideal mirrors and glass
  Rgb clamped = Rgb::Zero();   ///< made by showing negative values of lobes as zero
  Rgb Sum() const { return direct + indirect + specular; }
  EyeLight& operator+=(const EyeLight& other) {
    direct += other.direct;
    indirect += other.indirect;
    specular += other.specular;
    clamped += other.clamped;
    return *this;
  }
};

/// Which of a pixel's samples an eye ray is: what its random numbers follow from.
struct EyeSample {
  uint64_t pixel_key;
  uint32_t index;
};

/// Finds the light a single eye ray brings, in every mode that reads a solution. Keeps references to the
/// solution. Const methods may run in many threads, each with a Work of its own.
class EyeShader {
 public:
  explicit EyeShader(const Solution& solution);

  /// A thread's scratch, and what it counts.
  struct Work {
    std::vector<float> basis = std::vector<float>(kMaxBasisSize);
    uint64_t rays = 0;
    double cut_off = 0;  ///< throughput of ways that were not followed further, summed over channels
  };

  /// `split`: keep direct and indirect apart also where that costs a second reading of lobes; else what is
  /// read as one is told as indirect.
  EyeLight Shade(const Ray& ray, const RayHit& hit, const RenderOptions& options, const EyeSample& sample,
                 bool split, Work& work) const;

  /// How light is found on what an eye ray meets.
  enum class Reading {
    kStored,     ///< lobes hold it
    kDirect,     ///< lamps are sampled, the rest is read
    kGather,     ///< gloss is traced until it meets lobes, the base is read
    kGatherAll,  ///< the base is traced, too
  };
  /// On `element`, or on elements that are not curved (kNone).
  Reading ReadingOf(uint32_t material, uint32_t element, const RenderOptions& options) const;
  /// Elements of curved surfaces whose light mode auto does not read alone; may be empty.
  const std::vector<NotStored>& curved() const { return curved_; }

  const PathScene& paths() const { return paths_; }
  const LobeLookup& stored() const { return stored_; }

 private:
  struct Way;
  struct Task;

  void Follow(const Ray& ray, const RayHit& hit, Way way, Task& task) const;
  void Surface(const Ray& ray, const RayHit& hit, const Way& way, Task& task) const;
  void Show(const Rgb& read, const Rgb& direct, const Way& way, Task& task) const;
  void Sample(const PathScene::Vertex& vertex, const ReflectanceSampler& sampler, int samples, bool gather,
              const Way& way, Task& task) const;

  const Solution& solution_;
  PathScene paths_;
  LobeLookup stored_;
  std::vector<ReflectanceSampler> gloss_;  // by material
  std::vector<NotStored> curved_;          // by element, or empty
};

}  // namespace lobe
