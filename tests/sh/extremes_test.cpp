// The mathematics of the sphere where numbers run out: docs/validation.md#extremes.

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "sh/hemisphere_basis.h"
#include "sh/lobe_lanes.h"
#include "sh/lobe_reader.h"
#include "tests/support/textbook_basis.h"

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace lobe {
namespace {

// Results that would be denormal become zero, and denormal operands count as zero: what Embree asks for. For
// as long as it lives.
class FlushToZero {
 public:
#ifdef __SSE2__
  FlushToZero() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040); }
  ~FlushToZero() { _mm_setcsr(before_); }
  static constexpr bool kThere = true;

 private:
  unsigned before_;
#else
  static constexpr bool kThere = false;
#endif
};

struct Direction {
  double x, y, z;
};

// From the pole to the horizon, the nearest to both that double tells apart, at a generic azimuth.
std::vector<Direction> ExtremeDirections() {
  std::vector<Direction> out = {{0, 0, 1}};
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (const double theta : {1e-300, 1e-38, 1e-16, 1e-8, 1e-4, 0.03, 0.4, 1.1, 1.5}) {
    out.push_back({std::sin(theta) * c, std::sin(theta) * s, std::cos(theta)});
  }
  for (const double z : {1e-7, 1e-16, 0.0})
    out.push_back({c * std::sqrt(1 - z * z), s * std::sqrt(1 - z * z), z});
  return out;
}

// Worst difference from the textbook's recurrence in long double, over the directions, relative to the
// largest value that a function of that degree takes, sqrt((2l+1)/pi).
template <typename Real>
double WorstAgainstTextbook(int l_max, bool batch) {
  const HemisphereBasis<Real> basis(l_max);
  const test::TextbookBasis<long double> textbook(l_max);
  const auto directions = ExtremeDirections();
  const size_t count = directions.size();
  std::vector<Real> x, y, z, values(count * basis.size());
  for (const Direction& w : directions) {
    x.push_back(Real(w.x));
    y.push_back(Real(w.y));
    z.push_back(Real(w.z));
  }
  if (batch) basis.EvaluateBatch(x.data(), y.data(), z.data(), int(count), values.data());
  std::vector<Real> one(basis.size());
  std::vector<long double> exact(basis.size());
  double worst = 0;
  for (size_t i = 0; i < count; ++i) {
    if (!batch) basis.Evaluate(x[i], y[i], z[i], one.data());
    textbook.Evaluate(x[i], y[i], z[i], exact.data());
    for (int l = 0; l <= l_max; ++l) {
      const double most = std::sqrt((2.0 * l + 1.0) / std::numbers::pi);
      for (int m = -l; m <= l; m += 2) {
        const int k = CoefficientIndex(l, m);
        const Real value = batch ? values[k * count + i] : one[k];
        const double off = std::abs(double(value - exact[k])) / most;
        if (!(off <= worst)) worst = off;  // NaN too
      }
    }
  }
  return worst;
}

// Two recurrences that share nothing but their start. Rounding grows with their length; measured: 5.2e-12 in
// double at degree 1000, 8.4e-6 in float at 64, flushed to zero or not.
TEST(ExtremesTest, DegreeAThousandInDoubleAgreesWithTheTextbookInLongDouble) {
  EXPECT_LT(WorstAgainstTextbook<double>(1000, false), 2e-11);
  EXPECT_LT(WorstAgainstTextbook<double>(1000, true), 2e-11);
}

TEST(ExtremesTest, FloatIsGoodUpToItsLimitOfDegree64) {
  EXPECT_LT(WorstAgainstTextbook<float>(HemisphereBasis<float>::kMaxDegree, false), 3e-5);
  EXPECT_LT(WorstAgainstTextbook<float>(HemisphereBasis<float>::kMaxDegree, true), 3e-5);
}

TEST(ExtremesTest, FlushedToZeroTheBasisIsAsGood) {
  if (!FlushToZero::kThere) GTEST_SKIP() << "this processor has no such mode that we know how to set";
  double single, batch, exact, exact_batch;
  {
    const FlushToZero flush;
    volatile float tiny = 1e-38f, tenth = 0.1f;
    ASSERT_EQ(tiny * tenth, 0) << "the mode is on";
    single = WorstAgainstTextbook<float>(HemisphereBasis<float>::kMaxDegree, false);
    batch = WorstAgainstTextbook<float>(HemisphereBasis<float>::kMaxDegree, true);
    exact = WorstAgainstTextbook<double>(1000, false);
    exact_batch = WorstAgainstTextbook<double>(1000, true);
  }
  EXPECT_LT(single, 3e-5);
  EXPECT_LT(batch, 3e-5);
  EXPECT_LT(exact, 2e-11);
  EXPECT_LT(exact_batch, 2e-11);
}

// Only z^2 enters, so what lies below the horizon by rounding has the value of its mirror image above: the
// difference from the horizon is that of z^2.
TEST(ExtremesTest, BelowTheHorizonByRoundingIsTheHorizon) {
  const HemisphereBasis<float> basis(64);
  std::vector<float> at(basis.size()), below(basis.size());
  basis.Evaluate(0.6f, 0.8f, 0.0f, at.data());
  for (const float z : {-1e-7f, -1e-20f, -0.0f}) {
    basis.Evaluate(0.6f, 0.8f, z, below.data());
    EXPECT_EQ(at, below) << z;
  }
  // And far enough below to matter it is that of the mirror image, to the last bit.
  basis.Evaluate(0.6f, 0.8f, 0.01f, at.data());
  basis.Evaluate(0.6f, 0.8f, -0.01f, below.data());
  EXPECT_EQ(at, below);
}

// The two fused readers of lobes against the basis, in the same directions, flushed to zero or not.
TEST(ExtremesTest, ReadersOfLobesAgreeWithTheBasisFromPoleToHorizon) {
  for (const bool flushed : {false, true}) {
    if (flushed && !FlushToZero::kThere) continue;
    constexpr int kDegree = 64, kCount = CoefficientCount(kDegree);
    const HemisphereBasis<float> basis(kDegree);
    const LobeReader reader(kDegree);
    const LobeLanes lanes(kDegree);
    std::vector<float> lobe(3 * kCount), packed(reader.packed_size(), 0.0f), h(kCount);
    double norm = 0;
    for (size_t k = 0; k < lobe.size(); ++k) lobe[k] = float(std::sin(1.7 * double(k)));
    for (int k = 0; k < kCount; ++k) norm += lobe[k] * lobe[k];
    reader.Pack(lobe.data(), kDegree, packed.data());
    const auto directions = ExtremeDirections();
    ASSERT_LE(directions.size(), size_t(kLanes));
    alignas(64) float x[kLanes] = {}, y[kLanes] = {}, z[kLanes] = {}, out[3 * kLanes] = {};
    for (size_t i = 0; i < directions.size(); ++i) {
      x[i] = float(directions[i].x);
      y[i] = float(directions[i].y);
      z[i] = float(directions[i].z);
    }
    std::vector<std::array<float, 3>> expected, read;
    const auto evaluate = [&] {
      lanes.Add(lobe.data(), kDegree, x, y, z, out);
      for (size_t i = 0; i < directions.size(); ++i) {
        basis.Evaluate(x[i], y[i], z[i], h.data());
        read.push_back(reader.Read(packed.data(), x[i], y[i], z[i]));
        expected.emplace_back();
        for (int c = 0; c < 3; ++c) {
          double sum = 0;
          for (int k = 0; k < kCount; ++k) sum += double(lobe[c * kCount + k]) * h[k];
          expected.back()[c] = float(sum);
        }
      }
    };
    if (flushed) {
      const FlushToZero flush;
      evaluate();
    } else {
      evaluate();
    }
    // Float's error of the basis, 3e-5 of up to 6, in 2145 terms of norm sqrt(1072): 33 * 2e-4 at worst.
    for (size_t i = 0; i < directions.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(read[i][c], expected[i][c], 2e-4 * std::sqrt(norm)) << "direction " << i;
        EXPECT_NEAR(out[c * kLanes + int(i)], expected[i][c], 2e-4 * std::sqrt(norm)) << "direction " << i;
      }
    }
  }
}

}  // namespace
}  // namespace lobe
