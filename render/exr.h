#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "render/layers.h"

namespace lobe {

/// Named attributes written into an OpenEXR header. Matrices are 16 floats, row-major.
using ExrAttributes = std::map<std::string, std::variant<std::string, float, int, std::vector<float>>>;

struct ExrOptions {
  /// R, G, B and the layers of colours as 16-bit half: half the size, 3 significant digits, at most
  /// kHalfMax. N, P and Z stay float.
  bool half_colours = false;
  /// The full picture (the file's display window) of which `image` is the part that begins at (left, top)
  /// (its data window). 0 x 0: the picture itself.
  int full_width = 0, full_height = 0, left = 0, top = 0;
};

struct ExrReport {
  size_t clamped = 0;  ///< values beyond +-kHalfMax, infinite ones too, written as +-kHalfMax
};

/// The largest half. Beyond it half has only infinity, which no filter survives.
inline constexpr float kHalfMax = 65504;
/// What Z holds where nothing is hit, in place of infinity: Blender's figure, which its nodes know, and
/// which readers may average without meeting inf - inf.
inline constexpr float kBackgroundDepth = 1e10f;

/// Scene-linear R G B (Rec. 709) and the layers there are, ZIP. Written to a temporary name and renamed.
/// Throws InputError; std::invalid_argument if sizes or windows do not fit.
ExrReport WriteExr(const LayeredImage& image, const ExrAttributes& attributes, const ExrOptions& options,
                   const std::string& path);
/// The same without layers, as float: bit for bit.
void WriteExr(const Image& image, const ExrAttributes& attributes, const std::string& path);

/// R, G, B of any OpenEXR (half or float, scan lines or tiles, first part): the pixels of its data window.
/// Throws InputError naming file, what was found and what is wanted.
Image ReadExr(const std::string& path);
ExrAttributes ReadExrAttributes(const std::string& path);

struct ExrLayer {
  Image image;          ///< a single channel comes three times
  bool colour = false;  ///< R, G, B; else X, Y, Z or a single channel
};
/// Names that ReadExrLayer understands: L for channels L.R, L.G, L.B or L.X, L.Y, L.Z; all others but R, G,
/// B and alpha by their own. Throws InputError.
std::vector<std::string> ListExrLayers(const std::string& path);
ExrLayer ReadExrLayer(const std::string& path, const std::string& name);

/// The file's data and display window. Throws InputError.
struct ExrWindows {
  PixelRect data, display;
};
ExrWindows ReadExrWindows(const std::string& path);

}  // namespace lobe
