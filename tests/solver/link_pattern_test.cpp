#include "solver/link_pattern.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "sh/hemisphere_basis.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(LinkPatternTest, GivesAboutTheLinksAskedForInWholeThinnableRings) {
  for (const int links : {8, 64, 100, 512, 2000, 100000}) {
    const LinkPattern p = LinkPattern::For(links, -1, 8);
    EXPECT_EQ(p.sectors % LinkPattern::kThinnest, 0);
    EXPECT_GE(p.rings, 1);
    EXPECT_GT(p.count(), 0.7 * links);
    EXPECT_LT(p.count(), 1.4 * links);
    EXPECT_EQ(LinkPattern::For(links, 0, 8).count(), p.count()) << "degree 0 is as good as diffuse";
  }
}

TEST(LinkPatternTest, GlossyNodesHaveLinksForEveryCoefficientAndOrder) {
  for (int l_max = 1; l_max <= 32; ++l_max) {
    const LinkPattern p = LinkPattern::For(64, l_max, 8);
    EXPECT_GT(p.count(), 0.9 * 8 * CoefficientCount(l_max)) << l_max;
    EXPECT_GT(p.sectors, 2 * l_max) << "orders up to " << l_max << " would alias";
  }
}

// Means over nodes of what each node's pattern sums to, with the standard error of that mean.
struct Mean {
  double value, error;
};
Mean OverNodes(const LinkPattern& pattern, int nodes,
               const std::function<double(const LinkDirections&)>& of) {
  LinkDirections directions(pattern);
  double sum = 0, sum2 = 0;
  for (int n = 0; n < nodes; ++n) {
    directions.Start(uint32_t(n), 1);
    const double x = of(directions);
    sum += x;
    sum2 += x * x;
  }
  const double mean = sum / nodes;
  return {mean, std::sqrt(std::max(sum2 / nodes - mean * mean, 0.0) / (nodes - 1))};
}

// Of the density cos / pi: E cos^k = 2 / (k + 2).
TEST(LinkDirectionsTest, PolarAnglesHaveTheMomentsOfACosineDistribution) {
  for (const LinkPattern pattern : {LinkPattern{1, 8}, LinkPattern{4, 16}, LinkPattern{13, 40}}) {
    for (int k = 1; k <= 6; ++k) {
      const Mean m = OverNodes(pattern, 20000, [&](const LinkDirections& d) {
        double sum = 0;
        for (int r = 0; r < pattern.rings; ++r) sum += std::pow(double(d.CosTheta(r)), k) / pattern.rings;
        return sum;
      });
      EXPECT_NEAR(m.value, 2.0 / (k + 2), 4 * m.error) << pattern.rings << " rings, power " << k;
      EXPECT_LT(m.error, 2.5e-3);
    }
  }
}

// Sectors are equally spaced, so harmonics that are no multiple of their number vanish ring by ring; the
// others vanish on average, since rings are turned at random.
TEST(LinkDirectionsTest, AzimuthsAreUniform) {
  const LinkPattern pattern{5, 16};
  for (const int m : {1, 2, 3, 7, 15, 17}) {
    const Mean one = OverNodes(pattern, 200, [&](const LinkDirections& d) {
      double worst = 0;
      for (int r = 0; r < pattern.rings; ++r) {
        double re = 0, im = 0;
        for (int s = 0; s < pattern.sectors; ++s) {
          const Vec3 w = d.Local(r, s);
          const double phi = std::atan2(double(w.y()), double(w.x()));
          re += std::cos(m * phi) / pattern.sectors;
          im += std::sin(m * phi) / pattern.sectors;
        }
        worst = std::max({worst, std::abs(re), std::abs(im)});
      }
      return worst;
    });
    EXPECT_LT(one.value, 2e-5) << "order " << m;
  }
  for (const int m : {16, 32, 48}) {
    for (const bool sine : {false, true}) {
      const Mean mean = OverNodes(pattern, 20000, [&](const LinkDirections& d) {
        double sum = 0;
        for (int r = 0; r < pattern.rings; ++r) {
          const Vec3 w = d.Local(r, 3);
          const double phi = std::atan2(double(w.y()), double(w.x()));
          sum += (sine ? std::sin(m * phi) : std::cos(m * phi)) / pattern.rings;
        }
        return sum;
      });
      EXPECT_NEAR(mean.value, 0, 4 * mean.error) << "order " << m;
      EXPECT_NEAR(mean.error, std::sqrt(0.5 / (20000.0 * pattern.rings)), 0.05 * mean.error)
          << "as many independent rings as there are";
    }
  }
}

// Irradiance from any sky comes out on average: here one that is neither even nor band-limited.
TEST(LinkDirectionsTest, MeansOverLinksAreCosWeightedIntegrals) {
  const LinkPattern pattern{6, 24};
  // Integral of cos over the wedge 0.2 < phi < 1.3, theta < 0.8: 1.1 / 2 sin^2 0.8; divided by pi.
  const Mean wedge = OverNodes(pattern, 20000, [&](const LinkDirections& d) {
    double sum = 0;
    for (int r = 0; r < pattern.rings; ++r) {
      for (int s = 0; s < pattern.sectors; ++s) {
        const Vec3 w = d.Local(r, s);
        const double phi = std::atan2(double(w.y()), double(w.x()));
        sum += phi > 0.2 && phi < 1.3 && w.z() > std::cos(0.8);
      }
    }
    return sum / pattern.count();
  });
  EXPECT_NEAR(wedge.value, 1.1 / (2 * kPi) * std::pow(std::sin(0.8), 2), 4 * wedge.error);
  EXPECT_LT(wedge.error, 2e-4);
}

TEST(LinkDirectionsTest, RingsAreStrataOfEqualCosWeightedSolidAngle) {
  const LinkPattern pattern{9, 24};
  LinkDirections directions(pattern);
  for (uint32_t node = 0; node < 500; ++node) {
    directions.Start(node, 3);
    for (int r = 0; r < pattern.rings; ++r) {
      const double u = 1 - double(directions.CosTheta(r)) * directions.CosTheta(r);  // sin^2 theta
      ASSERT_GE(u, double(r) / pattern.rings - 1e-6);
      ASSERT_LE(u, double(r + 1) / pattern.rings + 1e-6);
    }
  }
}

TEST(LinkDirectionsTest, LocalsAreUnitAndOnTheirRing) {
  const LinkPattern pattern{7, 32};
  LinkDirections directions(pattern);
  for (uint32_t node = 0; node < 100; ++node) {
    directions.Start(node, 5);
    for (int r = 0; r < pattern.rings; ++r) {
      for (int s = 0; s < pattern.sectors; ++s) {
        const Vec3 w = directions.Local(r, s);
        ASSERT_NEAR(w.norm(), 1, 5e-7);
        ASSERT_EQ(w.z(), directions.CosTheta(r));
        const double phi = directions.Phi(r) + 2 * kPi * s / pattern.sectors;
        const double sine = std::sqrt(1 - double(w.z()) * w.z());
        ASSERT_NEAR(w.x(), sine * std::cos(phi), 1e-6);
        ASSERT_NEAR(w.y(), sine * std::sin(phi), 1e-6);
      }
    }
  }
}

TEST(LinkDirectionsTest, WorldIsTheFramesPictureOfLocal) {
  const LinkPattern pattern{5, 40};
  LinkDirections directions(pattern);
  std::vector<float> x(pattern.count()), y(x), z(x);
  uint32_t node = 0;
  for (const Vec3& normal : {Vec3(0, 1, 0), Vec3(0, 0, -1), Vec3(0.3f, -0.8f, 0.4f), Vec3(-1, 0.01f, 0)}) {
    const Frame frame(normal.normalized());
    directions.Start(++node, 7);
    directions.World(frame, x.data(), y.data(), z.data());
    for (int r = 0; r < pattern.rings; ++r) {
      for (int s = 0; s < pattern.sectors; ++s) {
        const int i = r * pattern.sectors + s;
        const Vec3 expected = frame.ToWorld(directions.Local(r, s));
        ASSERT_LT((Vec3(x[i], y[i], z[i]) - expected).norm(), 1e-6);
      }
    }
  }
}

TEST(LinkDirectionsTest, SameNodeAndSeedAreTheSameBitsWhateverWasAskedBefore) {
  const LinkPattern pattern{6, 16};
  LinkDirections a(pattern), b(pattern);
  a.Start(41, 9);
  b.Start(7, 1);
  b.Start(41, 9);
  for (int r = 0; r < pattern.rings; ++r) {
    EXPECT_EQ(a.CosTheta(r), b.CosTheta(r));
    EXPECT_EQ(a.Phi(r), b.Phi(r));
    for (int s = 0; s < pattern.sectors; ++s) EXPECT_EQ(a.Local(r, s), b.Local(r, s));
  }
}

// Neighbours in node, ring or seed must not share their errors: their numbers do not correlate, nor repeat.
TEST(LinkDirectionsTest, NodesRingsAndSeedsAreIndependent) {
  const LinkPattern pattern{8, 16};
  constexpr int kNodes = 4000;
  LinkDirections d(pattern);
  const auto jitter = [&](uint32_t node, uint64_t seed) {
    d.Start(node, seed);
    std::vector<double> out;  // two a ring, each uniform in 0..1
    for (int r = 0; r < pattern.rings; ++r) {
      const double u = 1 - double(d.CosTheta(r)) * d.CosTheta(r);
      out.push_back(u * pattern.rings - r);
      out.push_back(d.Phi(r) * pattern.sectors / (2 * kPi));
    }
    return out;
  };
  std::set<double> seen;
  double nodes = 0, rings = 0, seeds = 0, pairs = 0;
  for (uint32_t n = 0; n < kNodes; ++n) {
    const auto here = jitter(n, 1), next = jitter(n + 1, 1), other = jitter(n, 2);
    for (size_t i = 0; i < here.size(); ++i) {
      seen.insert(here[i]);
      nodes += (here[i] - 0.5) * (next[i] - 0.5);
      seeds += (here[i] - 0.5) * (other[i] - 0.5);
    }
    for (size_t i = 0; i + 2 < here.size(); ++i) rings += (here[i] - 0.5) * (here[i + 2] - 0.5);
    for (size_t i = 0; i < here.size(); i += 2) pairs += (here[i] - 0.5) * (here[i + 1] - 0.5);
  }
  // A product of two independent uniforms about 0 has standard deviation 1 / 12.
  const double count = 2.0 * pattern.rings * kNodes;
  EXPECT_LT(std::abs(nodes), 4 * std::sqrt(count) / 12);
  EXPECT_LT(std::abs(seeds), 4 * std::sqrt(count) / 12);
  EXPECT_LT(std::abs(rings), 4 * std::sqrt(count) / 12);
  EXPECT_LT(std::abs(pairs), 4 * std::sqrt(count) / 12);
  // Numbers of 24 bits: some collide by chance, whole nodes must not.
  EXPECT_GT(double(seen.size()), 0.99 * count);
}

}  // namespace
}  // namespace lobe
