#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "solver/options.h"

namespace lobe {

/// What --resume lets be given beside it: limits and where to write. A setting that decides about the
/// solution may be repeated, as long as it says what `file` was solved with (`own`). `given`: the values of
/// the command line. Throws UsageError naming the first flag that says otherwise.
void RefuseOtherSettings(const CLI::App& command, const SolveOptions& given, const SolveOptions& own,
                         const std::string& file);

/// `own` with the limits that were given on the command line.
SolveOptions WithGivenLimits(const CLI::App& command, const SolveOptions& given, SolveOptions own);

}  // namespace lobe
