#include "brdf/measured.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <stdexcept>

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;

// The two points around x on an axis, and how far x is from the first to the second.
struct Place {
  size_t low, high;
  float fraction;
};

Place Locate(const std::vector<float>& axis, double x) {
  const size_t after = size_t(std::upper_bound(axis.begin(), axis.end(), float(x)) - axis.begin());
  if (after == 0) return {0, 0, 0};
  if (after == axis.size()) return {after - 1, after - 1, 0};
  return {after - 1, after, float((x - axis[after - 1]) / (double(axis[after]) - axis[after - 1]))};
}

// Value of the grid at three coordinates, linear along each.
Rgb Interpolate(const MeasuredBrdf::Axes& axes, const std::vector<float>& values,
                const std::array<double, 3>& at) {
  const Place a = Locate(axes[0], at[0]), b = Locate(axes[1], at[1]), c = Locate(axes[2], at[2]);
  const auto value = [&](size_t i, size_t j, size_t k) {
    return Rgb(Eigen::Map<const Rgb>(&values[((i * axes[1].size() + j) * axes[2].size() + k) * 3]));
  };
  const auto along_c = [&](size_t i, size_t j) -> Rgb {
    return (1 - c.fraction) * value(i, j, c.low) + c.fraction * value(i, j, c.high);
  };
  const auto along_b = [&](size_t i) -> Rgb {
    return (1 - b.fraction) * along_c(i, b.low) + b.fraction * along_c(i, b.high);
  };
  return (1 - a.fraction) * along_b(a.low) + a.fraction * along_b(a.high);
}

// Each coordinate by an arctangent of two lengths, which keeps its digits at both ends.
std::array<double, 3> HalfDifference(const Vec3d& wi, const Vec3d& wo) {
  const Vec3d sum = wi + wo, difference = wi - wo, cross = wi.cross(wo);
  const double theta_d = std::atan2(difference.norm(), sum.norm());
  // |wo_z - wi_z| = 2 sin theta_h sin theta_d cos phi_d, |cross_z| = 2 sin theta_h sin theta_d cos theta_d
  // sin phi_d.
  return {std::atan2(std::hypot(sum.x(), sum.y()), sum.z()), theta_d,
          std::atan2(std::abs(cross.z()), std::cos(theta_d) * std::abs(difference.z()))};
}

double PolarAngle(const Vec3d& w) { return std::atan2(std::hypot(w.x(), w.y()), w.z()); }

std::array<double, 3> IncidentOutgoing(const Vec3d& wi, const Vec3d& wo) {
  return {PolarAngle(wi), PolarAngle(wo),
          std::atan2(std::abs(wi.x() * wo.y() - wi.y() * wo.x()), wi.x() * wo.x() + wi.y() * wo.y())};
}

std::string Digest(MeasuredBrdf::Coordinates coordinates, const MeasuredBrdf::Axes& axes,
                   const std::vector<float>& values) {
  uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](uint32_t word) { hash = (hash ^ word) * 0x100000001b3; };
  const auto add_floats = [&](const std::vector<float>& list) {
    add(uint32_t(list.size()));
    for (const float x : list) {
      uint32_t word;
      std::memcpy(&word, &x, sizeof word);
      add(word);
    }
  };
  add(uint32_t(coordinates));
  for (const auto& axis : axes) add_floats(axis);
  add_floats(values);
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

// The half vector's angle at which f has fallen to half of its largest value for good, averaged over
// channels, for directions 0.2 rad from the half vector, at right angles to its tilt.
double HalfWidth(const MeasuredBrdf& f) {
  double most = 0, half_width = 1;
  std::vector<std::pair<double, double>> profile;
  for (double theta = 1e-4; theta < 1; theta *= 1.05) {
    const Vec3d h(std::sin(theta), 0, std::cos(theta)), side(0, std::sin(0.2), 0);
    const Vec3d up = std::cos(0.2) * h;
    profile.emplace_back(theta, f.Value(up + side, up - side).mean());
    most = std::max(most, profile.back().second);
  }
  while (most > 0 && profile.back().second <= 0.5 * most) {
    half_width = profile.back().first;
    profile.pop_back();
  }
  return half_width;
}

}  // namespace

std::string MeasuredBrdf::Problem(Coordinates coordinates, const Axes& axes,
                                  const std::vector<float>& values) {
  const bool angles = coordinates == Coordinates::kIncidentOutgoing;
  size_t count = 3;
  for (int a = 0; a < 3; ++a) {
    const auto& axis = axes[a];
    if (axis.empty()) return "axis " + std::to_string(a) + " is empty, expected at least one angle";
    const float most = float(angles && a == 2 ? kPi : kPi / 2) * (1 + 1e-6f);
    for (size_t i = 0; i < axis.size(); ++i) {
      if (!(axis[i] >= 0 && axis[i] <= most) || (i > 0 && !(axis[i] > axis[i - 1]))) {
        return "axis " + std::to_string(a) + " has " + std::to_string(axis[i]) + " rad as entry " +
               std::to_string(i) + ", expected rising angles within 0 to " + std::to_string(most) + " rad";
      }
    }
    count *= axis.size();
  }
  if (values.size() != count) {
    return std::to_string(values.size()) + " values, expected " + std::to_string(count) + " from its axes";
  }
  for (size_t i = 0; i < count; ++i) {
    if (!(values[i] >= 0 && values[i] <= kMostValue)) {
      return "value " + std::to_string(i) + " is " + std::to_string(values[i]) + ", expected 0 to 1e9 sr^-1";
    }
  }
  if (!angles) return "";
  if (axes[0] != axes[1]) return "its axes of theta_i and theta_o differ, expected equal ones";
  const size_t n = axes[0].size(), row = 3 * axes[2].size();
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < i; ++j) {
      if (!std::equal(&values[(i * n + j) * row], &values[(i * n + j) * row] + row,
                      &values[(j * n + i) * row])) {
        return "values at angles " + std::to_string(i) + " and " + std::to_string(j) +
               " change when the directions are exchanged, expected reciprocal ones";
      }
    }
  }
  return "";
}

MeasuredBrdf::MeasuredBrdf(std::string name, Coordinates coordinates, Axes axes, std::vector<float> values)
    : name_(std::move(name)), coordinates_(coordinates), axes_(std::move(axes)), values_(std::move(values)) {
  const std::string problem = Problem(coordinates_, axes_, values_);
  if (!problem.empty()) throw std::invalid_argument("MeasuredBrdf: " + problem);
  digest_ = Digest(coordinates_, axes_, values_);
  // GGX falls to half its peak at tan theta = alpha sqrt(sqrt(2) - 1).
  width_ = std::clamp(HalfWidth(*this) / 0.6436, 1e-3, 1.0);
  normal_albedo_ = Albedo(1);
}

MeasuredBrdf MeasuredBrdf::FromAngles(std::string name, const std::vector<float>& theta_i,
                                      const std::vector<float>& theta_o, const std::vector<float>& azimuth,
                                      const std::vector<float>& values) {
  std::vector<float> theta;
  std::set_union(theta_i.begin(), theta_i.end(), theta_o.begin(), theta_o.end(), std::back_inserter(theta));
  const Axes measured = {theta_i, theta_o, azimuth};
  std::vector<float> mean;
  mean.reserve(theta.size() * theta.size() * azimuth.size() * 3);
  for (const float a : theta) {
    for (const float b : theta) {
      for (const float phi : azimuth) {
        const Rgb there = Interpolate(measured, values, {a, b, phi});
        const Rgb back = Interpolate(measured, values, {b, a, phi});
        for (int c = 0; c < 3; ++c) mean.push_back(0.5f * (there[c] + back[c]));
      }
    }
  }
  return {std::move(name), Coordinates::kIncidentOutgoing, {theta, theta, azimuth}, std::move(mean)};
}

Rgb MeasuredBrdf::Value(const Vec3d& wi, const Vec3d& wo) const {
  const bool half = coordinates_ == Coordinates::kHalfDifference;
  return Interpolate(axes_, values_, half ? HalfDifference(wi, wo) : IncidentOutgoing(wi, wo));
}

HalfVectorRule MeasuredBrdf::Rule() const {
  return {.width = width_, .polar = GaussLegendre(192, 0, 1), .azimuth = GaussLegendre(128, -1, 1)};
}

Rgb MeasuredBrdf::Albedo(double cos_theta_i) const {
  const OutgoingPoints points = Rule().Points(cos_theta_i);
  const Vec3d wi(std::sqrt(std::max(0.0, 1 - cos_theta_i * cos_theta_i)), 0, cos_theta_i);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int i = 0; i < points.size(); ++i) {
    const Vec3d wo(points.x[i], points.y[i], points.z[i]);
    sum += Value(wi, wo).cast<double>() * (points.weight[i] * wo.z());
  }
  return sum.cast<float>();
}

}  // namespace lobe
