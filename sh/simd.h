#pragma once

/// Functions marked LOBE_SIMD_CLONES are compiled for several x86-64 levels; the loader picks the
/// best the processor has, so one portable binary is fast everywhere. On other processors, other
/// compilers and under sanitizers the mark means nothing.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(LOBE_NO_SIMD_CLONES)
#define LOBE_SIMD_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define LOBE_SIMD_CLONES
#endif
