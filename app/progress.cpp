#include "app/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace lobe {
namespace {

// Chosen: fast enough to look alive, slow enough to read; and logs stay short.
constexpr auto kTerminalPause = std::chrono::milliseconds(100);
constexpr auto kPlainPause = std::chrono::seconds(2);
constexpr int kBarWidth = 24;

}  // namespace

ProgressDisplay::ProgressDisplay(const Console& console)
    : console_(console), terminal_(isatty(STDERR_FILENO)), last_(Clock::now()) {}

ProgressDisplay::~ProgressDisplay() { Clear(); }

void ProgressDisplay::Clear() {
  if (drawn_ == 0) return;
  std::fprintf(stderr, "\r%*s\r", static_cast<int>(drawn_), "");
  std::fflush(stderr);
  drawn_ = 0;
}

void ProgressDisplay::Show(double fraction, const std::string& words) {
  if (console_.quiet()) return;
  const auto now = Clock::now();
  if (now - last_ < (terminal_ ? Clock::duration(kTerminalPause) : Clock::duration(kPlainPause))) return;
  last_ = now;
  fraction = fraction > 0 ? std::min(fraction, 1.0) : 0.0;
  const std::string percent = Format("%3.0f %%", 100 * fraction);
  if (!terminal_) {
    console_.Say(percent + "  " + words);
    return;
  }
  const auto filled = static_cast<size_t>(kBarWidth * fraction);
  std::string line = "[";
  line.append(filled, '#')
      .append(kBarWidth - filled, '.')
      .append("] ")
      .append(percent)
      .append("  ")
      .append(words);
  const size_t columns = line.size();
  std::fprintf(stderr, "\r%s%*s", line.c_str(), static_cast<int>(drawn_ > columns ? drawn_ - columns : 0),
               "");
  std::fflush(stderr);
  drawn_ = columns;
}

}  // namespace lobe
