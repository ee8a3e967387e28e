#pragma once

#include <string>

#include "brdf/measured.h"

namespace lobe {

/// Reads a table of measured reflectance as text, the columns of which are docs/format.md#goniometer:
/// theta_i, theta_o, dphi (degrees), then f_r, or its red, green and blue (sr^-1). Every theta_i has the same
/// theta_o, each of those the same dphi, all rising; so a gap, a repetition or a row out of order is told by
/// its line. Throws InputError.
Measured ReadGoniometerFile(const std::string& path);

}  // namespace lobe
