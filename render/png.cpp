#include "render/png.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <png.h>

#include "scene/glb_writer.h"
#include "scene/input_error.h"

// libpng's "simplified" interface: it reports errors by return value, where the classic one jumps over
// destructors with longjmp.

namespace lobe {
namespace {

/// Larger masks are refused before memory is asked for: 2^28 pixels (chosen), 16384 x 16384.
constexpr uint64_t kMaxPixels = uint64_t(1) << 28;

/// Frees libpng's state on every way out.
struct PngImage {
  png_image image{};
  PngImage() { image.version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(&image); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
};

}  // namespace

std::vector<uint8_t> EncodePng(int width, int height, int channels,
                               const std::vector<unsigned char>& samples) {
  if (width < 1 || height < 1 || (channels != 1 && channels != 3 && channels != 4) ||
      samples.size() != size_t(width) * height * channels) {
    throw std::invalid_argument("EncodePng: samples do not fit the picture's size");
  }
  PngImage png;
  png.image.width = width;
  png.image.height = height;
  png.image.format = channels == 4 ? PNG_FORMAT_RGBA : channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY;

  // The documented upper bound saves libpng's alternative, which is to compress twice.
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png.image);
  std::vector<uint8_t> bytes(size);
  if (!png_image_write_to_memory(&png.image, bytes.data(), &size, 0, samples.data(), 0, nullptr)) {
    throw std::runtime_error(std::string("PNG encoding failed: ") + png.image.message);
  }
  bytes.resize(size);
  return bytes;
}

void WritePngBytes(int width, int height, const std::vector<unsigned char>& rgb, const std::string& path) {
  WriteFileAtomically(path, EncodePng(width, height, 3, rgb));
}

void WritePng(const Image& image, float exposure, const std::string& path, ToneCurve curve) {
  const float scale = std::exp2(exposure);
  std::vector<unsigned char> rgb;
  rgb.reserve(image.pixels.size() * 3);
  for (const Rgb& pixel : image.pixels) {
    for (int c = 0; c < 3; ++c) rgb.push_back(ToSrgb8(ToneMap(curve, pixel[c] * scale)));
  }
  WritePngBytes(image.width, image.height, rgb, path);
}

Mask ReadPngMask(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw InputError(path + ": is a directory; a PNG mask is expected");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be opened; a PNG mask is expected");
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());

  const auto fail = [&](const std::string& found) {
    throw InputError(path + ": not a readable PNG (" + found + ")");
  };
  // Asked first, because libpng's own words for it depend on how many bytes there are.
  if (bytes.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) != 0) {
    fail("it does not begin with the PNG signature");
  }
  PngImage png;
  if (!png_image_begin_read_from_memory(&png.image, bytes.data(), bytes.size())) fail(png.image.message);
  const uint64_t pixels = uint64_t(png.image.width) * png.image.height;
  if (pixels > kMaxPixels) {
    throw InputError(path + ": " + std::to_string(png.image.width) + " x " +
                     std::to_string(png.image.height) + " pixels; a mask has at most 2^28");
  }
  // Without the flag libpng would take 16-bit files for linear and move the threshold. With an alpha
  // channel asked for, it is kept apart and does not touch the colours.
  png.image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  png.image.format = PNG_FORMAT_RGBA;
  std::vector<unsigned char> rgba(pixels * 4);
  if (!png_image_finish_read(&png.image, nullptr, rgba.data(), 0, nullptr)) fail(png.image.message);

  Mask mask;
  mask.width = int(png.image.width);
  mask.height = int(png.image.height);
  mask.set.resize(pixels);
  for (size_t i = 0; i < pixels; ++i) mask.set[i] = rgba[4 * i] >= 128;
  return mask;
}

void WritePngMask(const Mask& mask, const std::string& path) {
  std::vector<unsigned char> grey;
  grey.reserve(mask.set.size());
  for (const bool set : mask.set) grey.push_back(set ? 255 : 0);
  WriteFileAtomically(path, EncodePng(mask.width, mask.height, 1, grey));
}

}  // namespace lobe
