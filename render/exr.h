#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "render/image.h"

namespace lobe {

/// Named attributes written into an OpenEXR header. Matrices are 16 floats, row-major.
using ExrAttributes = std::map<std::string, std::variant<std::string, float, int, std::vector<float>>>;

/// Scene-linear float R G B, ZIP. Written to a temporary name and renamed. Throws InputError.
void WriteExr(const Image& image, const ExrAttributes& attributes, const std::string& path);

/// R, G, B of any OpenEXR (half or float, scan lines or tiles, one part). Throws InputError naming file,
/// what was found and what is wanted.
Image ReadExr(const std::string& path);
ExrAttributes ReadExrAttributes(const std::string& path);

}  // namespace lobe
