#pragma once

#include <vector>

#include <Eigen/Core>

#include "brdf/material_lobes.h"

namespace lobe {

/// How well the lobes of a material stand for its BRDF, measured from outside: what IncidentMoments makes of
/// light from one direction against the model's own value, integrated afresh at that angle. All of the
/// luminance of the channels.

enum class BrdfPart { kBase, kGloss, kWhole };
/// The part whose lobes a material is judged by: its gloss, or its base if it has none.
inline BrdfPart JudgedPart(const MaterialLobes& lobes) {
  return lobes.gloss.l_max >= 0 ? BrdfPart::kGloss : BrdfPart::kBase;
}

/// A BRDF at one incident angle, azimuth 0: its exact projection up to a high degree.
struct ExactLobe {
  double albedo = 0;
  double norm2 = 0;         ///< integral of f^2 cos
  Eigen::VectorXd zernike;  ///< over Z (sh/zernike.h), index as of H; sines are 0
};
ExactLobe ProjectExactly(const Reflectance& r, BrdfPart part, double cos_theta_i, int l_max);

/// Coefficients over H, up to the part's degree, of the lobe that light of irradiance 1 from azimuth 0
/// leaves.
Eigen::VectorXd LobeAt(const MaterialLobes& lobes, BrdfPart part, double cos_theta_i);

/// Flux of the negative part of a lobe, a positive number.
double NegativeFlux(const Eigen::VectorXd& lobe);

struct AngleAccuracy {
  double cos_theta_i = 1;
  double albedo = 0, lobe_albedo = 0;
  /// Relative cos-weighted L2, as LobeError: of the lobe as it is read, of the exact projection onto its
  /// degree, and between both.
  LobeError error;
  double negative = 0;  ///< NegativeFlux over albedo
};
AngleAccuracy Compare(const ExactLobe& exact, const Eigen::VectorXd& lobe, double cos_theta_i);

struct LobeAccuracy {
  LobeError error;          ///< averaged over theta_i by flux
  double worst = 0;         ///< largest total error at any of the angles, up to 85 degrees
  double worst_theta = 0;   ///< where; radians
  double negative = 0;      ///< averaged as the error
  double albedo_error = 0;  ///< largest difference of albedos, up to 85 degrees
};

/// The same BRDF compared again and again, with lobes of several degrees.
class AccuracyMeter {
 public:
  /// Projects at kAngles angles, in parallel.
  AccuracyMeter(const Reflectance& r, BrdfPart part);

  LobeAccuracy Measure(const MaterialLobes& lobes) const;
  static constexpr int kMostDegree = 32;

 private:
  /// Gauss-Legendre in the spline's parameter t, where lobes are smooth.
  static constexpr int kAngles = 24;
  BrdfPart part_;
  std::vector<double> cosine_, weight_;  ///< weight: flux
  std::vector<ExactLobe> exact_;
};

/// Flux of the negative part over the flux, averaged by flux over a few angles: quick, within some percent of
/// LobeAccuracy::negative.
double NegativePart(const MaterialLobes& lobes, BrdfPart part);

}  // namespace lobe
