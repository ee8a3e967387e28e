#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace lobe {

/// Where the power went, watts, per channel. Every entry is computed from its own cause, none as the
/// rest, so that the balance is a check:
///   emitted + imbalance = absorbed + blocked + escaped + mirrored + truncated + unshot.
struct Ledger {
  using Power = std::array<double, 3>;
  Power emitted{};    ///< pi Le A over the emitting triangles
  Power sent{};       ///< emitted, and unshot light that steps have moved on
  Power delivered{};  ///< irradiance x area, summed over receiving nodes
  Power absorbed{};   ///< delivered x (1 - albedo), angle by angle
  Power reflected{};  ///< reflected, or let through sheets: flux of the lobes that delivered light made
  Power mirrored{};   ///< reflected by ideal mirrors, where shooting stops
  Power passed_on{};  ///< reflected by ideal mirrors and carried on by links
  Power truncated{};  ///< delivered - absorbed - reflected - by mirrors: what the lobes' tables lose
  Power escaped{};    ///< sent along rays that leave the scene
  Power blocked{};    ///< sent to black backs, to sides without nodes, and beyond Links::kMaxMirrors mirrors
  Power unshot{};     ///< still waiting at the end
  /// Delivered minus (sent + passed_on - escaped - blocked): point collocation does not conserve power. Tends
  /// to 0 as the mesh is refined.
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
  uint32_t shooters = 0;  ///< nodes that shot; in step 0, emitting sides of faces
};

}  // namespace lobe
