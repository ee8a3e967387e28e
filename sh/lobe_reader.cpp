#include "sh/lobe_reader.h"

#include <stdexcept>
#include <string>

#include "sh/hemisphere_basis.h"
#include "sh/simd.h"

namespace lobe {
namespace {

constexpr int kLanes = 16;  // orders side by side
constexpr int kMaxDegree = HemisphereBasis<float>::kMaxDegree;

// Steps j of the orders from `m0` on, l = m + 2 j <= l_max.
constexpr int Steps(int l_max, int m0) { return (l_max - m0) / 2 + 1; }

// GCC's and Clang's vectors, cut to what the processor has; loads need no alignment.
typedef float Lanes __attribute__((vector_size(4 * kLanes)));
typedef float LooseLanes __attribute__((vector_size(4 * kLanes), aligned(4)));

LOBE_SIMD_CLONES void ReadPacked(int l_max, const float* recurrence, const float* packed, float x, float y,
                                 float z2, float* out) {
  // (x + iy)^m = sin^m theta (cos m phi + i sin m phi) for m = 0..15: of m = 4 a + b, a power of the fourth
  // power times one of the first, so that few products wait for each other.
  const float x2 = x * x - y * y, y2 = 2 * x * y, x3 = x2 * x - y2 * y, y3 = x2 * y + y2 * x;
  const float x4 = x2 * x2 - y2 * y2, y4 = 2 * x2 * y2, x8 = x4 * x4 - y4 * y4, y8 = 2 * x4 * y4;
  const float x12 = x8 * x4 - y8 * y4, y12 = x8 * y4 + y8 * x4;
  const Lanes small_re = {1, x, x2, x3, 1, x, x2, x3, 1, x, x2, x3, 1, x, x2, x3};
  const Lanes small_im = {0, y, y2, y3, 0, y, y2, y3, 0, y, y2, y3, 0, y, y2, y3};
  const Lanes large_re = {1, 1, 1, 1, x4, x4, x4, x4, x8, x8, x8, x8, x12, x12, x12, x12};
  const Lanes large_im = {0, 0, 0, 0, y4, y4, y4, y4, y8, y8, y8, y8, y12, y12, y12, y12};
  Lanes cosine = small_re * large_re - small_im * large_im, sine = small_re * large_im + small_im * large_re;
  const float x16 = x8 * x8 - y8 * y8, y16 = 2 * x8 * y8;

  const auto load = [](const float* from) -> const LooseLanes& {
    return *reinterpret_cast<const LooseLanes*>(from);
  };
  Lanes red = {}, green = {}, blue = {};
  for (int m0 = 0; m0 <= l_max; m0 += kLanes) {
    Lanes q = load(recurrence), before = {};
    Lanes red_cos = q * load(packed), red_sin = q * load(packed + kLanes);
    Lanes green_cos = q * load(packed + 2 * kLanes), green_sin = q * load(packed + 3 * kLanes);
    Lanes blue_cos = q * load(packed + 4 * kLanes), blue_sin = q * load(packed + 5 * kLanes);
    for (int j = Steps(l_max, m0); --j > 0;) {
      recurrence += 3 * kLanes;
      packed += 6 * kLanes;
      const Lanes next =
          (load(recurrence) * z2 + load(recurrence + kLanes)) * q - load(recurrence + 2 * kLanes) * before;
      before = q;
      q = next;
      red_cos += q * load(packed);
      red_sin += q * load(packed + kLanes);
      green_cos += q * load(packed + 2 * kLanes);
      green_sin += q * load(packed + 3 * kLanes);
      blue_cos += q * load(packed + 4 * kLanes);
      blue_sin += q * load(packed + 5 * kLanes);
    }
    recurrence += 3 * kLanes;
    packed += 6 * kLanes;
    red += red_cos * cosine + red_sin * sine;
    green += green_cos * cosine + green_sin * sine;
    blue += blue_cos * cosine + blue_sin * sine;
    const Lanes turned = cosine * x16 - sine * y16;
    sine = cosine * y16 + sine * x16;
    cosine = turned;
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
