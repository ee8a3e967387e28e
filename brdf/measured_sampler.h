#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "brdf/measured.h"

namespace lobe {

/// Draws directions in proportion to about f cos of a measured reflectance, with the exact density.
///
/// For each of kAngles ranges of theta_o half vectors have a density that is constant over each of kPolar x
/// kAzimuth cells: rings whose edges crowd at the normal as MERL's do, in sectors counted from wo's azimuth,
/// alike on both sides. A tenth of the directions is drawn by the cosine alone, so that no direction the
/// cells misjudge carries much weight.
///
/// The cells cost some hundred thousand values of f, so they are made when something is first drawn: pictures
/// of stored light draw nothing.
class MeasuredSampler {
 public:
  explicit MeasuredSampler(std::shared_ptr<const MeasuredBrdf> data) : data_(std::move(data)) {}

  /// u1, u2, u3 uniform in [0, 1). May lie below the horizon.
  Vec3 Sample(const Vec3& wo, float u1, float u2, float u3) const;
  /// Per steradian, of Sample; wo and wi above the horizon.
  float Pdf(const Vec3& wo, const Vec3& wi) const;
  Rgb Value(const Vec3& wo, const Vec3& wi) const {
    return data_->Value(wi.cast<double>(), wo.cast<double>());
  }

 private:
  static constexpr int kAngles = 96, kPolar = 64, kAzimuth = 16;
  static constexpr float kCosineShare = 0.1f;

  static int AngleRange(float cos_o);

  void Tabulate() const;  // once, whichever thread comes first

  std::shared_ptr<const MeasuredBrdf> data_;
  mutable std::once_flag tabulated_;
  // Per range of theta_o: running sums of the rings' chances, of the sectors' within each ring, and each
  // cell's density per steradian of half vectors.
  mutable std::vector<float> ring_sum_, sector_sum_, density_;
};

}  // namespace lobe
