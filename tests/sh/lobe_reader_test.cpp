#include "sh/lobe_reader.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "sh/hemisphere_basis.h"
#include "sh/vector.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<float> RandomLobe(int l_max, std::mt19937* bits) {
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<float> out(size_t(3) * CoefficientCount(l_max));
  for (float& c : out) c = uniform(*bits);
  return out;
}

// The value the plain way, in double: basis, then dot products. `scale`: sum of the terms' absolute values.
struct Sum {
  double value = 0, scale = 0;
};
Sum DotProduct(const std::vector<float>& lobe, int channel, int l_max, const Vec3& w) {
  const HemisphereBasis<double> basis(l_max);
  std::vector<double> h(basis.size());
  basis.Evaluate(w.x(), w.y(), w.z(), h.data());
  Sum out;
  for (int k = 0; k < basis.size(); ++k) {
    const double term = double(lobe[size_t(channel) * basis.size() + k]) * h[k];
    out.value += term;
    out.scale += std::abs(term);
  }
  return out;
}

Vec3 Direction(double theta, double phi) {
  return {float(std::sin(theta) * std::cos(phi)), float(std::sin(theta) * std::sin(phi)),
          float(std::cos(theta))};
}

// Generic ones, the pole and places a hair off it, the horizon, and axes on it.
std::vector<Vec3> Directions() {
  std::vector<Vec3> out = {Vec3::UnitZ(), Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitY()};
  for (const double theta : {1e-6, 1e-3, 0.2, 0.7, 1.2, 1.5, 1.57, kPi / 2}) {
    for (const double phi : {0.3, 2.1, -1.4, -2.9}) out.push_back(Direction(theta, phi));
  }
  for (Vec3& w : out) w.z() = std::max(w.z(), 0.0f);
  return out;
}

// Rounding of a sum of floats: a few units in the last place of its terms; the recurrence over l adds one or
// two a step. Measured: 3.3e-7 at most up to degree 33, 1e-6 at 63.
constexpr double kRounding = 1.5e-6;

void ExpectReads(const LobeReader& reader, const std::vector<float>& packed,
                 const std::vector<std::pair<std::vector<float>, int>>& lobes, const Vec3& w) {
  const auto got = reader.Read(packed.data(), w.x(), w.y(), w.z());
  for (int c = 0; c < 3; ++c) {
    Sum sum;
    for (const auto& [lobe, l_max] : lobes) {
      const Sum one = DotProduct(lobe, c, l_max, w);
      sum.value += one.value;
      sum.scale += one.scale;
    }
    ASSERT_NEAR(got[c], sum.value, kRounding * sum.scale)
        << "reader of degree " << reader.l_max() << ", channel " << c << ", towards " << w.transpose();
  }
}

TEST(LobeReaderTest, EqualsTheDotProductWithTheBasisAtEveryDegree) {
  std::mt19937 bits(1);
  std::vector<int> degrees = {47, 48, 63, 64};
  for (int l = 0; l <= 32; ++l) degrees.push_back(l);
  for (const int l_max : degrees) {
    const LobeReader reader(l_max);
    const std::vector<float> lobe = RandomLobe(l_max, &bits);
    std::vector<float> packed(reader.packed_size(), 0.0f);
    reader.Pack(lobe.data(), l_max, packed.data());
    for (const Vec3& w : Directions()) ExpectReads(reader, packed, {{lobe, l_max}}, w);
  }
}

// A wrong place in the packed lobe could hide in a random sum, but not here.
TEST(LobeReaderTest, EachCoefficientReadsItsOwnFunctionInItsOwnChannel) {
  constexpr int kDegree = 19;  // more orders than are summed side by side
  const LobeReader reader(kDegree);
  const HemisphereBasis<double> basis(kDegree);
  std::vector<double> h(basis.size());
  const Vec3 w = Direction(0.9, 2.3);
  basis.Evaluate(w.x(), w.y(), w.z(), h.data());
  for (int k = 0; k < basis.size(); ++k) {
    for (int channel = 0; channel < 3; ++channel) {
      std::vector<float> lobe(size_t(3) * basis.size(), 0.0f), packed(reader.packed_size(), 0.0f);
      lobe[size_t(channel) * basis.size() + k] = 1;
      reader.Pack(lobe.data(), kDegree, packed.data());
      const auto got = reader.Read(packed.data(), w.x(), w.y(), w.z());
      for (int c = 0; c < 3; ++c) {
        if (c == channel) {
          ASSERT_NEAR(got[c], h[k], 2e-6) << k;
        } else {
          ASSERT_EQ(got[c], 0) << k;
        }
      }
    }
  }
}

TEST(LobeReaderTest, LobesOfLowerDegreePackIntoAReaderOfAHigherOne) {
  std::mt19937 bits(2);
  for (const int high : {1, 7, 16, 20, 33}) {
    const LobeReader reader(high);
    for (int low = 0; low <= high; low += 1 + high / 6) {
      const std::vector<float> lobe = RandomLobe(low, &bits);
      std::vector<float> packed(reader.packed_size(), 0.0f);
      reader.Pack(lobe.data(), low, packed.data());
      for (const Vec3& w : Directions()) ExpectReads(reader, packed, {{lobe, low}}, w);
    }
  }
}

TEST(LobeReaderTest, BaseAndGlossPackedTogetherReadAsTheirSum) {
  std::mt19937 bits(3);
  for (const auto& [base, gloss] : {std::pair{0, 20}, {5, 12}, {12, 12}, {9, 17}, {20, 3}}) {
    const LobeReader reader(std::max(base, gloss));
    const std::vector<float> b = RandomLobe(base, &bits), g = RandomLobe(gloss, &bits);
    std::vector<float> packed(reader.packed_size(), 0.0f);
    reader.Pack(b.data(), base, packed.data());
    reader.Pack(g.data(), gloss, packed.data());
    for (const Vec3& w : Directions()) ExpectReads(reader, packed, {{b, base}, {g, gloss}}, w);
  }
}

TEST(LobeReaderTest, AtThePoleOnlyOrderZeroIsLeft) {
  constexpr int kDegree = 21;
  std::mt19937 bits(4);
  const LobeReader reader(kDegree);
  std::vector<float> lobe = RandomLobe(kDegree, &bits);
  for (int l = 0; l <= kDegree; l += 2) {
    for (int c = 0; c < 3; ++c) lobe[c * CoefficientCount(kDegree) + CoefficientIndex(l, 0)] = 0;
  }
  std::vector<float> packed(reader.packed_size(), 0.0f);
  reader.Pack(lobe.data(), kDegree, packed.data());
  for (const float value : reader.Read(packed.data(), 0, 0, 1)) EXPECT_EQ(value, 0);
}

TEST(LobeReaderTest, OneReaderServesManyLobesOfOneArray) {
  std::mt19937 bits(5);
  const LobeReader reader(10);
  const std::vector<float> a = RandomLobe(10, &bits), b = RandomLobe(10, &bits);
  // Lobes lie back to back, at any alignment; what is beyond them is not read.
  std::vector<float> packed(1 + 2 * reader.packed_size(), 0.0f);
  float *first = packed.data() + 1, *second = first + reader.packed_size();
  reader.Pack(a.data(), 10, first);
  reader.Pack(b.data(), 10, second);
  const std::vector<float> alone_a(first, second), alone_b(second, second + reader.packed_size());
  for (const Vec3& w : Directions()) {
    EXPECT_EQ(reader.Read(first, w.x(), w.y(), w.z()), reader.Read(alone_a.data(), w.x(), w.y(), w.z()));
    EXPECT_EQ(reader.Read(second, w.x(), w.y(), w.z()), reader.Read(alone_b.data(), w.x(), w.y(), w.z()));
  }
  // Not numbers on both sides of a lobe do no harm.
  std::vector<float> fenced(reader.packed_size() + 32, std::numeric_limits<float>::quiet_NaN());
  std::copy(alone_a.begin(), alone_a.end(), fenced.begin() + 16);
  const Vec3 w = Direction(0.4, 1.0);
  EXPECT_EQ(reader.Read(fenced.data() + 16, w.x(), w.y(), w.z()), reader.Read(first, w.x(), w.y(), w.z()));
}

TEST(LobeReaderTest, RefusesDegreesItCannotRead) {
  EXPECT_THROW(LobeReader(-1), std::invalid_argument);
  EXPECT_THROW(LobeReader(65), std::invalid_argument);
}

}  // namespace
}  // namespace lobe
