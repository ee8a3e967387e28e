#pragma once

namespace lobe {

/// GGX distribution (Walter et al., EGSR 2007, eq. 33) at half-vector cosine `cos_h`, sr^-1.
double GgxD(double cos_h, double alpha);
/// V = G2 / (4 cos_i cos_o), Smith, height-correlated (Heitz, JCGT 3(2), 2014).
double GgxV(double cos_i, double cos_o, double alpha);

}  // namespace lobe
