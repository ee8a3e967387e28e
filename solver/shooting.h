#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "brdf/incident_moments.h"
#include "brdf/material_lobes.h"
#include "scene/ray_tracer.h"
#include "scene/specular.h"
#include "solver/exposure.h"
#include "solver/form_factor.h"
#include "solver/hash.h"
#include "solver/node_lobes.h"
#include "solver/planar_mirrors.h"
#include "solver/received.h"
#include "solver/solution.h"

namespace lobe {

/// Light on the move: what one step shoots. Either the emitters' own radiance, or lobes of nodes. Cut into
/// cells, triangles that halve by bisection: an emitter is one cell, a lit face of the mesh the root of its
/// bisection tree, and below an element (or an emitter) cells go on halving as far as a receiver asks.
class ShootingField {
 public:
  /// Emission.
  ShootingField(const Mesh& mesh, const std::vector<Emitter>& emitters);
  /// Emission by way of one planar mirror: the emitters' images behind the mirrors.
  ShootingField(const Mesh& mesh, const std::vector<Emitter>& emitters, std::vector<PlanarMirror> mirrors);
  /// Light reflected by nodes: `lobes` with zeros where a node does not shoot. `planar` patches share one
  /// basis evaluation. References to `mesh`, `hidden` and `lobes` are kept.
  ShootingField(const Scene& scene, const Mesh& mesh, const std::vector<uint8_t>& hidden,
                const NodeLobes& lobes);

  struct Root {
    std::array<Vec3, 3> corners;
    Vec3 normal;
    Rgb radiance;             ///< mean over the cell
    uint32_t cell;            ///< kNone for an emitter
    bool glossy;              ///< radiance depends on direction: read lobes
    uint32_t face;            ///< of the scene; of a mirrored emitter, the emitter's own
    uint32_t mirror = kNone;  ///< of a mirrored emitter: index into mirrors()
  };
  const std::vector<Root>& roots() const { return roots_; }
  const Rgb& cell_radiance(uint32_t cell) const { return cell_radiance_[cell]; }
  bool emission() const { return lobes_ == nullptr; }
  const std::vector<PlanarMirror>& mirrors() const { return mirrors_; }

  /// Radiance of a point of `element`, given by weights, towards `wo_world`. `basis` is scratch.
  Rgb Radiance(uint32_t element, const float weight[3], const Vec3& wo_world, float* basis) const;

 private:
  const Mesh* mesh_;
  const std::vector<uint8_t>* hidden_ = nullptr;
  const NodeLobes* lobes_ = nullptr;
  std::vector<Root> roots_;
  std::vector<PlanarMirror> mirrors_;
  std::vector<Rgb> cell_radiance_;
};

/// Gathers a step's light at one receiving node after another: the receiving half of progressive shooting
/// (Cohen and Wallace, Radiosity and Realistic Image Synthesis, fig. 10.15). One per thread; holds scratch.
class Receiver {
 public:
  /// Shadow rays pass the panes of `specular`.
  Receiver(const Mesh& mesh, const RayTracer& tracer, const std::vector<MaterialLobes>& materials,
           const SpecularSurfaces& specular);

  /// Cuts `field` into about `samples` delta areas, more where more light is expected to come from, traces
  /// one shadow ray to each, and adds the light that leaves `node` for it to `out` (layout of NodeLobes,
  /// zeroed by the caller). `received_before`: sum over channels of the irradiance so far; cells that bring
  /// less than 1 / samples of the larger of it and this step are not cut further, so dim steps cost few rays.
  /// `seed` decides which point of a cell stands for it. If what promised nearly all of the light turns out
  /// to be hidden, rays are shared out again among the rest: a lamp behind a wall, however bright, takes
  /// nothing from the lamp in the room.
  Received Gather(uint32_t node, const ShootingField& field, int samples, float received_before,
                  uint64_t seed, float* out);

  /// The shadow rays that the last Gather ended with (what it forgot counts as work, too), for measuring what
  /// tracing them alone costs (bench/).
  std::span<const Ray> last_rays() const { return rays_; }

 private:
  // A piece of a root, as large as the receiver allows.
  struct Cell {
    std::array<Vec3, 3> corners;
    std::array<Vec3, 3> weights;  // of the element's nodes at the corners; at and below a leaf only
    Rgb radiance;
    float expected;  // irradiance it would bring if free, summed over channels; an estimate
    uint32_t cell, element;
    int depth;
  };
  // A delta area: what arrives if its shadow ray is free.
  struct Delta {
    Vec3 direction;
    Rgb irradiance;
    uint32_t root, mirror;
  };
  // Fresnel factor of the way over `mirror` to the image that a ray ends at, times what panes in it let
  // through; black where something else is in it.
  Rgb ByMirror(const PlanarMirror& mirror, const Ray& ray) const;
  // Adds to deltas_ and rays_ from all roots that are not in settled_.
  void Cut(uint32_t node, const ShootingField& field, int samples, float received_before, uint64_t seed,
           Received& work);
  // Fills occluded_ from `first` on, and takes what lies in the way off deltas_. Returns how many rays that
  // took.
  uint64_t Trace(const ShootingField& field, size_t first);
  // Looks at the rays from `first` on. If what promised most is hidden and the others had hardly any rays for
  // it, puts the former into settled_, forgets the latter's rays, and returns true.
  bool SettlePromising(size_t first);
  void Split(const ShootingField& field, const ShootingField::Root& root, const Vec3& point,
             const Vec3& normal, const Cell& parent);
  // All of an emitter that is seen small, as `samples` points; false if it is not seen small.
  bool EmitEvenly(const ShootingField& field, uint32_t root, uint32_t node, int samples,
                  RandomStream& random);
  void Emit(const ShootingField& field, uint32_t root, uint32_t node, const Cell& cell, float weight,
            RandomStream& random, Received& work);

  const Mesh& mesh_;
  const RayTracer& tracer_;
  const std::vector<MaterialLobes>& materials_;
  const SpecularSurfaces& specular_;
  std::vector<Cell> stack_;
  std::vector<Delta> deltas_;
  std::vector<Ray> rays_;
  std::vector<uint8_t> occluded_;
  std::vector<float> basis_;
  std::vector<float> expected_;          // per root
  std::vector<uint8_t> settled_, seen_;  // per root; the latter for SettlePromising
  std::vector<float> lifts_;             // per patch
  IncidentMoments moments_;
};

}  // namespace lobe
