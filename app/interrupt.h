#pragma once

#include <atomic>

namespace lobe {

/// From here on SIGINT (Ctrl-C) and SIGTERM set the flag, once; a second one ends the program at once.
const std::atomic<bool>* CatchInterrupts();

}  // namespace lobe
