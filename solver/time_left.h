#pragma once

#include <optional>
#include <vector>

#include "solver/ledger.h"
#include "solver/options.h"

namespace lobe {

/// Seconds until a solve stops: as if the coming steps would dim and take what the last ones did on average,
/// or until a limit of `options`. Nothing before two steps of reflected light are done, or when they do not
/// dim. `fraction` of the step under way is done; `seconds_of_run` counts towards max_seconds.
std::optional<double> SecondsLeft(const std::vector<StepRecord>& history, const SolveOptions& options,
                                  double fraction, double seconds_of_run);

}  // namespace lobe
