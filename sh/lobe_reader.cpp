#include "sh/lobe_reader.h"

#include <stdexcept>
#include <string>

#include "sh/hemisphere_basis.h"
#include "sh/lanes.h"
#include "sh/simd.h"

namespace lobe {
namespace {

constexpr int kMaxDegree = HemisphereBasis<float>::kMaxDegree;

// Steps j of the orders from `m0` on, l = m + 2 j <= l_max.
constexpr int Steps(int l_max, int m0) { return (l_max - m0) / 2 + 1; }

// Orders side by side.
LOBE_SIMD_CLONES void ReadPacked(int l_max, const float* recurrence, const float* packed, float x, float y,
                                 float z2, float* out) {
  AzimuthLanes powers(x, y);
  FloatLanes red = {}, green = {}, blue = {};
  for (int m0 = 0; m0 <= l_max; m0 += kLanes) {
    FloatLanes q = Loose(recurrence), before = {};
    FloatLanes red_cos = q * Loose(packed), red_sin = q * Loose(packed + kLanes);
    FloatLanes green_cos = q * Loose(packed + 2 * kLanes), green_sin = q * Loose(packed + 3 * kLanes);
    FloatLanes blue_cos = q * Loose(packed + 4 * kLanes), blue_sin = q * Loose(packed + 5 * kLanes);
    for (int j = Steps(l_max, m0); --j > 0;) {
      recurrence += 3 * kLanes;
      packed += 6 * kLanes;
      const FloatLanes next =
          (Loose(recurrence) * z2 + Loose(recurrence + kLanes)) * q - Loose(recurrence + 2 * kLanes) * before;
      before = q;
      q = next;
      red_cos += q * Loose(packed);
      red_sin += q * Loose(packed + kLanes);
      green_cos += q * Loose(packed + 2 * kLanes);
      green_sin += q * Loose(packed + 3 * kLanes);
      blue_cos += q * Loose(packed + 4 * kLanes);
      blue_sin += q * Loose(packed + 5 * kLanes);
    }
    recurrence += 3 * kLanes;
    packed += 6 * kLanes;
    red += red_cos * powers.cosine + red_sin * powers.sine;
    green += green_cos * powers.cosine + green_sin * powers.sine;
    blue += blue_cos * powers.cosine + blue_sin * powers.sine;
    powers.Advance();
  }
  float sum[3] = {0, 0, 0};
  for (int i = 0; i < kLanes; ++i) {
    sum[0] += red[i];
    sum[1] += green[i];
    sum[2] += blue[i];
  }
  for (int c = 0; c < 3; ++c) out[c] = sum[c];
}

}  // namespace

LobeReader::LobeReader(int l_max) : l_max_(l_max) {
  if (l_max < 0 || l_max > kMaxDegree) {
    throw std::invalid_argument("LobeReader: l_max " + std::to_string(l_max) + " is not in 0.." +
                                std::to_string(kMaxDegree));
  }
  const HemisphereBasis<float> basis(l_max);
  for (int m0 = 0; m0 <= l_max; m0 += kLanes) {
    for (int j = 0; j < Steps(l_max, m0); ++j) {
      const size_t at = recurrence_.size();
      recurrence_.resize(at + 3 * kLanes, 0.0f);
      for (int i = 0; i < kLanes && m0 + i + 2 * j <= l_max; ++i) {
        const auto r = basis.Recurrence(m0 + i + 2 * j, m0 + i);
        for (int k = 0; k < 3; ++k) recurrence_[at + k * kLanes + i] = r[k];
      }
      packed_size_ += 6 * kLanes;
    }
  }
}

void LobeReader::Pack(const float* coefficients, int l_cap, float* packed) const {
  const int count = CoefficientCount(l_cap);
  for (int m0 = 0; m0 <= l_max_; m0 += kLanes) {
    for (int j = 0; j < Steps(l_max_, m0); ++j, packed += 6 * kLanes) {
      for (int i = 0; i < kLanes && m0 + i + 2 * j <= l_cap; ++i) {
        const int m = m0 + i, l = m + 2 * j;
        for (int c = 0; c < 3; ++c) {
          packed[2 * c * kLanes + i] += coefficients[c * count + CoefficientIndex(l, m)];
          if (m > 0) packed[(2 * c + 1) * kLanes + i] += coefficients[c * count + CoefficientIndex(l, -m)];
        }
      }
    }
  }
}

std::array<float, 3> LobeReader::Read(const float* packed, float x, float y, float z) const {
  std::array<float, 3> out;
  ReadPacked(l_max_, recurrence_.data(), packed, x, y, z * z, out.data());
  return out;
}

}  // namespace lobe
