#include "render/image.h"

#include <algorithm>
#include <cmath>

namespace lobe {

Image Part(const Image& image, const PixelRect& rect) {
  Image part(rect.width(), rect.height());
  for (int y = 0; y < part.height; ++y) {
    std::copy_n(&image.at(rect.x0, rect.y0 + y), part.width, &part.at(0, y));
  }
  return part;
}

unsigned char ToSrgb8(float linear, float exposure) {
  const float v = linear * std::exp2(exposure);
  if (!(v > 0)) return 0;  // negative and NaN show as black
  if (v >= 1) return 255;
  const float encoded = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
  return static_cast<unsigned char>(std::lround(255 * encoded));
}

}  // namespace lobe
