#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "app/console.h"

namespace lobe {

/// What the program returns (also in `lobe --help`).
enum ExitCode : int {
  kDone = 0,
  kFailed = 1,        ///< something was wrong with the input or the machine
  kWrongUsage = 2,    ///< unknown, missing or out-of-range flags
  kStoppedEarly = 3,  ///< interrupt, time or step limit, or not converging; the result is saved
  kNotTrusted = 4,    ///< finished and saved, but its own ledger says not to trust it (solver/trust.h)
};

/// A flag's value is wrong; the message is a sentence that names flag and value. Exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Flags that every command has.
struct CommonFlags {
  int threads = 0;  ///< 0: all processors
  bool json = false, quiet = false;
};

/// What a command hands back to main: run after all flags are parsed.
using Command = std::function<ExitCode(Console&)>;

/// --seed, which commands share that choose anything at random.
void AddSeedFlag(CLI::App* command, uint64_t* seed);

/// Each adds its subcommand to `app`; when that is the one asked for, `*command` is set.
void AddSolveCommand(CLI::App& app, Command* command);
void AddRenderCommand(CLI::App& app, Command* command);
void AddInfoCommand(CLI::App& app, Command* command);
void AddInspectCommand(CLI::App& app, Command* command);
void AddCompareCommand(CLI::App& app, Command* command);
void AddBrdfCommand(CLI::App& app, Command* command);
void AddViewCommand(CLI::App& app, Command* command);
void AddExportCommand(CLI::App& app, Command* command);

}  // namespace lobe
