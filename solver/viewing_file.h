#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "solver/solution.h"

namespace lobe {

enum class ViewingPrecision {
  kFloat,  ///< the solution's coefficients, bit for bit
  kHalf,   ///< half the bytes; error: solver/half_values.h
};

/// A solution reduced to what looking at it needs (docs/format.md#viewing), as the bytes of a .glb: lobes of
/// all light together, materials' hemispherical albedo, and what any viewer shows. Builds the materials' lobe
/// tables once more. `name` is what messages call it. Throws InputError if it would have 4 GiB.
std::vector<uint8_t> ViewingFile(const Solution& solution, ViewingPrecision precision,
                                 const std::string& name);

}  // namespace lobe
