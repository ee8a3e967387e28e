#include "sh/hemisphere_basis.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <string>

#include "sh/simd.h"

namespace lobe {
namespace {

// Recurrence coefficients lie by step j and order m, l = m + 2 j, so that a step runs over all m at once.
constexpr int StepOffset(int l_max, int j) { return j * (l_max + 2 - j); }

// z P_{l-1} = alpha_l P_l + alpha_{l-1} P_{l-2} for normalised P_l^m.
double Alpha(int l, int m) {
  return l <= m ? 0.0 : std::sqrt((double(l) * l - double(m) * m) / (4.0 * l * l - 1.0));
}

template <typename Real>
inline __attribute__((always_inline)) void EvaluateOne(int l_max, const Real* a, const Real* b, const Real* c,
                                                       const Real* start, Real x, Real y, Real z2,
                                                       Real* out) {
  constexpr int kSize = HemisphereBasis<Real>::kMaxDegree + 1;
  Real cos_m[kSize], sin_m[kSize], q[kSize], q_before[kSize];
  cos_m[0] = 1;
  sin_m[0] = 0;
  for (int m = 1; m <= l_max; ++m) {
    cos_m[m] = x * cos_m[m - 1] - y * sin_m[m - 1];
    sin_m[m] = x * sin_m[m - 1] + y * cos_m[m - 1];
  }
  for (int m = 0; m <= l_max; ++m) {
    q[m] = start[m];
    q_before[m] = 0;
  }
  for (int j = 0;; ++j) {
    const int orders = l_max - 2 * j + 1;  // m = 0 .. l_max - 2 j
    if (j > 0) {
      const int at = StepOffset(l_max, j);
      for (int m = 0; m < orders; ++m) {
        const Real next = (a[at + m] * z2 + b[at + m]) * q[m] - c[at + m] * q_before[m];
        q_before[m] = q[m];
        q[m] = next;
      }
    }
    for (int m = 0; m < orders; ++m) {
      const int l = m + 2 * j;
      Real* band = out + l * (l + 1) / 2 + j;  // order -m; order +m is m further on
      band[0] = q[m] * sin_m[m];
      band[m] = q[m] * cos_m[m];  // m = 0 overwrites the zero above
    }
    if (orders <= 2) break;
  }
}

LOBE_SIMD_CLONES void EvaluateFloat(int l_max, const float* a, const float* b, const float* c,
                                    const float* start, float x, float y, float z2, float* out) {
  EvaluateOne<float>(l_max, a, b, c, start, x, y, z2, out);
}
LOBE_SIMD_CLONES void EvaluateDouble(int l_max, const double* a, const double* b, const double* c,
                                     const double* start, double x, double y, double z2, double* out) {
  EvaluateOne<double>(l_max, a, b, c, start, x, y, z2, out);
}

constexpr int kBatch = 16;  // directions side by side

// GCC's and Clang's vectors, cut to what the processor has; loads and stores need no alignment.
template <typename Real>
struct Wide {
  typedef Real Lanes __attribute__((vector_size(sizeof(Real) * kBatch)));
  typedef Real LooseLanes
      __attribute__((vector_size(sizeof(Real) * kBatch), aligned(sizeof(Real)), may_alias));
};

// Lanes are directions: the recurrence runs on kBatch of them side by side. Orders are independent of each
// other, so a processor that looks ahead has several chains under way; what limits is arithmetic and stores.
// `count`: how many of them are written.
template <typename Real>
inline __attribute__((always_inline)) void EvaluateLanes(int l_max, const Real* a, const Real* b,
                                                         const Real* c, const Real* start, const Real* px,
                                                         const Real* py, const Real* pz, int count,
                                                         size_t stride, Real* out) {
  using Lanes = typename Wide<Real>::Lanes;
  using LooseLanes = typename Wide<Real>::LooseLanes;
  const auto load = [](const Real* from) -> const LooseLanes& {
    return *reinterpret_cast<const LooseLanes*>(from);
  };
  const auto store = [count](Real* to, const Lanes& v) {
    if (count == kBatch) {
      *reinterpret_cast<LooseLanes*>(to) = v;
    } else {
      for (int i = 0; i < count; ++i) to[i] = v[i];
    }
  };
  const Lanes x = load(px), y = load(py), z2 = load(pz) * load(pz);
  {
    Lanes q = Lanes{} + start[0], before = {};
    for (int j = 0;;) {  // m = 0, l = 2 j, in place j (2 j + 1) + j
      store(out + size_t(2 * j * (j + 1)) * stride, q);
      if (2 * ++j > l_max) break;
      const int at = StepOffset(l_max, j);
      const Lanes next = (a[at] * z2 + b[at]) * q - c[at] * before;
      before = q;
      q = next;
    }
  }
  Lanes cosine = x, sine = y;  // (x + iy)^m
  for (int m = 1; m <= l_max; ++m) {
    Lanes q = Lanes{} + start[m], before = {};
    for (int j = 0;;) {
      const int l = m + 2 * j;
      Real* minus = out + size_t(CoefficientIndex(l, -m)) * stride;
      store(minus, q * sine);
      store(minus + size_t(m) * stride, q * cosine);
      ++j;
      if (l + 2 > l_max) break;
      const int at = StepOffset(l_max, j) + m;
      const Lanes next = (a[at] * z2 + b[at]) * q - c[at] * before;
      before = q;
      q = next;
    }
    const Lanes turned = cosine * x - sine * y;
    sine = cosine * y + sine * x;
    cosine = turned;
  }
}

LOBE_SIMD_CLONES void LanesFloat(int l_max, const float* a, const float* b, const float* c,
                                 const float* start, const float* x, const float* y, const float* z,
                                 int count, size_t stride, float* out) {
  if (count == kBatch) {
    EvaluateLanes<float>(l_max, a, b, c, start, x, y, z, kBatch, stride, out);
  } else {
    EvaluateLanes<float>(l_max, a, b, c, start, x, y, z, count, stride, out);
  }
}
LOBE_SIMD_CLONES void LanesDouble(int l_max, const double* a, const double* b, const double* c,
                                  const double* start, const double* x, const double* y, const double* z,
                                  int count, size_t stride, double* out) {
  if (count == kBatch) {
    EvaluateLanes<double>(l_max, a, b, c, start, x, y, z, kBatch, stride, out);
  } else {
    EvaluateLanes<double>(l_max, a, b, c, start, x, y, z, count, stride, out);
  }
}

}  // namespace

template <typename Real>
HemisphereBasis<Real>::HemisphereBasis(int l_max) : l_max_(l_max) {
  if (l_max < 0 || l_max > kMaxDegree) {
    throw std::invalid_argument("HemisphereBasis: l_max " + std::to_string(l_max) + " is not in 0.." +
                                std::to_string(kMaxDegree));
  }
  const int steps = l_max / 2 + 1;
  const int size = StepOffset(l_max, steps) + 1;
  a_.assign(size, 0);
  b_.assign(size, 0);
  c_.assign(size, 0);
  start_.resize(l_max + 1);

  // H_mm = sqrt(2) Y_mm, with sqrt(2) once more for m > 0 in the real Y.
  double sectoral = std::sqrt(2.0 / (4.0 * std::numbers::pi));
  for (int m = 0; m <= l_max; ++m) {
    if (m > 0) sectoral *= std::sqrt((2.0 * m + 1.0) / (2.0 * m));
    start_[m] = Real(m > 0 ? sectoral * std::numbers::sqrt2 : sectoral);
    for (int j = 1; m + 2 * j <= l_max; ++j) {
      const int l = m + 2 * j;
      const double a = 1.0 / (Alpha(l - 1, m) * Alpha(l, m));
      const int at = StepOffset(l_max, j) + m;
      a_[at] = Real(a);
      b_[at] = Real(-a * (Alpha(l - 1, m) * Alpha(l - 1, m) + Alpha(l - 2, m) * Alpha(l - 2, m)));
      c_[at] = Real(a * Alpha(l - 2, m) * Alpha(l - 3, m));
    }
  }
}

template <typename Real>
std::array<Real, 3> HemisphereBasis<Real>::Recurrence(int l, int m) const {
  if (l == m) return {start_[m], 0, 0};
  const int at = StepOffset(l_max_, (l - m) / 2) + m;
  return {a_[at], b_[at], c_[at]};
}

template <typename Real>
void HemisphereBasis<Real>::Evaluate(Real x, Real y, Real z, Real* out) const {
  if constexpr (sizeof(Real) == 4) {
    EvaluateFloat(l_max_, a_.data(), b_.data(), c_.data(), start_.data(), x, y, z * z, out);
  } else {
    EvaluateDouble(l_max_, a_.data(), b_.data(), c_.data(), start_.data(), x, y, z * z, out);
  }
}

template <typename Real>
void HemisphereBasis<Real>::EvaluateBatch(const Real* x, const Real* y, const Real* z, int count,
                                          Real* out) const {
  const auto evaluate = [&](const Real* px, const Real* py, const Real* pz, int lanes, Real* to) {
    if constexpr (sizeof(Real) == 4) {
      LanesFloat(l_max_, a_.data(), b_.data(), c_.data(), start_.data(), px, py, pz, lanes, size_t(count),
                 to);
    } else {
      LanesDouble(l_max_, a_.data(), b_.data(), c_.data(), start_.data(), px, py, pz, lanes, size_t(count),
                  to);
    }
  };
  if (count < kBatch) {
    Real padded[3][kBatch] = {};
    for (int i = 0; i < count; ++i) {
      padded[0][i] = x[i];
      padded[1][i] = y[i];
      padded[2][i] = z[i];
    }
    evaluate(padded[0], padded[1], padded[2], count, out);
    return;
  }
  for (int begin = 0; begin < count; begin += kBatch) {
    // What is left at the end is done as the last sixteen; some are written twice, the same both times.
    const int at = std::min(begin, count - kBatch);
    evaluate(x + at, y + at, z + at, kBatch, out + at);
  }
}

template class HemisphereBasis<float>;
template class HemisphereBasis<double>;

}  // namespace lobe
