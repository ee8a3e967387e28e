#include "sh/zernike_sums.h"

#include <algorithm>
#include <stdexcept>

#include "sh/simd.h"
#include "sh/zernike.h"

namespace lobe {
namespace {

constexpr int kLanes = 8;

constexpr int Steps(int l_max, int m) { return (l_max - m) / 2 + 1; }

// kLanes points: x, rho^2 and values (by plane, then lane).
LOBE_SIMD_CLONES void AddLanes(int l_max, int planes, const double* a, const double* b, const double* c,
                               const double* x, const double* rho2, const double* values, double* sums) {
  // rho^m cos(m phi) = Re (x + iy)^m by w_{m+1} = 2 x w_m - rho^2 w_{m-1}.
  double wave[kLanes], wave_before[kLanes], p[kLanes], p_before[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    wave[i] = 1;
    wave_before[i] = 0;
  }
  for (int m = 0; m <= l_max; ++m) {
    for (int i = 0; i < kLanes; ++i) {
      p[i] = wave[i];
      p_before[i] = 0;
    }
    const int steps = Steps(l_max, m);
    for (int j = 0;; ++j, ++a, ++b, ++c) {
      for (int k = 0; k < planes; ++k, sums += kLanes) {
        for (int i = 0; i < kLanes; ++i) sums[i] += values[k * kLanes + i] * p[i];
      }
      if (j + 1 == steps) break;
      for (int i = 0; i < kLanes; ++i) {
        const double next = (*a * rho2[i] + *b) * p[i] - *c * p_before[i];
        p_before[i] = p[i];
        p[i] = next;
      }
    }
    ++a, ++b, ++c;                        // the last step of each order is not taken
    const double twice = m == 0 ? 1 : 2;  // w_1 = x
    for (int i = 0; i < kLanes; ++i) {
      const double next = twice * x[i] * wave[i] - rho2[i] * wave_before[i];
      wave_before[i] = wave[i];
      wave[i] = next;
    }
  }
}

}  // namespace

ZernikeSums::ZernikeSums(int l_max, int planes) : l_max_(l_max), planes_(planes) {
  if (l_max < 0 || planes < 1)
    throw std::invalid_argument("ZernikeSums: l_max >= 0 and planes >= 1 expected");
  for (int m = 0; m <= l_max; ++m) {
    for (int j = 0; j < Steps(l_max, m); ++j) {
      const ZernikeStep step(m, j);
      a_.push_back(2.0 * step.a);  // in rho^2 instead of 2 rho^2 - 1
      b_.push_back(step.b - step.a);
      c_.push_back(step.c);
    }
  }
  sums_.assign(a_.size() * planes * kLanes, 0.0);
}

void ZernikeSums::Add(const double* x, const double* y, const double* values, int count) {
  std::vector<double> lanes(size_t(planes_) * kLanes);
  for (int begin = 0; begin < count; begin += kLanes) {
    double px[kLanes], rho2[kLanes];
    for (int i = 0; i < kLanes; ++i) {
      const int at = begin + i;
      const bool inside = at < count;
      px[i] = inside ? x[at] : 0.0;
      rho2[i] = inside ? x[at] * x[at] + y[at] * y[at] : 0.0;
      for (int k = 0; k < planes_; ++k) lanes[k * kLanes + i] = inside ? values[size_t(k) * count + at] : 0.0;
    }
    AddLanes(l_max_, planes_, a_.data(), b_.data(), c_.data(), px, rho2, lanes.data(), sums_.data());
  }
}

double ZernikeSums::Sum(int n, int m, int plane) const {
  size_t row = (n - m) / 2;
  for (int before = 0; before < m; ++before) row += Steps(l_max_, before);
  const double* lane = sums_.data() + (row * planes_ + plane) * kLanes;
  double sum = 0;
  for (int i = 0; i < kLanes; ++i) sum += lane[i];
  return ZernikeScale(n, m) * sum;
}

}  // namespace lobe
