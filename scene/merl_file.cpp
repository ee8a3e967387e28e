#include "scene/merl_file.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <vector>

#include "scene/input_error.h"
#include "scene/read_file.h"

namespace lobe {
namespace {

static_assert(std::endian::native == std::endian::little, "MERL's files are read as they lie in memory");

constexpr int kHalf = kMerlSize[0], kDifference = kMerlSize[1], kAzimuth = kMerlSize[2];
constexpr int kFolded = kAzimuth / 2;  // azimuths left of mirror images
constexpr size_t kBins = size_t(kHalf) * kDifference * kAzimuth;
constexpr size_t kHeader = 3 * sizeof(int32_t), kBytes = kHeader + 3 * kBins * sizeof(double);

// Mean of a value and its mirror image, of those that are above the horizon; negative if none is.
double Folded(double a, double b) {
  if (a < 0) return b;
  return b < 0 ? a : 0.5 * (a + b);
}

MeasuredBrdf::Axes BinCentres() {
  constexpr double kDegree = std::numbers::pi / 180;
  MeasuredBrdf::Axes axes;
  for (int i = 0; i < kHalf; ++i) axes[0].push_back(float((i + 0.5) * (i + 0.5) / kHalf * kDegree));
  for (int i = 0; i < kDifference; ++i) axes[1].push_back(float((i + 0.5) * 90 / kDifference * kDegree));
  for (int i = 0; i < kFolded; ++i) axes[2].push_back(float((i + 0.5) * 90 / kFolded * kDegree));
  return axes;
}

}  // namespace

Measured ReadMerlFile(const std::string& path) {
  // A little more than fits, so that the size found is told for files that are nearly right.
  const std::vector<uint8_t> bytes = ReadBytes(path, 2 * kBytes);
  std::ostringstream what;
  what << path << ": ";
  if (bytes.size() < kHeader) {
    what << "ends after " << bytes.size() << " bytes, within the header of a MERL file, expected " << kBytes;
    throw InputError(what.str());
  }
  int32_t size[3];
  std::memcpy(size, bytes.data(), sizeof size);
  if (size[0] != kHalf || size[1] != kDifference || size[2] != kAzimuth) {
    what << "its dimensions are " << size[0] << " x " << size[1] << " x " << size[2]
         << ", expected MERL's 90 x 90 x 180";
    throw InputError(what.str());
  }
  if (bytes.size() != kBytes) {
    what << "holds " << bytes.size() << " bytes, expected " << kBytes
         << (bytes.size() < kBytes ? ": it is truncated" : "");
    throw InputError(what.str());
  }

  const auto stored = [&](int channel, size_t bin) {
    double value;
    std::memcpy(&value, &bytes[kHeader + (channel * kBins + bin) * sizeof value], sizeof value);
    // Also not a number.
    if (!(value * kMerlScale[channel] <= MeasuredBrdf::kMostValue && std::isfinite(value))) {
      what << "value " << bin << " of channel " << channel << " is " << value
           << ", expected a number that stands for at most 1e9 sr^-1";
      throw InputError(what.str());
    }
    return value;
  };
  std::vector<float> values(size_t(kHalf) * kDifference * kFolded * 3);
  const size_t column = size_t(kFolded) * 3, row = kDifference * column;
  for (int channel = 0; channel < 3; ++channel) {
    for (int i = 0; i < kHalf; ++i) {
      for (int j = 0; j < kDifference; ++j) {
        for (int k = 0; k < kFolded; ++k) {
          const size_t first = (size_t(i) * kDifference + j) * kAzimuth;
          const double value = Folded(stored(channel, first + k), stored(channel, first + kAzimuth - 1 - k));
          const size_t at = i * row + j * column + size_t(k) * 3 + channel;
          if (value >= 0) {
            values[at] = float(value * kMerlScale[channel]);
          } else if (i > 0 || j > 0) {
            values[at] = values[i > 0 ? at - row : at - column];
          } else {
            what << "channel " << channel << " is " << value
                 << " at its first bin, where both directions lie along the normal, expected at least 0";
            throw InputError(what.str());
          }
        }
      }
    }
  }
  return {std::make_shared<const MeasuredBrdf>(std::filesystem::path(path).filename().string(),
                                               MeasuredBrdf::Coordinates::kHalfDifference, BinCentres(),
                                               std::move(values))};
}

}  // namespace lobe
