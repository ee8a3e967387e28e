#pragma once

#include <string>

#include "solver/solution.h"

namespace lobe {

/// What a solution's own record says about it.
enum class Trust {
  kSound,
  kUnfinished,     ///< stopped by a limit or an interrupt: right as far as it goes
  kCoarse,         ///< the imbalance is above kCoarseImbalance
  kWrong,          ///< the imbalance is above kWrongImbalance
  kNotConverging,  ///< light grew, or did not fade: its numbers mean nothing
};
const char* Name(Trust trust);

/// Of Ledger::RelativeImbalance. A mesh that is too coarse delivers more or less than was sent. Where
/// surfaces gain what others lose, the sum does not show it. Measured: docs/validation.md#imbalance.
inline constexpr double kCoarseImbalance = 0.03, kWrongImbalance = 0.10;

/// The worst of what applies.
Trust JudgeSolution(const Solution& solution);

/// One sentence with figures and remedy, without the file's name; empty if sound.
std::string TrustSentence(const Solution& solution);

}  // namespace lobe
