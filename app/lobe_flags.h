#pragma once

#include <optional>

#include <CLI/CLI.hpp>

#include "brdf/material_lobes.h"

namespace lobe {

/// The flags that choose lobes' degrees: --lmax, --lobe-error, --force-lmax.
struct LobeFlags {
  int l_max = LobeOptions{}.l_max;
  double error_percent = 100 * LobeOptions{}.error;
  std::optional<int> force_l_max;

  void AddTo(CLI::App* command);
  /// Throws UsageError if a forced degree is out of range; SolveOptions::Validate sees to the rest.
  LobeOptions Options() const;
};

}  // namespace lobe
