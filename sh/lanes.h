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

/// Bit i is set where lane i of a comparison is true. Two instructions where a loop would be fifty.
LOBE_INLINE uint32_t LaneBits(const IntLanes& condition) {
#if defined(__SSE2__)
  typedef signed char Bytes __attribute__((vector_size(kLanes)));
  return uint32_t(_mm_movemask_epi8((__m128i) __builtin_convertvector(condition, Bytes)));
#else
  uint32_t bits = 0;
  for (int i = 0; i < kLanes; ++i) bits |= uint32_t(condition[i] & 1) << i;
  return bits;
#endif
}

/// The opposite: all ones where bit i is set.
LOBE_INLINE void LanesOfBits(uint32_t bits, IntLanes* lanes) {
  const UintLanes bit = {1,      1 << 1, 1 << 2,  1 << 3,  1 << 4,  1 << 5,  1 << 6,  1 << 7,
                         1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13, 1 << 14, 1 << 15};
  *lanes = (bit & bits) != 0;
}

}  // namespace lobe
