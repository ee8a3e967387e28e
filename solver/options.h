#pragma once

#include <cstdint>
#include <string>

#include "brdf/material_lobes.h"
#include "scene/contacts.h"
#include "scene/tessellate.h"

namespace lobe {

struct SolveOptions {
  TessellateOptions mesh;
  LobeOptions lobes;
  /// Faces are cut along the lines where other faces touch them or come nearer than this, metres; 0: not at all
  /// (scene/contacts.h).
  float contact_distance = ContactOptions{}.distance;
  /// Shadow rays per node over all emitters together, shared out by their expected contribution, >= 1.
  /// Time grows in proportion; the error of soft shadows falls about as its inverse. Default measured in
  /// docs/validation.md#light-samples.
  int light_samples = 64;
  /// Delta areas (one shadow ray each) per node that a step of reflected light is cut into, >= 1, shared out
  /// like light_samples; dim late steps take fewer. Default measured in docs/validation.md#delta-areas.
  int delta_areas = 256;
  /// Stop when unshot power is below this fraction of emitted power, in (0, 1).
  double residual = 1e-3;
  /// A step shoots nodes in order of unshot power until this fraction of it is covered, in (0, 1].
  /// Measured in docs/validation.md#step-fraction.
  double step_fraction = 1.0;
  int max_steps = 1000;    ///< stop after so many steps of reflected light
  double max_seconds = 0;  ///< stop after so long; 0: no limit
  uint64_t seed = 1;

  /// A sentence saying what is out of range, or an empty string.
  std::string Validate() const;
};

}  // namespace lobe
