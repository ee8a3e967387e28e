#pragma once

#include <chrono>
#include <string>

#include "app/console.h"

namespace lobe {

/// How far a long task is, on standard error: on a terminal one line redrawn in place, elsewhere a plain
/// line now and then. Says nothing when the console is quiet.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(const Console& console);
  /// Takes the bar off the terminal.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// `fraction` 0..1. Cheap when called often: most calls print nothing.
  void Show(double fraction, const std::string& words);
  /// Takes the bar off the terminal until the next Show, so that something else can be said.
  void Clear();

 private:
  using Clock = std::chrono::steady_clock;
  const Console& console_;
  const bool terminal_;
  Clock::time_point last_;
  size_t drawn_ = 0;  ///< columns of the bar now on the terminal
};

}  // namespace lobe
