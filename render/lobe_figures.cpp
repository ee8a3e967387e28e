#include "render/lobe_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/lobe.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3d Direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Climbs from a grid point by steps that halve whenever no neighbour is higher, down to 1e-5 radians.
/// Steps are taken in the disc (x, y), where nothing is singular at the pole.
Vec3d Climb(const LobeReader& lobe, Vec3d best, double step) {
  double highest = lobe.Luminance(best);
  while (step > 1e-5) {
    bool moved = false;
    for (int k = 0; k < 8; ++k) {
      Eigen::Vector2d p =
          best.head<2>() + step * Eigen::Vector2d(std::cos(k * kPi / 4), std::sin(k * kPi / 4));
      if (p.squaredNorm() > 1) p.normalize();
      const Vec3d w(p.x(), p.y(), std::sqrt(std::max(0.0, 1 - p.squaredNorm())));
      const double value = lobe.Luminance(w);
      if (value > highest + 1e-12 * std::abs(highest)) {
        highest = value;
        best = w;
        moved = true;
      }
    }
    if (!moved) step /= 2;
  }
  return best;
}

}  // namespace

LobeReader::LobeReader(const Eigen::MatrixXd& coefficients)
    : basis_(DegreeOf(static_cast<int>(coefficients.rows()))),
      coefficients_(coefficients),
      values_(coefficients.rows()) {
  if (coefficients.cols() != 3) throw std::invalid_argument("LobeReader: a lobe has three columns");
  luminance_ = coefficients * Eigen::Vector3d(0.2126, 0.7152, 0.0722);  // ITU-R BT.709-6, item 3.2
}

Eigen::Array3d LobeReader::Radiance(const Vec3d& w) const {
  basis_.Evaluate(w.x(), w.y(), w.z(), values_.data());
  return (coefficients_.transpose() * values_).array();
}

double LobeReader::Luminance(const Vec3d& w) const {
  basis_.Evaluate(w.x(), w.y(), w.z(), values_.data());
  return luminance_.dot(values_);
}

double LobeFigures::peak_theta_degrees() const {
  return std::atan2(peak_direction.head<2>().norm(), peak_direction.z()) * 180 / kPi;
}

double LobeFigures::peak_phi_degrees() const {
  if (peak_direction.head<2>().norm() < 1e-9) return 0;
  const double phi = std::atan2(peak_direction.y(), peak_direction.x()) * 180 / kPi;
  return phi < 0 ? phi + 360 : phi;
}

LobeFigures MeasureLobe(const Eigen::MatrixXd& coefficients) {
  const LobeReader lobe(coefficients);
  // Four points per oscillation of the highest degree, and never a coarse picture.
  const int rings = std::max(48, 4 * lobe.l_max()), azimuths = 2 * rings;

  double negative = 0, magnitude = 0;
  Vec3d best(0, 0, 1);
  double highest = lobe.Luminance(best);
  for (int i = 0; i < rings; ++i) {
    const double theta = std::acos((i + 0.5) / rings);  // equal steps in z: equal solid angles
    for (int j = 0; j < azimuths; ++j) {
      const Vec3d w = Direction(theta, 2 * kPi * (j + 0.5) / azimuths);
      const double value = lobe.Luminance(w);
      negative += std::max(0.0, -value);
      magnitude += std::abs(value);
      // Rounding must not decide where a constant lobe has its peak.
      if (value > highest + 1e-12 * std::abs(highest)) {
        highest = value;
        best = w;
      }
    }
  }

  LobeFigures figures;
  figures.flux = LobeFlux(coefficients).transpose().cast<float>().array();
  figures.peak_direction = Climb(lobe, best, 1.0 / rings);
  figures.peak = lobe.Luminance(figures.peak_direction);
  figures.peak_radiance = lobe.Radiance(figures.peak_direction).cast<float>();
  figures.negative_fraction = magnitude > 0 ? negative / magnitude : 0;
  return figures;
}

}  // namespace lobe
