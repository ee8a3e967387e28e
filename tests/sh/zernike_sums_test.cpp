#include "sh/zernike_sums.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "sh/quadrature.h"
#include "sh/zernike.h"

namespace lobe {
namespace {

// Points all over the disc, centre and rim included; 29 of them fill no whole number of vector lanes.
struct Points {
  std::vector<double> x, y, values;
  Points() {
    constexpr int kCount = 29;
    for (int i = 0; i < kCount; ++i) {
      const double rho = i == 0 ? 0 : i == 1 ? 1 : std::fmod(0.618 * i, 1), phi = 2.4 * i;
      x.push_back(rho * std::cos(phi));
      y.push_back(rho * std::sin(phi));
    }
    for (int i = 0; i < 2 * kCount; ++i) values.push_back(std::sin(1.3 * i + 0.4));
  }
};

TEST(ZernikeSumsTest, EqualTheFunctionsOnePointAtATime) {
  const Points points;
  const int count = int(points.x.size());
  for (const int l_max : {0, 1, 7, 20, 32}) {
    ZernikeSums sums(l_max, 2);
    sums.Add(points.x.data(), points.y.data(), points.values.data(), count);
    std::vector<double> radial(l_max / 2 + 1);
    for (int m = 0; m <= l_max; ++m) {
      for (int n = m; n <= l_max; n += 2) {
        for (int plane = 0; plane < 2; ++plane) {
          double expected = 0;
          for (int i = 0; i < count; ++i) {
            ZernikeRadial(m, n, std::hypot(points.x[i], points.y[i]), radial.data());
            expected += points.values[plane * count + i] * radial[(n - m) / 2] *
                        std::cos(m * std::atan2(points.y[i], points.x[i]));
          }
          EXPECT_NEAR(sums.Sum(n, m, plane), expected, 1e-11) << "n " << n << ", m " << m;
        }
      }
    }
  }
}

TEST(ZernikeSumsTest, PointsAddUpOverCalls) {
  const Points points;
  ZernikeSums once(9, 1), twice(9, 1);
  once.Add(points.x.data(), points.y.data(), points.values.data(), 24);
  twice.Add(points.x.data(), points.y.data(), points.values.data(), 11);
  twice.Add(points.x.data() + 11, points.y.data() + 11, points.values.data() + 11, 13);
  EXPECT_NEAR(once.Sum(9, 3, 0), twice.Sum(9, 3, 0), 1e-13);
  EXPECT_NEAR(once.Sum(0, 0, 0), twice.Sum(0, 0, 0), 1e-13);
}

TEST(ZernikeSumsTest, RefusesNegativeDegreeAndNoPlanes) {
  EXPECT_THROW(ZernikeSums(-1, 1), std::invalid_argument);
  EXPECT_THROW(ZernikeSums(4, 0), std::invalid_argument);
}

}  // namespace
}  // namespace lobe
