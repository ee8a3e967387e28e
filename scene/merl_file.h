#pragma once

#include <string>

#include "brdf/measured.h"

namespace lobe {

/// Size of MERL's grid: angle of the half vector, of the difference, azimuth of the difference.
inline constexpr int kMerlSize[3] = {90, 90, 180};
/// What a stored red, green, blue is multiplied by.
inline constexpr double kMerlScale[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};

/// Reads a file of the MERL database (Matusik, Pfister, Brand, McMillan, "A Data-Driven Reflectance Model",
/// SIGGRAPH 2003): three 32-bit integers 90, 90, 180, then red, green and blue as 64-bit floats, all
/// little-endian, at [(theta_h * 90 + theta_d) * 180 + phi_d]. Ring i of theta_h covers i^2/90 to (i+1)^2/90
/// degrees, the others a degree each.
///
/// A bin's value is taken for its centre (of theta_h: (i + 1/2)^2 / 90 degrees) and the reflectance is linear
/// in between. phi_d and 180 - phi_d, mirror images in the plane of incidence, are averaged. Negative values
/// mark directions below the horizon: such a bin gets the value of the nearest smaller theta_h, which
/// interpolation beside the horizon then sees. Nothing is limited: where the data reflects more than it gets,
/// so does the material. Throws InputError naming what was found and what is expected.
Measured ReadMerlFile(const std::string& path);

}  // namespace lobe
