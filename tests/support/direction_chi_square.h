#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>

#include "sh/quadrature.h"
#include "sh/vector.h"

namespace lobe::test {

/// Pearson's chi-square test of sampled directions against the density they claim, over the whole sphere.
/// Cells have equal steps in theta and phi; the density is integrated over each by adaptive
/// Gauss-Legendre, so lobes far narrower than a cell are seen. What the density lacks of 1 is the chance of
/// "no direction", a cell of its own.
class DirectionChiSquare {
 public:
  explicit DirectionChiSquare(const std::function<double(const Vec3d&)>& pdf, int polar = 18,
                              int azimuth = 18)
      : pdf_(pdf), polar_(polar), azimuth_(azimuth), counts_(size_t(polar) * azimuth, 0) {
    const double dt = std::numbers::pi / polar, dp = 2 * std::numbers::pi / azimuth;
    for (int i = 0; i < polar; ++i) {
      for (int j = 0; j < azimuth; ++j) {
        chances_.push_back(Refine(i * dt, (i + 1) * dt, j * dp, (j + 1) * dp, 0));
        integral_ += chances_.back();
      }
    }
  }

  void Add(const Vec3d& direction) {
    const double theta = std::acos(std::clamp(direction.z(), -1.0, 1.0));
    double phi = std::atan2(direction.y(), direction.x());
    if (phi < 0) phi += 2 * std::numbers::pi;
    const int i = std::min(int(theta / std::numbers::pi * polar_), polar_ - 1);
    const int j = std::min(int(phi / (2 * std::numbers::pi) * azimuth_), azimuth_ - 1);
    ++counts_[size_t(i) * azimuth_ + j];
    ++total_;
  }
  void AddNone() { ++none_, ++total_; }

  double integral() const { return integral_; }  ///< of the density over the sphere

  struct Result {
    double statistic = 0, p_value = 0;
    int cells = 0;
  };
  /// Cells are taken in order of expected count, those of fewer than 5 merged until they have it.
  Result Finish() const {
    struct Cell {
      double expected, seen;
    };
    std::vector<Cell> cells = {{std::max(0.0, 1 - integral_) * double(total_), double(none_)}};
    for (size_t i = 0; i < counts_.size(); ++i) {
      cells.push_back({chances_[i] * double(total_), double(counts_[i])});
    }
    std::stable_sort(cells.begin(), cells.end(),
                     [](const Cell& a, const Cell& b) { return a.expected < b.expected; });
    Result out;
    Cell merged{0, 0};
    const auto close = [&] {
      out.statistic += (merged.seen - merged.expected) * (merged.seen - merged.expected) / merged.expected;
      ++out.cells;
      merged = {0, 0};
    };
    for (const Cell& c : cells) {
      merged.expected += c.expected;
      merged.seen += c.seen;
      if (merged.expected >= 5) close();
    }
    if (merged.expected > 0) close();
    if (out.cells < 2) {  // all in one cell: nothing to tell apart
      out.p_value = 1;
    } else {
      out.p_value =
          boost::math::cdf(boost::math::complement(boost::math::chi_squared(out.cells - 1), out.statistic));
    }
    return out;
  }

 private:
  double Once(double t0, double t1, double p0, double p1) const {
    static const GaussLegendre rule(5, 0, 1);
    double sum = 0;
    for (size_t i = 0; i < 5; ++i) {
      const double theta = t0 + (t1 - t0) * rule.nodes[i], s = std::sin(theta), c = std::cos(theta);
      for (size_t j = 0; j < 5; ++j) {
        const double phi = p0 + (p1 - p0) * rule.nodes[j];
        sum += rule.weights[i] * rule.weights[j] * s * pdf_({s * std::cos(phi), s * std::sin(phi), c});
      }
    }
    return sum * (t1 - t0) * (p1 - p0);
  }
  double Refine(double t0, double t1, double p0, double p1, int depth) const {
    constexpr int kLeast = 2, kMost = 9;  // the least lets no lobe wider than 0.004 slip through
    const double tm = 0.5 * (t0 + t1), pm = 0.5 * (p0 + p1);
    const std::array<std::array<double, 4>, 4> parts = {
        {{t0, tm, p0, pm}, {t0, tm, pm, p1}, {tm, t1, p0, pm}, {tm, t1, pm, p1}}};
    if (depth >= kLeast) {
      double fine = 0;
      for (const auto& p : parts) fine += Once(p[0], p[1], p[2], p[3]);
      if (depth == kMost || std::abs(fine - Once(t0, t1, p0, p1)) < 1e-6) return fine;
    }
    double sum = 0;
    for (const auto& p : parts) sum += Refine(p[0], p[1], p[2], p[3], depth + 1);
    return sum;
  }

  std::function<double(const Vec3d&)> pdf_;
  int polar_, azimuth_;
  std::vector<double> chances_;
  std::vector<long> counts_;
  long none_ = 0, total_ = 0;
  double integral_ = 0;
};

}  // namespace lobe::test
