#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "brdf/hemisphere_integral.h"
#include "brdf/incidence_spline.h"
#include "brdf/rgb.h"

namespace lobe {

/// Place of an incident angle on the fine grid of ScalarTable: kFine equal steps in the spline's parameter t.
struct FineAngle {
  static constexpr int kFine = 256;
  int index;
  float fraction;

  explicit FineAngle(float cos_theta_i) {
    const float s = IncidenceSpline::ParameterOfCosine(std::clamp(cos_theta_i, 0.0f, 1.0f)) * float(kFine);
    index = std::min(int(s), kFine - 1);
    fraction = s - float(index);
  }
  /// Linear interpolation in kFine + 1 values.
  float Read(const std::vector<float>& values) const {
    return (1 - fraction) * values[index] + fraction * values[index + 1];
  }
};

/// A scalar reflectance f(wi, wo) in sr^-1, local frame, without the cosine.
using ScalarBrdf = std::function<double(const Vec3d& wi, const Vec3d& wo)>;
/// Three at once, for data whose channels go different ways.
using RgbBrdf = std::function<Rgb(const Vec3d& wi, const Vec3d& wo)>;

/// f projected into lobes: for each incident angle the cos-weighted least-squares fit of f over wo
/// (docs/conventions.md#projection). Isotropy leaves only cos(m phi) terms at incident azimuth 0.
///
/// Kept over Zernike polynomials, in which a lower degree is a prefix and the flux is one number, so
/// one table at a high degree answers "what would l_max cost" for every degree at once; and at more angles
/// than lobes are read with, so that it answers the same for the knots (brdf/knot_choice.h).
struct ScalarTable {
  int l_max = 0;
  int knots = 0;
  /// Row (n, m) at index RowIndex(n, m), m >= 0 only; column per knot.
  Eigen::MatrixXd zernike;
  /// Squared cos-weighted norm of f(theta_i; .) at the knots, integral of f^2 cos.
  Eigen::VectorXd norm2;
  /// Directional albedo on a fine grid: kFine + 1 equal steps in the spline's parameter t.
  static constexpr int kFine = FineAngle::kFine;
  Eigen::VectorXd albedo;

  static int RowCount(int l_max) { return (l_max / 2 + 1) * ((l_max + 1) / 2 + 1); }
  static int RowIndex(int n, int m);  ///< n - m even, 0 <= m <= n

  /// Flux-weighted relative L2 error of cutting at degree `l`: for each theta_i
  /// ||f - f^|| / ||f|| (cos-weighted over wo), averaged with weight albedo cos sin.
  double Error(int l) const;

  /// Weight of knot j in averages over theta_i: albedo cos sin d theta.
  double FluxWeight(int j) const;

  /// The table of `factor` f.
  ScalarTable Scaled(double factor) const;

  /// Builds at degree l_max with `knots` knots (0: DefaultKnots). `rule.width` must suit f.
  static ScalarTable Build(const ScalarBrdf& f, int l_max, const HalfVectorRule& rule, int knots = 0);
  /// One table a channel; f is asked once for all.
  static std::vector<ScalarTable> BuildChannels(const RgbBrdf& f, int l_max, const HalfVectorRule& rule,
                                                int knots = 0);
  /// A third more than lobes of that degree need for an error of 1 % between knots, however sharp what they
  /// stand for (docs/validation.md#knots).
  static int DefaultKnots(int l_max) { return 9 + l_max; }
};

/// What Schlick's Fresnel term a + b (1 - V.H)^5 makes of a reflectance f: both parts, over the same points.
struct SchlickTables {
  ScalarTable plain, rising;  ///< f and f (1 - V.H)^5
  Eigen::VectorXd inner;      ///< their cos-weighted inner product at the knots

  /// As ScalarTable::Build.
  static SchlickTables Build(const ScalarBrdf& f, int l_max, const HalfVectorRule& rule, int knots = 0);
  /// The table of f (a + b (1 - V.H)^5).
  ScalarTable Mix(double a, double b) const;
};

}  // namespace lobe
