#pragma once

#include "scene/gltf_json.h"
#include "solver/solution.h"

namespace lobe {

/// Everything of a solution that is neither geometry nor lobes, as members of the document's
/// LOBE_directional_radiance (docs/format.md#document): settings, materials' kinds, ledger, history, why and
/// when it stopped. Numbers carry enough digits to come back bit for bit.
nlohmann::json SolutionRecord(const Solution& solution);

/// The way back; fills the same members of `solution`. Throws InputError.
void ReadSolutionRecord(const GltfJson& record, Solution* solution);

/// "front" and "back".
const char* Name(Side side);

inline constexpr const char* kExtensionName = "LOBE_directional_radiance";
inline constexpr int kFormatVersion = 1;
inline constexpr const char* kBasisName = "H";
inline constexpr const char* kFrameName = "duff2017";

}  // namespace lobe
