#include "solver/ledger.h"

#include <cmath>

namespace lobe {

double Ledger::Closure() const {
  double off = 0, power = 0;
  for (int c = 0; c < 3; ++c) {
    off += std::abs(emitted[c] + imbalance[c] - absorbed[c] - in_glass[c] - blocked[c] - escaped[c] -
                    below_facets[c] - mirrored[c] - truncated[c] - unshot[c]);
    power += emitted[c];
  }
  return power > 0 ? off / power : 0.0;
}

double Ledger::RelativeImbalance() const {
  double off = 0, power = 0;
  for (int c = 0; c < 3; ++c) {
    off += std::abs(imbalance[c]);
    power += delivered[c];
  }
  return power > 0 ? off / power : 0.0;
}

}  // namespace lobe
