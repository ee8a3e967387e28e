#pragma once

#include "render/camera_view.h"
#include "sh/lanes.h"

namespace lobe {

/// A few directions of a tile of a pinhole's film between which the radiance of one node may be interpolated:
/// n x n Chebyshev points, n <= 4, so that kLanes hold all of them.
///
/// Along a straight line of the film the direction runs along a great circle, and there a lobe of degree l is
/// a trigonometric polynomial of degree l: its k-th derivative by the angle is at most l^k times its size
/// (largest absolute value over all directions; Bernstein). The k-th derivative of the angle by the place on
/// the line is at most (k - 1)! / r^k, r the distance from the eye. By Faà di Bruno, with a the line's
/// half-length and rho = a / r, the n-th derivative over [-1, 1] is at most rho^n l (l + 1) ... (l + n - 1)
/// times the size; so interpolation along the line errs by at most
///   e_n = 2 (rho / 2)^n l (l + 1) ... (l + n - 1) / n!,
/// and in both coordinates by (1 + Λ_n) e_n, Λ_n the Lebesgue constant of n Chebyshev points. That holds
/// for any field of view. *FilmGridTest.*
class FilmGrid {
 public:
  static constexpr int kMaxPoints = 4;  ///< along an axis
  /// Of the lobe's size; chosen: a tenth of the error of a converged picture (docs/validation.md).
  static constexpr double kTolerance = 1e-3;

  /// Largest error of n x n points, as a fraction of the lobe's size.
  static double Bound(int l, double rho, int n);
  /// Fewest points along an axis that keep a lobe of degree l within kTolerance; 0: kMaxPoints do not.
  static int Points(int l, double rho);
  /// Half the longer side of the film's rectangle [x0, x1] x [y0, y1], in pixels, over its least distance.
  static double Rho(const CameraView::Film& film, float x0, float y0, float x1, float y1);

  void Start(const CameraView::Film& film, float x0, float y0, float x1, float y1);

  double rho() const { return rho_; }
  /// Directions towards the eye, unit: point (i, j) at i + j * n; lanes beyond repeat the last.
  struct Directions {
    alignas(64) float x[kLanes], y[kLanes], z[kLanes];
  };
  const Directions& directions(int n) const { return directions_[n - 1]; }
  /// Do all directions of the rectangle, towards the eye, lie above this horizon?
  bool Above(const Vec3& normal) const;

  /// Place of film positions in [-1, 1]²: (x - centre) * scale.
  float centre_x() const { return centre_[0]; }
  float centre_y() const { return centre_[1]; }
  float scale_x() const { return scale_[0]; }
  float scale_y() const { return scale_[1]; }

 private:
  float centre_[2], scale_[2];
  double rho_ = 0;
  Vec3 corners_[4];
  Directions directions_[kMaxPoints];
};

/// Chebyshev point i of n in (-1, 1).
double ChebyshevPoint(int i, int n);

}  // namespace lobe
