#pragma once

#include <array>

#include "brdf/rgb.h"

namespace lobe {

/// Dark blue over magenta and orange to pale yellow for t in 0..1 (clamped), lightness rising evenly,
/// so that it reads in grey too. As sRGB bytes for 8-bit pictures.
std::array<unsigned char, 3> FalseColourBytes(double t);
/// The linear value that shows as that colour.
Rgb FalseColour(double t);

/// Linear value of an sRGB byte (IEC 61966-2-1).
float FromSrgb8(unsigned char encoded);

}  // namespace lobe
