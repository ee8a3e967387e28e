#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/image.h"

namespace lobe {

/// What a picture may hold beside its colours. Averages over the pixel's eye rays, unless said otherwise.
enum class Layer {
  kAlbedo,    ///< albedo.R/G/B: reflectance at normal incidence of what is hit first (NormalAlbedo)
  kNormal,    ///< N.X/Y/Z: shading normal, world space, on the side of the eye; average, so shorter at edges
  kPosition,  ///< P.X/Y/Z: world space, metres
  kDepth,     ///< Z: distance from the eye along the viewing direction (not along the ray), metres
  kDirect,    ///< direct.R/G/B: emission seen, and lamps' light reflected once, by what is hit first
  kIndirect,  ///< indirect.R/G/B: the rest of what that reflects
  kSpecular,  ///< specular.R/G/B: all that comes by ideal mirrors and glass; the three sum to the colour
  kClamped,   ///< clamped.R/G/B: of the colour, what was made by showing negative lobe values as zero
};
inline constexpr int kLayerCount = 8;
inline constexpr Layer kAllLayers[kLayerCount] = {Layer::kAlbedo,   Layer::kNormal, Layer::kPosition,
                                                  Layer::kDepth,    Layer::kDirect, Layer::kIndirect,
                                                  Layer::kSpecular, Layer::kClamped};

/// The layer's name in files and on the command line: "albedo", "N", "P", "Z", "direct", ...
const char* LayerName(Layer layer);
/// Names of its channels: 3, or 1 for kDepth.
const std::vector<std::string>& LayerChannels(Layer layer);
/// Whether its values are light or reflectance, which half precision is enough for (positions and depths
/// of a large scene need float).
bool IsColour(Layer layer);

/// A set of layers.
class LayerSet {
 public:
  LayerSet() = default;
  static LayerSet All();
  bool Has(Layer layer) const { return bits_ >> int(layer) & 1; }
  void Add(Layer layer) { bits_ |= 1u << int(layer); }
  bool empty() const { return bits_ == 0; }
  bool operator==(const LayerSet&) const = default;

 private:
  uint32_t bits_ = 0;
};

/// "albedo,N,Z", or "all"; nothing if a name is unknown, missing or given twice, and then `*wrong` is a
/// sentence that says which and lists those there are.
std::optional<LayerSet> ParseLayers(const std::string& text, std::string* wrong);

/// A picture with layers, all of its size.
///
/// Where an eye ray hits nothing it counts as 0 in every layer except kDepth, whose pixel is the nearest
/// hit of its rays and +infinity if there is none: distances are not averaged, since the mean of a near and
/// a far thing is at neither. (Files hold kBackgroundDepth there: render/exr.h.)
struct LayeredImage {
  Image color;
  std::map<Layer, Image> layers;  ///< kDepth uses the first of the three channels

  LayeredImage() = default;
  /// All black, depth +infinity.
  LayeredImage(int width, int height, const LayerSet& wanted);
};

}  // namespace lobe
