#pragma once

#include <vector>

#include "scene/contact_lines.h"

namespace lobe {

/// Joins lines that continue each other into chains, and replaces each chain by the fewest of its points that
/// stay within `tolerance` of the others (Douglas and Peucker, 1973). Ends, branchings and closed loops stay.
/// Points nearer to each other than `snap` are one; repeated lines go.
std::vector<ContactLine> Straighten(const std::vector<ContactLine>& lines, double snap, double tolerance);

}  // namespace lobe
