#include "solver/trust.h"

#include <cstdio>

namespace lobe {
namespace {

std::string Percent(double fraction) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * fraction);
  return text;
}

}  // namespace

const char* Name(Trust trust) {
  switch (trust) {
    case Trust::kSound:
      return "sound";
    case Trust::kUnfinished:
      return "unfinished";
    case Trust::kCoarse:
      return "coarse";
    case Trust::kWrong:
      return "wrong";
    case Trust::kNotConverging:
      return "not converging";
  }
  return "";
}

Trust JudgeSolution(const Solution& s) {
  if (s.stop_reason == StopReason::kNotConverging) return Trust::kNotConverging;
  const double imbalance = s.ledger.RelativeImbalance();
  // Not below, so that NaN is wrong.
  if (!(imbalance <= kWrongImbalance)) return Trust::kWrong;
  if (imbalance > kCoarseImbalance) return Trust::kCoarse;
  return s.stop_reason == StopReason::kConverged ? Trust::kSound : Trust::kUnfinished;
}

std::string TrustSentence(const Solution& s) {
  const std::string unshot = Percent(s.residual()) + " of the emitted power",
                    imbalance = Percent(s.ledger.RelativeImbalance());
  switch (JudgeSolution(s)) {
    case Trust::kSound:
      return {};
    case Trust::kUnfinished:
      return "the solution is not finished: " + unshot +
             " is unshot, and that much light is missing; --resume goes on";
    case Trust::kCoarse:
      return "the mesh is too coarse for the light on it: it made or lost " + imbalance +
             " of what was delivered, expected at most 3 %; a smaller --edge helps";
    case Trust::kWrong:
      return "the solution is not to be trusted: its mesh made or lost " + imbalance +
             " of what was delivered, expected at most 10 %; a smaller --edge helps";
    case Trust::kNotConverging:
      return "the solution did not converge and is not to be trusted: " + unshot + " is unshot (imbalance " +
             imbalance + " of what was delivered); more --links or a smaller --lmax may help";
  }
  return {};
}

}  // namespace lobe
