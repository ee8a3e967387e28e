#include "brdf/incident_moments.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;

// Base and gloss, 3 channels each, one below the other.
Eigen::VectorXf Leaving(IncidentMoments& moments, const MaterialLobes& material) {
  const int base = 3 * material.base.count(), gloss = 3 * material.gloss.count();
  Eigen::VectorXf out = Eigen::VectorXf::Zero(base + gloss);
  moments.Finish(out.data(), out.data() + base);
  return out;
}

// Uneven light whose channels differ.
std::vector<float> Planes(int count) {
  std::vector<float> out;
  for (int c = 0; c < 3; ++c) {
    for (int j = 0; j < count; ++j) out.push_back(float(1.2 + std::sin(3.7 * j + 1.9 * c * j + c)));
  }
  return out;
}

MaterialLobes Plastic(int l_max, TableCache& cache) {
  MetallicRoughness plastic;
  plastic.base_color = Rgb(0.8f, 0.5f, 0.2f);
  plastic.metallic = 0.5f;
  plastic.roughness = 0.5f;
  LobeOptions options;
  options.force_l_max = l_max;
  return MaterialLobes(plastic, options, cache);
}

// Rounding alone: float sums of up to 64 terms, orders turned by a float recurrence, eps * 64 ~ 1e-5.
constexpr float kRounding = 1e-5f;

TEST(IncidentMomentsTest, RingEqualsItsContributionsOneByOne) {
  TableCache cache;
  for (const int l_max : {1, 8, 15, 16, 20}) {
    const MaterialLobes material = Plastic(l_max, cache);
    IncidentMoments whole, single;
    for (const int count : {1, 2, 3, 8, 17, 64}) {
      const std::vector<float> planes = Planes(count);
      // The first two angles lie in the spline's first interval, where odd orders are mirrored.
      for (const float cosine : {1.0f, 0.999f, 0.83f, 0.4f, 0.02f}) {
        const float phi0 = 0.7f - 3 * cosine, sine = std::sqrt(1 - cosine * cosine);
        whole.Start(material);
        whole.AddRing(cosine, planes.data(), count, phi0);
        single.Start(material);
        for (int j = 0; j < count; ++j) {
          const double phi = phi0 + 2 * kPi * j / count;
          // At the pole Add takes azimuth 0, where only order 0 is left to matter.
          single.Add(Vec3(float(sine * std::cos(phi)), float(sine * std::sin(phi)), cosine),
                     Rgb(planes[j], planes[count + j], planes[2 * count + j]));
        }
        const Eigen::VectorXf ring = Leaving(whole, material), sum = Leaving(single, material);
        EXPECT_LT((ring - sum).norm(), kRounding * sum.norm())
            << "l_max " << l_max << ", count " << count << ", cosine " << cosine;
      }
    }
  }
}

// Rings of both kinds accumulate with single contributions, and a new material forgets them.
TEST(IncidentMomentsTest, RingsAddUpAndStartClears) {
  TableCache cache;
  const MaterialLobes material = Plastic(12, cache), other = Plastic(7, cache);
  const std::vector<float> planes = Planes(24);
  IncidentMoments moments;
  moments.Start(material);
  moments.AddRing(0.6f, planes.data(), 24, 0.3f);
  const Eigen::VectorXf once = Leaving(moments, material);
  moments.AddRing(0.6f, planes.data(), 24, 0.3f);
  EXPECT_LT((Leaving(moments, material) - 2 * once).norm(), kRounding * once.norm());
  moments.Start(other);
  moments.AddRing(0.6f, planes.data(), 24, 0.3f);
  moments.Start(material);
  moments.AddRing(0.6f, planes.data(), 24, 0.3f);
  EXPECT_EQ((Leaving(moments, material) - once).norm(), 0);
}

TEST(RingTransformTest, FindsEachWaveInItsOrderAlone) {
  constexpr int kCount = 40, kLMax = 18;
  const RingTransform transform(kCount, kLMax);
  std::vector<float> planes(3 * kCount), out(3 * 2 * (kLMax + 1)), scratch;
  for (int order = 1; order <= kLMax; ++order) {
    for (int j = 0; j < kCount; ++j) {
      const double angle = 2 * kPi * order * j / kCount;
      planes[j] = float(std::cos(angle));
      planes[kCount + j] = float(std::sin(angle));
      planes[2 * kCount + j] = 1;
    }
    transform.Apply(planes.data(), out.data(), scratch);
    for (int row = 0; row < 6; ++row) {
      for (int m = 0; m <= kLMax; ++m) {
        // Red is a cosine, green a sine, of half the count's norm; blue is constant.
        const bool here = ((row == 0 || row == 3) && m == order) || (row == 4 && m == 0);
        const float expected = here ? (row == 4 ? kCount : 0.5f * kCount) : 0.0f;
        EXPECT_NEAR(out[row * (kLMax + 1) + m], expected, 1e-5f * kCount) << "order " << order;
      }
    }
  }
}

TEST(RingTransformTest, RefusesAnEmptyRing) {
  EXPECT_THROW(RingTransform(0, 8), std::invalid_argument);
  EXPECT_THROW(RingTransform(8, -1), std::invalid_argument);
}

}  // namespace
}  // namespace lobe
