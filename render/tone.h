#pragma once

#include <optional>
#include <string>

#include "render/image.h"

namespace lobe {

/// How scene-linear values become what a screen can show, 0..1. All are per channel (so that no colour
/// leaves the gamut), never fall, and take 0 to 0.
enum class ToneCurve {
  kSrgb,      ///< the value itself, cut at 1: what is shown is measured light
  kReinhard,  ///< x (1 + x / W^2) / (1 + x), W = kReinhardWhite: Reinhard et al., "Photographic Tone
              ///< Reproduction for Digital Images", SIGGRAPH 2002, eq. 4
  kFilmic,    ///< J. Hable's curve for Uncharted 2 ("HDR Lighting", GDC 2010), with its linear white 11.2
              ///< and its exposure bias of 2: a toe for the shadows and a shoulder for the lights
};

/// Scene-linear values shown as 1; what is above is cut. The first is chosen, the second Hable's 11.2 / 2.
inline constexpr float kReinhardWhite = 4;
inline constexpr float kFilmicWhite = 5.6f;

/// "srgb", "reinhard", "filmic".
std::optional<ToneCurve> ToneCurveNamed(const std::string& name);

/// 0..1, still linear (the sRGB transfer function comes after it). Negative values and NaN give 0.
float ToneMap(ToneCurve curve, float linear);

/// The picture as it is shown: times 2^exposure, through the curve; linear, every value 0..1.
Image ToneMapped(const Image& image, float exposure, ToneCurve curve);

}  // namespace lobe
