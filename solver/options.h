#pragma once

#include <cstdint>
#include <string>

#include "brdf/material_lobes.h"
#include "scene/contacts.h"
#include "scene/tessellate.h"
#include "solver/refinement.h"

namespace lobe {

/// How reflected light travels between nodes. Straight emission always travels by shooting.
enum class Transport {
  kShooting,  ///< shadow rays to delta areas, chosen anew in every step; stops at ideal mirrors
  kLinks,     ///< sweeps through links traced once; follows ideal mirrors
  kAuto,      ///< links (docs/validation.md#transport says where each wins)
};
const char* Name(Transport transport);

struct SolveOptions {
  TessellateOptions mesh;
  RefineOptions refine;
  LobeOptions lobes;
  Transport transport = Transport::kAuto;
  /// Links per diffuse node, >= 8; glossy nodes take more, in proportion to the coefficients of their lobes.
  /// Time and memory (4 bytes a link) grow in proportion; noise falls a little faster than the square root.
  /// Default measured in docs/validation.md#links.
  int links = 1024;
  /// Shoot ahead what a coarse solution expects: the same fixed point in fewer sweeps. Off: plain sweeps,
  /// slower, to check these against.
  bool accelerate = true;
  /// Faces are cut along the lines where other faces touch them or come nearer than this, metres; 0: not at
  /// all (scene/contacts.h).
  float contact_distance = ContactOptions{}.distance;
  /// With accelerate: fewer links for dim late bounces, each sweep quicker and a little noisier. Off: the
  /// fixed point is that of plain sweeps to the last digits (TransportTest.OvershootingReaches...).
  bool thin_late_links = true;
  /// Shadow rays per node over all emitters together, shared out by their expected contribution, >= 1.
  /// Time grows in proportion; the error of soft shadows falls about as its inverse. Default measured in
  /// docs/validation.md#light-samples.
  int light_samples = 64;
  /// With shooting: delta areas (one shadow ray each) per node that a step of reflected light is cut into, >=
  /// 1, shared out like light_samples; dim late steps take fewer. Default measured in
  /// docs/validation.md#delta-areas.
  int delta_areas = 256;
  /// Stop when unshot power is below this fraction of emitted power, in (0, 1). With links also no more than 15
  /// times this fraction of a place's own light may be unshot, on 99 % of the area (docs/validation.md#settled).
  double residual = 1e-3;
  /// With shooting: a step shoots nodes in order of unshot power until this fraction of it is covered, in (0,
  /// 1]. Measured in docs/validation.md#step-fraction.
  double step_fraction = 1.0;
  int max_steps = 1000;    ///< stop after so many steps of reflected light
  double max_seconds = 0;  ///< stop after so long; 0: no limit
  uint64_t seed = 1;

  /// A sentence saying what is out of range, or an empty string.
  std::string Validate() const;
};

}  // namespace lobe
