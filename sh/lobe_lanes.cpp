#include "sh/lobe_lanes.h"

#include <stdexcept>
#include <string>

#include "sh/hemisphere_basis.h"
#include "sh/simd.h"

namespace lobe {
namespace {

// The coefficients of +m and -m lie m apart; from l to l + 2 both move on by 2 l + 4.
LOBE_SIMD_CLONES void AddLobe(const float* recurrence, int l_table, const float* coefficients, int l_max,
                              const float* px, const float* py, const float* pz, float* out) {
  const int count = CoefficientCount(l_max);
  const FloatLanes x = AsLanes(px), y = AsLanes(py), z2 = AsLanes(pz) * AsLanes(pz);
  FloatLanes red = AsLanes(out), green = AsLanes(out + kLanes), blue = AsLanes(out + 2 * kLanes);
  FloatLanes cosine = FloatLanes{} + 1.0f, sine = {};  // (x + iy)^m
  for (int m = 0; m <= l_max; ++m) {
    const float* r = recurrence;
    FloatLanes q = FloatLanes{} + r[0], before = {};
    FloatLanes red_cos = {}, red_sin = {}, green_cos = {}, green_sin = {}, blue_cos = {}, blue_sin = {};
    const float* c = coefficients + CoefficientIndex(m, m);
    if (m == 0) {
      for (int l = m;;) {
        red_cos += q * c[0];
        green_cos += q * c[count];
        blue_cos += q * c[2 * count];
        if ((l += 2) > l_max) break;
        c += 2 * l;
        r += 3;
        const FloatLanes next = (r[0] * z2 + r[1]) * q - r[2] * before;
        before = q;
        q = next;
      }
    } else {
      for (int l = m;;) {
        red_cos += q * c[0];
        red_sin += q * c[-m];
        green_cos += q * c[count];
        green_sin += q * c[count - m];
        blue_cos += q * c[2 * count];
        blue_sin += q * c[2 * count - m];
        if ((l += 2) > l_max) break;
        c += 2 * l;
        r += 3;
        const FloatLanes next = (r[0] * z2 + r[1]) * q - r[2] * before;
        before = q;
        q = next;
      }
    }
    red += red_cos * cosine + red_sin * sine;
    green += green_cos * cosine + green_sin * sine;
    blue += blue_cos * cosine + blue_sin * sine;
    const FloatLanes turned = cosine * x - sine * y;
    sine = cosine * y + sine * x;
    cosine = turned;
    recurrence += 3 * ((l_table - m) / 2 + 1);
  }
  AsLanes(out) = red;
  AsLanes(out + kLanes) = green;
  AsLanes(out + 2 * kLanes) = blue;
}

}  // namespace

LobeLanes::LobeLanes(int l_max) : l_max_(l_max) {
  if (l_max < 0 || l_max > HemisphereBasis<float>::kMaxDegree) {
    throw std::invalid_argument("LobeLanes: l_max " + std::to_string(l_max) + " is not in 0.." +
                                std::to_string(HemisphereBasis<float>::kMaxDegree));
  }
  const HemisphereBasis<float> basis(l_max);
  for (int m = 0; m <= l_max; ++m) {
    for (int l = m; l <= l_max; l += 2) {
      const auto r = basis.Recurrence(l, m);
      recurrence_.insert(recurrence_.end(), r.begin(), r.end());
    }
  }
}

void LobeLanes::Add(const float* coefficients, int l, const float* x, const float* y, const float* z,
                    float* out) const {
  AddLobe(recurrence_.data(), l_max_, coefficients, l, x, y, z, out);
}

}  // namespace lobe
