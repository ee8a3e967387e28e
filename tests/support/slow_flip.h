#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "render/image.h"

namespace lobe::test {

/// FLIP of one pixel, as the paper writes it: square kernels, summed directly, in double precision. Nothing
/// is separated, so it takes seconds where render/flip.h takes milliseconds.
class SlowFlip {
 public:
  explicit SlowFlip(double pixels_per_degree) : ppd_(pixels_per_degree) {}

  double At(const Image& a, const Image& b, int x, int y) const {
    const Seen sa = Look(a, x, y), sb = Look(b, x, y);
    const double largest = std::pow(HyAb(Hunt({0, 1, 0}), Hunt({0, 0, 1})), 0.7), knee = 0.4 * largest;
    double colour = std::pow(HyAb(sa.lab, sb.lab), 0.7);
    colour = colour < knee ? 0.95 * colour / knee : 0.95 + 0.05 * (colour - knee) / (largest - knee);
    const double feature = std::max(std::abs(sa.edge - sb.edge), std::abs(sa.point - sb.point));
    return std::pow(colour, 1 - std::sqrt(feature / std::numbers::sqrt2));
  }

 private:
  using Colour = std::array<double, 3>;
  using Weight = std::function<double(int, int)>;
  struct Seen {
    Colour lab;
    double edge, point;
  };

  /// X, Y and Z, each over that of white.
  static Colour Xyz(const Colour& c) {
    const double m[3][3] = {{0.41239080, 0.35758434, 0.18048079},
                            {0.21263901, 0.71516868, 0.07219232},
                            {0.01933082, 0.11919478, 0.95053215}};
    Colour out;
    for (int i = 0; i < 3; ++i) {
      out[i] = (m[i][0] * c[0] + m[i][1] * c[1] + m[i][2] * c[2]) / (m[i][0] + m[i][1] + m[i][2]);
    }
    return out;
  }
  static Colour Rgb(const Colour& t) {  // back, by the inverse in the standard
    const double x = t[0] * 0.95045593, y = t[1], z = t[2] * 1.08905775;
    return {3.24096994 * x - 1.53738318 * y - 0.49861076 * z,
            -0.96924364 * x + 1.87596750 * y + 0.04155506 * z,
            0.05563008 * x - 0.20397696 * y + 1.05697151 * z};
  }
  static Colour Hunt(const Colour& rgb) {
    const Colour t = Xyz(rgb);
    const auto f = [](double v) { return v > 216.0 / 24389 ? std::cbrt(v) : v * 841 / 108 + 4.0 / 29; };
    const double lightness = 116 * f(t[1]) - 16;
    return {lightness, 5 * lightness * (f(t[0]) - f(t[1])), 2 * lightness * (f(t[1]) - f(t[2]))};
  }
  static double HyAb(const Colour& a, const Colour& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
  }

  /// Sum of weight times YCxCz around a pixel; positive and negative weights sum to 1 and -1.
  static Colour Filtered(const Image& image, int x, int y, int radius, const Weight& weight) {
    Colour positive{}, negative{};
    double positive_sum = 0, negative_sum = 0;
    for (int j = -radius; j <= radius; ++j) {
      for (int i = -radius; i <= radius; ++i) {
        const auto& p =
            image.at(std::clamp(x + i, 0, image.width - 1), std::clamp(y + j, 0, image.height - 1));
        const Colour t = Xyz({p[0], p[1], p[2]});
        const Colour opponent = {116 * t[1] - 16, 500 * (t[0] - t[1]), 200 * (t[1] - t[2])};
        const double w = weight(i, j);
        (w > 0 ? positive_sum : negative_sum) += std::abs(w);
        for (int c = 0; c < 3; ++c) (w > 0 ? positive : negative)[c] += std::abs(w) * opponent[c];
      }
    }
    Colour out;
    for (int c = 0; c < 3; ++c) {
      out[c] = positive[c] / positive_sum - (negative_sum > 0 ? negative[c] / negative_sum : 0);
    }
    return out;
  }

  Seen Look(const Image& image, int x, int y) const {
    constexpr double pi = std::numbers::pi;
    const double tables[3][4] = {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
    const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd_));
    Colour seen;
    for (int c = 0; c < 3; ++c) {
      const auto [a1, b1, a2, b2] = std::to_array(tables[c]);
      seen[c] = Filtered(image, x, y, radius, [&](int i, int j) {
        const double d2 = (i * i + j * j) / (ppd_ * ppd_);
        return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * d2 / b1) +
               a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * d2 / b2);
      })[c];
    }
    const double luminance = (seen[0] + 16) / 116;
    Colour rgb = Rgb({luminance + seen[1] / 500, luminance, luminance - seen[2] / 200});
    for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);

    const double sigma = 0.5 * 0.082 * ppd_;
    const int reach = int(std::ceil(3 * sigma));
    const auto magnitude = [&](const std::function<double(int)>& along) {
      const auto gauss = [&](int i, int j) { return std::exp(-(i * i + j * j) / (2 * sigma * sigma)); };
      const double gx = Filtered(image, x, y, reach, [&](int i, int j) { return along(i) * gauss(i, j); })[0];
      const double gy = Filtered(image, x, y, reach, [&](int i, int j) { return along(j) * gauss(i, j); })[0];
      return std::hypot(gx, gy) / 116;
    };
    return {Hunt(rgb), magnitude([](int i) { return -double(i); }),
            magnitude([&](int i) { return i * i / (sigma * sigma) - 1; })};
  }

  double ppd_;
};

}  // namespace lobe::test
