#include "render/false_colour.h"

#include <algorithm>
#include <cmath>

namespace lobe {
namespace {

/// Stops at equal distances (chosen by eye; CIE lightness about 5, 18, 31, 45, 59, 74, 94).
constexpr double kStops[][3] = {{10, 10, 36},   {50, 22, 110},  {122, 30, 130}, {196, 52, 104},
                                {236, 106, 58}, {247, 168, 50}, {252, 246, 190}};
constexpr int kLast = static_cast<int>(std::size(kStops)) - 1;

}  // namespace

std::array<unsigned char, 3> FalseColourBytes(double t) {
  const double x = (t > 0 ? std::min(t, 1.0) : 0.0) * kLast;
  const int i = std::min(static_cast<int>(x), kLast - 1);
  std::array<unsigned char, 3> colour;
  for (int c = 0; c < 3; ++c) {
    colour[c] = static_cast<unsigned char>(std::lround(std::lerp(kStops[i][c], kStops[i + 1][c], x - i)));
  }
  return colour;
}

float FromSrgb8(unsigned char encoded) {
  const float v = encoded / 255.0f;
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

Rgb FalseColour(double t) {
  const auto bytes = FalseColourBytes(t);
  return {FromSrgb8(bytes[0]), FromSrgb8(bytes[1]), FromSrgb8(bytes[2])};
}

}  // namespace lobe
