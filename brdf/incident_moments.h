#pragma once

#include <map>
#include <utility>
#include <vector>

#include "brdf/material_lobes.h"
#include "brdf/ring_transform.h"

namespace lobe {

/// Accumulates light arriving at one point and turns it into the light leaving.
///
/// The outgoing coefficients are linear in (spline weight of theta_i) x (cos, sin of m phi_i). So
/// arriving light is summed first over that small product space, bins x (2 l_max + 1) x channels,
/// and multiplied by the material's table once, at the end. One contribution costs
/// 4 (2 l_max + 1) multiply-adds a channel instead of 2 (l_max+1)(l_max+2) or so, whatever the
/// number of knots, and base and gloss share it.
///
/// Any number of contributions may come: sums are kept in double from some hundred on, and in float before,
/// so that a million lose no more than one does (docs/validation.md#extremes).
class IncidentMoments {
 public:
  IncidentMoments() = default;
  /// Prepares for a material and clears. Buffers are kept from use to use.
  void Start(const MaterialLobes& material);

  /// `irradiance` (W m^-2, cosine included) arriving from `wi_local`, unit, above the horizon.
  void Add(const Vec3& wi_local, const Rgb& irradiance);

  /// A ring of arriving light at once: irradiance from `count` azimuths phi0 + 2 pi j / count at one polar
  /// angle, as three planes (red, green, blue) of `count`. Equals `count` calls of Add to rounding, at a
  /// fraction of their cost (docs/validation.md#accumulation). The first ring of each count builds a table.
  void AddRing(float cos_theta_i, const float* irradiance_planes, int count, float phi0);

  /// Adds the outgoing lobes: base[c * base.count() + k], gloss[c * gloss.count() + k].
  void Finish(float* base, float* gloss);

 private:
  void AddSpectrum(float cos_theta_i, const Rgb& irradiance);
  void FinishPart(const PartLobes& part, const Eigen::Array3d& rest, const float* moments, float* out);
  void Settle();  // moves the sums so far to double

  // A sum of so many floats is off by at most so many roundings, 256 * 6e-8 = 1.5e-5. (chosen: settling costs
  // about as much as thirty contributions)
  static constexpr int kSettleAfter = 256;

  const MaterialLobes* material_ = nullptr;
  int l_max_ = -1, stride_ = 0;
  int first_bin_ = 0, last_bin_ = -1;  // those touched since Start
  size_t bin_size_ = 0;                // floats of a bin, padded to whole lanes
  std::vector<float> moments_;         // [bin][channel][cos 0..l_max, sin 0..l_max]
  int unsettled_ = 0;                  // contributions in moments_
  bool any_settled_ = false;
  std::vector<double> settled_;            // as moments_
  std::vector<float> settled_sum_;         // for Finish
  Eigen::Array3d rest_base_, rest_gloss_;  // irradiance x what the spline's flux lacks
  std::vector<float> azimuth_;             // cos m phi, then sin m phi
  std::vector<float> spectrum_;            // arriving light, [channel][cos, sin], and room for whole lanes
  std::vector<float> product_, folded_;
  std::map<std::pair<int, int>, RingTransform> rings_;  // by count and degree
};

}  // namespace lobe
