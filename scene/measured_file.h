#pragma once

#include <string>

#include "brdf/measured.h"

namespace lobe {

/// Reads measured reflectance: names that end in .binary as MERL's format (merl_file.h), all others as a
/// table of angles (goniometer_file.h). Throws InputError, one sentence, for whatever is missing or wrong.
Measured ReadMeasuredFile(const std::string& path);

}  // namespace lobe
