#pragma once

namespace lobe {

/// Multiply-adds in single precision a CPU second of this thread, sixteen side by side in as many independent
/// chains as keep the units busy: what no kernel of sh/lanes.h can pass on the machine and with the
/// instruction set that the loader chose. Takes about 20 ms.
double PeakMultiplyAdds();

}  // namespace lobe
