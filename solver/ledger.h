#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace lobe {

/// Where the power went, watts, per channel. Every entry is computed from its own cause, none as the
/// rest, so that the balance is a check:
///   emitted + imbalance = absorbed + in_glass + blocked + escaped + below_facets + mirrored + truncated +
///   unshot.
struct Ledger {
  using Power = std::array<double, 3>;
  Power emitted{};    ///< pi Le A over the emitting triangles
  Power sent{};       ///< emitted, and unshot light that steps have moved on
  Power delivered{};  ///< irradiance x area, summed over receiving nodes
  Power absorbed{};   ///< delivered x (1 - albedo), angle by angle
  Power in_glass{};  ///< absorbed by coloured glass on the way between nodes, where no node of it counts that
  Power reflected{};  ///< reflected, or let through sheets: flux of the lobes that delivered light made
  Power mirrored{};   ///< sent on by ideal mirrors and glass, where shooting stops
  Power passed_on{};  ///< sent on by ideal mirrors and glass, and carried on by links
  Power truncated{};  ///< delivered - absorbed - reflected - by mirrors: what the lobes' tables lose
  Power escaped{};    ///< sent along rays that leave the scene
  Power blocked{};    ///< sent to black backs, to sides without nodes, beyond Links::kMaxMirrors, kMaxGlass
  Power below_facets{};  ///< sent by lobes of smooth-shaded surfaces below the facet that they stand on
  Power unshot{};        ///< still waiting at the end
  /// Delivered minus (sent + passed_on - escaped - blocked - in_glass - below_facets): point collocation does
  /// not conserve power. Tends to 0 as the mesh is refined.
  Power imbalance{};

  double Closure() const;  ///< |emitted + imbalance - ...| / emitted, luminance-free sum of channels
  double RelativeImbalance() const;  ///< sum of |imbalance| / sum of delivered
};

/// One step of the solver, for the convergence record.
struct StepRecord {
  int step = 0;           ///< 0: emission
  double residual = 1;    ///< unshot / emitted after it
  double seconds = 0;     ///< since the start
  uint64_t rays = 0;      ///< so far
  uint32_t shooters = 0;  ///< nodes that shot; in step 0, emitting sides of faces; 0: the step was taken back
};

}  // namespace lobe
