#include "app/values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <vector>

#include "app/commands.h"

namespace lobe {
namespace {

[[noreturn]] void Refuse(const std::string& flag, const std::string& text, const std::string& expected) {
  throw UsageError(flag + ": '" + text + "' is not " + expected);
}

/// All of `text` as numbers between separators; empty when it is anything else.
template <typename Number>
std::vector<Number> Numbers(const std::string& text, char separator) {
  std::vector<Number> numbers;
  const char *at = text.data(), *end = at + text.size();
  for (;;) {
    Number value{};
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc()) return {};
    numbers.push_back(value);
    if (next == end) return numbers;
    if (*next != separator) return {};
    at = next + 1;
  }
}

}  // namespace

PictureSize ParseSize(const std::string& flag, const std::string& text) {
  const auto numbers = Numbers<int>(text, 'x');
  if (numbers.size() != 2) Refuse(flag, text, "a size such as 640x480, in pixels");
  for (const int n : numbers) {
    if (n < 1 || n > 65536) Refuse(flag, text, "a size of 1 to 65536 pixels a side");
  }
  return {numbers[0], numbers[1]};
}

PictureSize DefaultSize(const Camera& camera) {
  constexpr int kHeight = 512;
  const double width = std::round(kHeight * double(camera.aspect));
  return {static_cast<int>(std::clamp(width, 1.0, 16.0 * kHeight)), kHeight};
}

Vec3 ParseVector(const std::string& flag, const std::string& text) {
  const auto numbers = Numbers<float>(text, ',');
  if (numbers.size() != 3) Refuse(flag, text, "three numbers such as 1,2.5,-3, in metres");
  for (const float n : numbers) {
    if (!std::isfinite(n)) Refuse(flag, text, "three finite numbers");
  }
  return {numbers[0], numbers[1], numbers[2]};
}

PixelPosition ParsePixel(const std::string& flag, const std::string& text) {
  const auto numbers = Numbers<int>(text, ',');
  if (numbers.size() != 2) Refuse(flag, text, "a pixel such as 17,3, counted from 0,0 at the top left");
  return {numbers[0], numbers[1]};
}

PixelRect ParseRect(const std::string& flag, const std::string& text) {
  const auto n = Numbers<int>(text, ',');
  if (n.size() != 4) Refuse(flag, text, "a rectangle X0,Y0,X1,Y1 in pixels, such as 10,20,30,40");
  if (n[0] < 0 || n[1] < 0 || n[0] >= n[2] || n[1] >= n[3]) {
    Refuse(flag, text, "a rectangle with 0 <= X0 < X1 and 0 <= Y0 < Y1");
  }
  return {n[0], n[1], n[2], n[3]};
}

ToneCurve ParseTone(const std::string& flag, const std::string& text) {
  const auto curve = ToneCurveNamed(text);
  if (!curve) Refuse(flag, text, "srgb, reinhard or filmic");
  return *curve;
}

void RequireExposure(const std::string& flag, float stops) {
  if (!(std::abs(stops) <= 100)) Refuse(flag, std::to_string(stops), "a number of stops from -100 to 100");
}

void RequireExtension(const std::string& flag, const std::string& path,
                      std::initializer_list<const char*> endings) {
  const std::string extension = Extension(path);
  std::string expected;
  for (const char* ending : endings) {
    if (extension == ending) return;
    if (!expected.empty()) expected += " or ";
    expected += ending;
  }
  Refuse(flag, path, "a name ending in " + expected);
}

void RequireOtherFile(const std::string& flag, const std::string& path, const std::string& input,
                      const std::string& what) {
  std::error_code none;
  if (std::filesystem::equivalent(path, input, none)) {
    throw UsageError(flag + ": " + path + " is " + what + " itself; another name is expected");
  }
}

}  // namespace lobe
