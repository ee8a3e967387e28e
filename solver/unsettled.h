#pragma once

#include <vector>

#include "solver/node_lobes.h"

namespace lobe {

/// The share of the area that reflects light on which more than `fraction` of the reflected light is unshot,
/// by absolute values. `area` per node; 0: leave the node out.
///
/// The residual of a solve is of all emitted power, so a dim room beside a bright one hardly counts in it.
/// This one is of the place. A plain sweep never enlarges the largest fraction there is: reflected light is
/// at least what the sweep carries of it (B >= R B for the operator R of one reflection), so |unshot| <= f B
/// becomes |R unshot| <= f R B <= f B.
double UnsettledArea(const NodeLobes& total, const NodeLobes& unshot, const std::vector<double>& area,
                     double fraction);

}  // namespace lobe
