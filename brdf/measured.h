#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "brdf/hemisphere_integral.h"
#include "brdf/rgb.h"
#include "sh/vector.h"

namespace lobe {

/// An isotropic reflectance known at the points of a grid and linear in between along each axis; beyond an
/// axis' first and last point the value there is kept. Reciprocal and symmetric to the plane of incidence by
/// construction. What was measured is taken as it is: if it reflects more than it gets, so does this.
class MeasuredBrdf {
 public:
  enum class Coordinates {
    /// Rusinkiewicz, "A New Change of Variables for Efficient BRDF Representation", EGWR 1998: angle of the
    /// half vector to the normal, of either direction to the half vector, and azimuth of the latter about the
    /// half vector, folded by both symmetries. All 0..pi/2.
    kHalfDifference,
    /// theta_i and theta_o, 0..pi/2, and the azimuth between them, 0..pi. Both thetas share one axis, and
    /// exchanging them changes nothing.
    kIncidentOutgoing,
  };
  static constexpr float kMostValue = 1e9f;  ///< sr^-1; brighter peaks are mistakes, and their sums overflow
  using Axes = std::array<std::vector<float>, 3>;  ///< radians, rising

  /// One sentence about what the constructor would not take, or "".
  static std::string Problem(Coordinates coordinates, const Axes& axes, const std::vector<float>& values);

  /// `values`: sr^-1, at [((a * axes[1].size() + b) * axes[2].size() + c) * 3 + channel]. Throws
  /// std::invalid_argument with Problem's sentence. `name` is for people.
  MeasuredBrdf(std::string name, Coordinates coordinates, Axes axes, std::vector<float> values);

  /// From theta_i, theta_o and azimuths measured independently: the mean of f and f with the directions
  /// exchanged, on the union of both axes, which holds it exactly. `values` as above.
  static MeasuredBrdf FromAngles(std::string name, const std::vector<float>& theta_i,
                                 const std::vector<float>& theta_o, const std::vector<float>& azimuth,
                                 const std::vector<float>& values);

  /// f_r for directions above the horizon.
  Rgb Value(const Vec3d& wi, const Vec3d& wo) const;

  const std::string& name() const { return name_; }
  Coordinates coordinates() const { return coordinates_; }
  const Axes& axes() const { return axes_; }
  const std::vector<float>& values() const { return values_; }
  /// Equal content, equal digest (64 bits, FNV-1a); the name does not count.
  const std::string& digest() const { return digest_; }

  /// Half the full width at half maximum over half vectors, as the alpha of a GGX of that width; 1 at most.
  double Width() const { return width_; }
  /// Points that resolve grids as fine as MERL's.
  HalfVectorRule Rule() const;
  Rgb NormalAlbedo() const { return normal_albedo_; }  ///< directional albedo at normal incidence
  Rgb Albedo(double cos_theta_i) const;                ///< by Rule: tens of thousands of values

 private:
  std::string name_, digest_;
  Coordinates coordinates_;
  Axes axes_;
  std::vector<float> values_;
  double width_ = 1;
  Rgb normal_albedo_ = Rgb::Zero();
};

/// As an alternative of Reflectance: shared, so that materials stay cheap to copy.
struct Measured {
  std::shared_ptr<const MeasuredBrdf> data;  ///< never null
};

}  // namespace lobe
