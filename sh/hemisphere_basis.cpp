#include "sh/hemisphere_basis.h"

#include <cmath>
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

// Lanes are directions: the recurrence runs on kLanes of them side by side.
template <typename Real>
inline __attribute__((always_inline)) void EvaluateLanes(int l_max, const Real* a, const Real* b,
                                                         const Real* c, const Real* start, const Real* x,
                                                         const Real* y, const Real* z, int count, int stride,
                                                         Real* out) {
  constexpr int kLanes = 16;
  Real cos_m[kLanes], sin_m[kLanes], z2[kLanes], q[kLanes], q_before[kLanes], px[kLanes], py[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const int at = i < count ? i : 0;
    px[i] = x[at];
    py[i] = y[at];
    z2[i] = z[at] * z[at];
    cos_m[i] = 1;
    sin_m[i] = 0;
  }
  for (int m = 0; m <= l_max; ++m) {
    if (m > 0) {
      for (int i = 0; i < kLanes; ++i) {
        const Real turned = px[i] * cos_m[i] - py[i] * sin_m[i];
        sin_m[i] = px[i] * sin_m[i] + py[i] * cos_m[i];
        cos_m[i] = turned;
      }
    }
    for (int i = 0; i < kLanes; ++i) {
      q[i] = start[m];
      q_before[i] = 0;
    }
    for (int j = 0; m + 2 * j <= l_max; ++j) {
      const int l = m + 2 * j;
      if (j > 0) {
        const int at = StepOffset(l_max, j) + m;
        for (int i = 0; i < kLanes; ++i) {
          const Real next = (a[at] * z2[i] + b[at]) * q[i] - c[at] * q_before[i];
          q_before[i] = q[i];
          q[i] = next;
        }
      }
      Real* minus = out + size_t(CoefficientIndex(l, -m)) * stride;
      Real* plus = out + size_t(CoefficientIndex(l, m)) * stride;
      if (m > 0) {
        for (int i = 0; i < count; ++i) minus[i] = q[i] * sin_m[i];
      }
      for (int i = 0; i < count; ++i) plus[i] = q[i] * cos_m[i];
    }
  }
}

LOBE_SIMD_CLONES void LanesFloat(int l_max, const float* a, const float* b, const float* c,
                                 const float* start, const float* x, const float* y, const float* z,
                                 int count, int stride, float* out) {
  EvaluateLanes<float>(l_max, a, b, c, start, x, y, z, count, stride, out);
}
LOBE_SIMD_CLONES void LanesDouble(int l_max, const double* a, const double* b, const double* c,
                                  const double* start, const double* x, const double* y, const double* z,
                                  int count, int stride, double* out) {
  EvaluateLanes<double>(l_max, a, b, c, start, x, y, z, count, stride, out);
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
  for (int begin = 0; begin < count; begin += 16) {
    const int lanes = std::min(16, count - begin);
    if constexpr (sizeof(Real) == 4) {
      LanesFloat(l_max_, a_.data(), b_.data(), c_.data(), start_.data(), x + begin, y + begin, z + begin,
                 lanes, count, out + begin);
    } else {
      LanesDouble(l_max_, a_.data(), b_.data(), c_.data(), start_.data(), x + begin, y + begin, z + begin,
                  lanes, count, out + begin);
    }
  }
}

template class HemisphereBasis<float>;
template class HemisphereBasis<double>;

}  // namespace lobe
