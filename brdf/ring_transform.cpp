#include "brdf/ring_transform.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <stdexcept>
#include <string>

#include "sh/simd.h"

namespace lobe {
namespace {

constexpr int kBlock = 16;  // orders summed side by side
using Orders [[gnu::vector_size(kBlock * sizeof(float))]] = float;

// The parts of three planes that are even and odd under j <-> count - j, rows 0..count / 2: six planes.
LOBE_SIMD_CLONES void Fold(const float* f, int count, float* out) {
  const int rows = count / 2 + 1;
  for (int c = 0; c < 3; ++c, f += count) {
    float* even = out + c * rows;
    float* odd = even + 3 * rows;
    for (int j = 1; j < rows; ++j) {
      even[j] = f[j] + f[count - j];
      odd[j] = f[j] - f[count - j];
    }
    even[0] = f[0];
    if (count % 2 == 0) even[rows - 1] = f[rows - 1];  // its own mirror image
    odd[0] = 0;
  }
}

// sums[0..2]: even parts against cosines, [3..5]: odd parts against sines. Vectors by name stay in
// registers; left to itself the compiler vectorises over j, three times slower.
LOBE_SIMD_CLONES void SumBlock(const float* parts, const float* table, int rows, float* sums) {
  Orders a0{}, a1{}, a2{}, b0{}, b1{}, b2{};
  const float* even = parts;
  const float* odd = parts + 3 * rows;
  for (int j = 0; j < rows; ++j, table += 2 * kBlock) {
    Orders cosine, sine;
    std::memcpy(&cosine, table, sizeof cosine);
    std::memcpy(&sine, table + kBlock, sizeof sine);
    a0 += even[j] * cosine;
    a1 += even[rows + j] * cosine;
    a2 += even[2 * rows + j] * cosine;
    b0 += odd[j] * sine;
    b1 += odd[rows + j] * sine;
    b2 += odd[2 * rows + j] * sine;
  }
  const Orders all[6] = {a0, a1, a2, b0, b1, b2};
  std::memcpy(sums, all, sizeof all);
}

}  // namespace

RingTransform::RingTransform(int count, int l_max)
    : count_(count), l_max_(l_max), blocks_(l_max / kBlock + 1) {
  if (count < 1 || l_max < 0) {
    throw std::invalid_argument("RingTransform: count " + std::to_string(count) + " and l_max " +
                                std::to_string(l_max) + " given, at least 1 and 0 expected");
  }
  const int rows = count / 2 + 1;
  table_.resize(size_t(blocks_) * rows * 2 * kBlock);
  float* out = table_.data();
  for (int block = 0; block < blocks_; ++block) {
    for (int j = 0; j < rows; ++j, out += 2 * kBlock) {
      for (int i = 0; i < kBlock; ++i) {
        const int turn = int((long(block) * kBlock + i) * j % count);
        const double angle = 2.0 * std::numbers::pi * turn / count;
        out[i] = float(std::cos(angle));
        out[kBlock + i] = float(std::sin(angle));
      }
    }
  }
}

void RingTransform::Apply(const float* f, float* out, std::vector<float>& scratch) const {
  const int rows = count_ / 2 + 1;
  scratch.resize(size_t(rows) * 6);
  Fold(f, count_, scratch.data());
  const int orders = l_max_ + 1;
  for (int block = 0; block < blocks_; ++block) {
    float sums[6 * kBlock];
    SumBlock(scratch.data(), table_.data() + size_t(block) * rows * 2 * kBlock, rows, sums);
    const int first = block * kBlock, count = std::min(kBlock, orders - first);
    for (int c = 0; c < 6; ++c) {
      std::copy_n(sums + c * kBlock, count, out + (c % 3 * 2 + c / 3) * orders + first);
    }
  }
}

}  // namespace lobe
