#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/image.h"
#include "render/tone.h"

namespace lobe {

/// 8-bit sRGB; value = curve(linear x 2^exposure). Written to a temporary name and renamed. Throws
/// InputError.
void WritePng(const Image& image, float exposure, const std::string& path,
              ToneCurve curve = ToneCurve::kSrgb);

/// A mask: true where the (first) channel is at least half. Grey, palette, RGB(A), 1 to 16 bits. Throws
/// InputError.
struct Mask {
  int width = 0, height = 0;
  std::vector<bool> set;
};
Mask ReadPngMask(const std::string& path);
/// 8-bit grey: 255 where set, else 0. Written to a temporary name and renamed. Throws InputError.
void WritePngMask(const Mask& mask, const std::string& path);

/// Raw 8-bit RGB, row by row.
void WritePngBytes(int width, int height, const std::vector<unsigned char>& rgb, const std::string& path);

/// A PNG file in memory, from raw 8-bit samples, row by row; channels: 1 (grey), 3 (RGB)
/// or 4 (RGBA, not premultiplied). Throws std::invalid_argument when the sizes do not fit.
std::vector<uint8_t> EncodePng(int width, int height, int channels,
                               const std::vector<unsigned char>& samples);

}  // namespace lobe
