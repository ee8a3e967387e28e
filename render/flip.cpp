#include "render/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <tbb/parallel_for.h>
#include <Eigen/LU>

namespace lobe {
namespace {

using Colour = Eigen::Array3f;
using Plane = std::vector<float>;  // one value per pixel

// Section 5: exponents and the remapping of large colour differences; width of the features' filters.
constexpr float kQc = 0.7f, kPc = 0.4f, kPt = 0.95f, kQf = 0.5f, kFeatureWidthDegrees = 0.082f;

/// Linear Rec. 709 to XYZ, D65 (IEC 61966-2-1).
const Eigen::Matrix3f kXyzFromRgb{{0.41239080f, 0.35758434f, 0.18048079f},
                                  {0.21263901f, 0.71516868f, 0.07219232f},
                                  {0.01933082f, 0.11919478f, 0.95053215f}};
const Eigen::Matrix3f kRgbFromXyz = kXyzFromRgb.inverse();
/// XYZ of white, so that (1, 1, 1) has no colour.
const Colour kWhite = (kXyzFromRgb * Eigen::Vector3f::Ones()).array();

Colour Xyz(const Colour& rgb) { return (kXyzFromRgb * rgb.matrix()).array(); }

/// Linearised opponent space: the cube roots of CIELAB left out, so that it may be filtered.
Colour YCxCz(const Colour& rgb) {
  const Colour t = Xyz(rgb) / kWhite;
  return {116 * t[1] - 16, 500 * (t[0] - t[1]), 200 * (t[1] - t[2])};
}

Colour RgbFromYCxCz(const Colour& c) {
  const float y = (c[0] + 16) / 116;
  const Colour xyz = Colour(y + c[1] / 500, y, y - c[2] / 200) * kWhite;
  return (kRgbFromXyz * xyz.matrix()).array();
}

/// CIELAB with the Hunt effect: a dark colour's chroma counts less (section 4.1.2).
Colour HuntAdjustedLab(const Colour& rgb) {
  constexpr float kDelta = 6.0f / 29;
  const Colour t = Xyz(rgb) / kWhite;
  Colour f;
  for (int i = 0; i < 3; ++i) {
    f[i] = t[i] > kDelta * kDelta * kDelta ? std::cbrt(t[i]) : t[i] / (3 * kDelta * kDelta) + 4.0f / 29;
  }
  const float lightness = 116 * f[1] - 16;
  return {lightness, 0.01f * lightness * 500 * (f[0] - f[1]), 0.01f * lightness * 200 * (f[1] - f[2])};
}

float HyAb(const Colour& a, const Colour& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// Odd kernel along one axis, its middle at size / 2.
using Kernel = std::vector<float>;

Kernel Gaussian(int radius, double scale) {  // exp(-scale i^2), not normalised
  Kernel k;
  for (int i = -radius; i <= radius; ++i) k.push_back(float(std::exp(-scale * i * i)));
  return k;
}

float Sum(const Kernel& kernel) {
  double sum = 0;
  for (const float v : kernel) sum += v;
  return float(sum);
}

void Normalise(Kernel* kernel) {
  const float sum = Sum(*kernel);
  for (float& v : *kernel) v /= sum;
}

class Filtering {
 public:
  Filtering(int width, int height) : width_(width), height_(height) {}

  Plane Along(const Plane& in, const Kernel& kernel, bool x_axis) const {
    Plane out(in.size());
    const int radius = int(kernel.size()) / 2;
    const auto clamped = [](int i, int count) { return std::clamp(i, 0, count - 1); };
    tbb::parallel_for(0, height_, [&](int y) {
      for (int x = 0; x < width_; ++x) {
        float sum = 0;
        for (int i = -radius; i <= radius; ++i) {
          const size_t at = x_axis ? size_t(y) * width_ + clamped(x + i, width_)
                                   : size_t(clamped(y + i, height_)) * width_ + x;
          sum += kernel[i + radius] * in[at];
        }
        out[size_t(y) * width_ + x] = sum;
      }
    });
    return out;
  }
  Plane Both(const Plane& in, const Kernel& x, const Kernel& y) const {
    return Along(Along(in, x, true), y, false);
  }

 private:
  int width_, height_;
};

/// What the eye makes of the opponent channels from a distance (section 4.1.1, eq. 4 and table 1): sums of
/// Gaussians a sqrt(pi / b) exp(-pi^2 d^2 / b), d in degrees. Each Gaussian separates; their weights carry
/// the two-dimensional normalisation.
class ContrastSensitivity {
 public:
  explicit ContrastSensitivity(double pixels_per_degree) {
    constexpr double pi = std::numbers::pi;
    struct Term {
      double a, b;
    };
    const std::array<std::vector<Term>, 3> table = {
        {{{1, 0.0047}}, {{1, 0.0053}}, {{34.1, 0.04}, {13.5, 0.025}}}};
    // Three standard deviations of the widest, for all channels alike.
    const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * pixels_per_degree));
    for (int c = 0; c < 3; ++c) {
      float total = 0;
      for (const Term& term : table[c]) {
        Kernel kernel = Gaussian(radius, pi * pi / (term.b * pixels_per_degree * pixels_per_degree));
        const float sum = Sum(kernel);
        Normalise(&kernel);
        const float weight = float(term.a * std::sqrt(pi / term.b)) * sum * sum;
        terms_[c].push_back({weight, kernel});
        total += weight;
      }
      for (auto& term : terms_[c]) term.first /= total;
    }
  }

  Plane Apply(const Filtering& filtering, const Plane& in, int channel) const {
    Plane out(in.size(), 0.0f);
    for (const auto& [weight, kernel] : terms_[channel]) {
      const Plane part = filtering.Both(in, kernel, kernel);
      for (size_t i = 0; i < out.size(); ++i) out[i] += weight * part[i];
    }
    return out;
  }

 private:
  std::array<std::vector<std::pair<float, Kernel>>, 3> terms_;
};

/// First and second derivatives of a Gaussian: edges and points (section 4.2.1).
struct FeatureDetector {
  Kernel smooth, edge, point;

  explicit FeatureDetector(double pixels_per_degree) {
    const double sigma = 0.5 * kFeatureWidthDegrees * pixels_per_degree;
    const int radius = int(std::ceil(3 * sigma));
    smooth = Gaussian(radius, 0.5 / (sigma * sigma));
    for (int i = -radius; i <= radius; ++i) {
      edge.push_back(float(-i) * smooth[i + radius]);
      point.push_back(float(i * i / (sigma * sigma) - 1) * smooth[i + radius]);
    }
    Normalise(&smooth);
    for (Kernel* kernel : {&edge, &point}) {  // positive weights sum to 1, negative ones to -1
      double positive = 0, negative = 0;
      for (const float v : *kernel) (v > 0 ? positive : negative) += std::abs(v);
      for (float& v : *kernel) v = float(v / (v > 0 ? positive : negative));
    }
  }

  Plane Magnitude(const Filtering& filtering, const Plane& in, const Kernel& derivative) const {
    Plane x = filtering.Both(in, derivative, smooth);
    const Plane y = filtering.Both(in, smooth, derivative);
    for (size_t i = 0; i < x.size(); ++i) x[i] = std::hypot(x[i], y[i]);
    return x;
  }
};

/// One picture's side of the comparison.
struct Seen {
  std::vector<Colour> lab;  // filtered by the eye, Hunt-adjusted
  Plane edges, points;

  Seen(const Image& image, const ContrastSensitivity& eye, const FeatureDetector& features) {
    const Filtering filtering(image.width, image.height);
    const size_t count = image.pixels.size();
    std::array<Plane, 3> opponent;
    for (Plane& plane : opponent) plane.resize(count);
    for (size_t i = 0; i < count; ++i) {
      const Colour c = YCxCz(image.pixels[i]);
      for (int k = 0; k < 3; ++k) opponent[k][i] = c[k];
    }
    Plane achromatic(count);  // 0..1
    for (size_t i = 0; i < count; ++i) achromatic[i] = (opponent[0][i] + 16) / 116;
    edges = features.Magnitude(filtering, achromatic, features.edge);
    points = features.Magnitude(filtering, achromatic, features.point);

    for (int k = 0; k < 3; ++k) opponent[k] = eye.Apply(filtering, opponent[k], k);
    lab.resize(count);
    for (size_t i = 0; i < count; ++i) {
      const Colour rgb = RgbFromYCxCz({opponent[0][i], opponent[1][i], opponent[2][i]});
      lab[i] = HuntAdjustedLab(rgb.max(0.0f).min(1.0f));
    }
  }
};

/// Compresses the largest colour differences into kPt..1 (section 4.1.3). `largest`: that of green and blue.
float Remapped(float difference, float largest) {
  const float knee = kPc * largest;
  if (difference < knee) return kPt / knee * difference;
  return std::min(1.0f, kPt + (difference - knee) / (largest - knee) * (1 - kPt));
}

}  // namespace

std::vector<float> FlipMap(const Image& a, const Image& b, double pixels_per_degree) {
  if (a.width != b.width || a.height != b.height) {
    throw std::invalid_argument("FlipMap: the pictures' sizes differ");
  }
  if (!(pixels_per_degree >= kFlipMinPixelsPerDegree && pixels_per_degree <= kFlipMaxPixelsPerDegree)) {
    throw std::invalid_argument("FlipMap: pixels per degree are out of range");
  }
  const ContrastSensitivity eye(pixels_per_degree);
  const FeatureDetector features(pixels_per_degree);
  const Seen seen_a(a, eye, features), seen_b(b, eye, features);
  const float largest = std::pow(HyAb(HuntAdjustedLab({0, 1, 0}), HuntAdjustedLab({0, 0, 1})), kQc);

  std::vector<float> flip(a.pixels.size());
  for (size_t i = 0; i < flip.size(); ++i) {
    const float colour = Remapped(std::pow(HyAb(seen_a.lab[i], seen_b.lab[i]), kQc), largest);
    const float feature =
        std::max(std::abs(seen_a.edges[i] - seen_b.edges[i]), std::abs(seen_a.points[i] - seen_b.points[i]));
    // A difference in edges or points makes one in colour show more (eq. 1).
    const float exponent = 1 - std::pow(std::min(1.0f, feature / std::numbers::sqrt2_v<float>), kQf);
    flip[i] = colour > 0 ? std::pow(colour, exponent) : 0.0f;
  }
  return flip;
}

}  // namespace lobe
