#pragma once

namespace lobe {

/// Bytes of memory that can still be had without swapping: what the system says is available, and what a
/// container's limit leaves of it. 0 if neither is known.
double AvailableMemory();

}  // namespace lobe
