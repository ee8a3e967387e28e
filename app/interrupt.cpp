#include "app/interrupt.h"

#include <csignal>

namespace lobe {
namespace {

std::atomic<bool> g_interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set inside a signal handler");

extern "C" void OnInterrupt(int) { g_interrupted.store(true); }

void CatchOnce(int signal) {
  struct sigaction action = {};
  action.sa_handler = OnInterrupt;
  // Back to the default after the first: the second kills. System calls under way go on.
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  sigaction(signal, &action, nullptr);
}

}  // namespace

const std::atomic<bool>* CatchInterrupts() {
  CatchOnce(SIGINT);
  CatchOnce(SIGTERM);
  return &g_interrupted;
}

}  // namespace lobe
