#include "render/tone.h"

#include <algorithm>
#include <cmath>

namespace lobe {
namespace {

float Reinhard(float x) { return x * (1 + x / (kReinhardWhite * kReinhardWhite)) / (1 + x); }

float HableUnscaled(float x) {
  // Shoulder and linear strength, linear angle, toe strength, numerator, denominator: Hable's letters.
  constexpr float A = 0.15f, B = 0.50f, C = 0.10f, D = 0.20f, E = 0.02f, F = 0.30f;
  return (x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F) - E / F;
}

float Hable(float x) {
  constexpr float kBias = 2;
  return HableUnscaled(kBias * x) / HableUnscaled(kBias * kFilmicWhite);
}

}  // namespace

std::optional<ToneCurve> ToneCurveNamed(const std::string& name) {
  if (name == "srgb") return ToneCurve::kSrgb;
  if (name == "reinhard") return ToneCurve::kReinhard;
  if (name == "filmic") return ToneCurve::kFilmic;
  return std::nullopt;
}

float ToneMap(ToneCurve curve, float linear) {
  if (!(linear > 0)) return 0;
  switch (curve) {
    case ToneCurve::kSrgb:
      return std::min(linear, 1.0f);
    // Above white both are cut there, which also keeps huge values from inf / inf.
    case ToneCurve::kReinhard:
      return linear >= kReinhardWhite ? 1 : std::min(1.0f, Reinhard(linear));
    case ToneCurve::kFilmic:
      return linear >= kFilmicWhite ? 1 : std::clamp(Hable(linear), 0.0f, 1.0f);
  }
  return 0;
}

Image ToneMapped(const Image& image, float exposure, ToneCurve curve) {
  const float scale = std::exp2(exposure);
  Image shown(image.width, image.height);
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) shown.pixels[i][c] = ToneMap(curve, image.pixels[i][c] * scale);
  }
  return shown;
}

}  // namespace lobe
