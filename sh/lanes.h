#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

/// Sixteen numbers side by side: GCC's and Clang's vectors, cut to what the processor has. Meant for
/// functions marked LOBE_SIMD_CLONES (sh/simd.h); arrays of lanes are plain arrays everywhere else.
namespace lobe {

inline constexpr int kLanes = 16;

typedef float FloatLanes __attribute__((vector_size(4 * kLanes)));
typedef int32_t IntLanes __attribute__((vector_size(4 * kLanes)));
typedef uint32_t UintLanes __attribute__((vector_size(4 * kLanes)));

// Helpers that pass lanes by value are always inlined, so how vectors are passed does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"
#define LOBE_INLINE inline __attribute__((always_inline))

/// Arrays must be aligned to 64 bytes.
LOBE_INLINE const FloatLanes& AsLanes(const float* from) {
  return *reinterpret_cast<const FloatLanes*>(from);
}
LOBE_INLINE FloatLanes& AsLanes(float* at) { return *reinterpret_cast<FloatLanes*>(at); }
LOBE_INLINE const UintLanes& AsLanes(const uint32_t* from) {
  return *reinterpret_cast<const UintLanes*>(from);
}
LOBE_INLINE UintLanes& AsLanes(uint32_t* at) { return *reinterpret_cast<UintLanes*>(at); }

/// Sixteen floats wherever they lie.
typedef float LooseLanes __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
LOBE_INLINE const LooseLanes& Loose(const float* from) { return *reinterpret_cast<const LooseLanes*>(from); }
LOBE_INLINE LooseLanes& Loose(float* at) { return *reinterpret_cast<LooseLanes*>(at); }

/// Real and imaginary parts of (x + iy)^m, sixteen orders m side by side: sin^m theta times cos m phi and
/// sin m phi. Begins with m = 0..15: of m = 4 a + b, a power of the fourth power times one of the first, so
/// that few products wait for each other.
struct AzimuthLanes {
  FloatLanes cosine, sine;
  float x16, y16;

  LOBE_INLINE AzimuthLanes(float x, float y) {
    const float x2 = x * x - y * y, y2 = 2 * x * y, x3 = x2 * x - y2 * y, y3 = x2 * y + y2 * x;
    const float x4 = x2 * x2 - y2 * y2, y4 = 2 * x2 * y2, x8 = x4 * x4 - y4 * y4, y8 = 2 * x4 * y4;
    const float x12 = x8 * x4 - y8 * y4, y12 = x8 * y4 + y8 * x4;
    const FloatLanes small_re = {1, x, x2, x3, 1, x, x2, x3, 1, x, x2, x3, 1, x, x2, x3};
    const FloatLanes small_im = {0, y, y2, y3, 0, y, y2, y3, 0, y, y2, y3, 0, y, y2, y3};
    const FloatLanes large_re = {1, 1, 1, 1, x4, x4, x4, x4, x8, x8, x8, x8, x12, x12, x12, x12};
    const FloatLanes large_im = {0, 0, 0, 0, y4, y4, y4, y4, y8, y8, y8, y8, y12, y12, y12, y12};
    cosine = small_re * large_re - small_im * large_im;
    sine = small_re * large_im + small_im * large_re;
    x16 = x8 * x8 - y8 * y8;
    y16 = 2 * x8 * y8;
  }
  /// To the next sixteen.
  LOBE_INLINE void Advance() {
    const FloatLanes turned = cosine * x16 - sine * y16;
    sine = cosine * y16 + sine * x16;
    cosine = turned;
  }
};

// GCC 12 takes comparisons of lanes apart, one by one, where the file's own target lacks such wide vectors,
// also in clones for processors that have them. So conditions are sign bits here, found by arithmetic.

/// All ones where negative.
LOBE_INLINE IntLanes Negative(const FloatLanes& x) { return (IntLanes)x >> 31; }
/// All ones where different.
LOBE_INLINE IntLanes Different(const UintLanes& a, const UintLanes& b) {
  const UintLanes d = a ^ b;
  return (IntLanes)(d | -d) >> 31;
}
/// `a` where all ones, `b` where zero.
LOBE_INLINE FloatLanes Select(const IntLanes& condition, const FloatLanes& a, const FloatLanes& b) {
  return (FloatLanes)((condition & (IntLanes)a) | (~condition & (IntLanes)b));
}

/// Bit i is the sign bit of lane i.
LOBE_INLINE uint32_t SignBits(const IntLanes& lanes) {
#if defined(__SSE2__)
  __m128i q[4];
  __builtin_memcpy(q, &lanes, sizeof q);
  return uint32_t(
      _mm_movemask_epi8(_mm_packs_epi16(_mm_packs_epi32(q[0], q[1]), _mm_packs_epi32(q[2], q[3]))));
#else
  uint32_t bits = 0;
  for (int i = 0; i < kLanes; ++i) bits |= uint32_t(lanes[i] < 0) << i;
  return bits;
#endif
}

/// The opposite: all ones where bit i is set.
LOBE_INLINE IntLanes LanesOfBits(uint32_t bits) {
  const UintLanes to_sign = {31, 30, 29, 28, 27, 26, 25, 24, 23, 22, 21, 20, 19, 18, 17, 16};
  return (IntLanes)((UintLanes{} + bits) << to_sign) >> 31;
}

}  // namespace lobe
