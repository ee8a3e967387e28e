#pragma once

#include <Eigen/Core>

#include "brdf/rgb.h"
#include "sh/hemisphere_basis.h"

namespace lobe {

/// Reads one lobe in directions. `coefficients`: rows over the hemisphere basis, 3 columns (Rec. 709),
/// local frame; throws std::invalid_argument if no degree has that many rows.
/// Scratch is inside: one reader per thread.
class LobeReader {
 public:
  explicit LobeReader(const Eigen::MatrixXd& coefficients);

  int l_max() const { return basis_.l_max(); }
  /// `w_local`: unit, on the upper hemisphere. May be negative where a cut-off lobe rings.
  Eigen::Array3d Radiance(const Vec3d& w_local) const;
  double Luminance(const Vec3d& w_local) const;

 private:
  HemisphereBasis<double> basis_;
  Eigen::MatrixXd coefficients_;
  Eigen::VectorXd luminance_;
  mutable Eigen::VectorXd values_;
};

/// What `lobe inspect` says about a lobe.
struct LobeFigures {
  Rgb flux = Rgb::Zero();           ///< integral of L cos over the hemisphere, W m^-2
  Vec3d peak_direction{0, 0, 1};    ///< local, unit: where luminance is greatest
  double peak = 0;                  ///< luminance there, W m^-2 sr^-1
  Rgb peak_radiance = Rgb::Zero();  ///< radiance there
  /// Integral of the negative part of luminance over that of its magnitude, d omega on the hemisphere;
  /// by a midpoint rule good to about 1e-3. 0 for a black lobe.
  double negative_fraction = 0;

  double peak_theta_degrees() const;
  double peak_phi_degrees() const;  ///< 0..360; 0 at the pole
};
LobeFigures MeasureLobe(const Eigen::MatrixXd& coefficients);

}  // namespace lobe
