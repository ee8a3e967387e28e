#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "brdf/rgb.h"

namespace lobe {

/// Pixels x0 <= x < x1, y0 <= y < y1, from the top left.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool Contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  bool operator==(const PixelRect&) const = default;
};
/// What two rectangles share; empty, perhaps of negative size, if nothing.
inline PixelRect Intersection(const PixelRect& a, const PixelRect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// Scene-linear picture, row by row from the top left.
struct Image {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;

  Image() = default;
  Image(int w, int h) : width(w), height(h), pixels(size_t(w) * h, Rgb::Zero()) {}
  Rgb& at(int x, int y) { return pixels[size_t(y) * width + x]; }
  const Rgb& at(int x, int y) const { return pixels[size_t(y) * width + x]; }
};

/// The pixels of `rect`, which lies within the image.
Image Part(const Image& image, const PixelRect& rect);

/// sRGB transfer function (IEC 61966-2-1) of a linear value times 2^exposure, clamped, 0..255.
unsigned char ToSrgb8(float linear, float exposure = 0);

}  // namespace lobe
