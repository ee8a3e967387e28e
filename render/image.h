#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "brdf/rgb.h"

namespace lobe {

/// Scene-linear picture, row by row from the top left.
struct Image {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;

  Image() = default;
  Image(int w, int h) : width(w), height(h), pixels(size_t(w) * h, Rgb::Zero()) {}
  Rgb& at(int x, int y) { return pixels[size_t(y) * width + x]; }
  const Rgb& at(int x, int y) const { return pixels[size_t(y) * width + x]; }
};

/// sRGB transfer function (IEC 61966-2-1) of a linear value times 2^exposure, clamped, 0..255.
unsigned char ToSrgb8(float linear, float exposure = 0);

}  // namespace lobe
