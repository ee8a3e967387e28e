#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "sh/quadrature.h"

namespace lobe {

/// Why Zernike: on the hemisphere the measure cos(theta) d omega is the area dx dy of the unit disc,
/// and the even basis H of degree l spans the polynomials of degree l in (x, y). So the
/// cos-weighted orthonormal basis nested by degree is that of the Zernike polynomials Z_n^m (Born
/// and Wolf, Principles of Optics, section 9.2), and
///  - cos-weighted least squares onto H of degree l_max is a Zernike expansion cut at n = l_max;
///  - lowering the degree of a lobe without changing its flux is dropping the tail of that expansion;
///  - flux is its first coefficient alone.
/// Same index as H: CoefficientIndex(n, m).

/// Radial parts: out[j] = R_n^m(rho), n = m + 2 j, for n <= n_max, scaled so that
/// R_n^|m|(rho) {cos, sin}(m phi) is orthonormal over the disc. `out` holds (n_max - m) / 2 + 1.
/// Recurrence of the Jacobi polynomials P^(0,m) (DLMF 18.9.2); stable in double to n = 1000.
void ZernikeRadial(int m, int n_max, double rho, double* out);

/// One step of that recurrence, before scaling: R_{m+2(j+1)} = (a (2 rho^2 - 1) + b) R_{m+2j} - c
/// R_{m+2(j-1)}.
struct ZernikeStep {
  double a, b, c;
  ZernikeStep(int m, int j);
};
/// The scale that makes R_n^m {cos, sin}(m phi) orthonormal.
double ZernikeScale(int n, int m);

/// Linear maps between coefficients over H and over Z for one degree cap. They split by |m|; block m
/// is triangular, (l_max - m) / 2 + 1 square.
class ZernikeTransform {
 public:
  explicit ZernikeTransform(int l_max);
  int l_max() const { return l_max_; }

  /// Columns are lobes (colour channels), rows coefficients, CoefficientCount(l_max) of them.
  Eigen::MatrixXd ToZernike(const Eigen::Ref<const Eigen::MatrixXd>& h) const;
  Eigen::MatrixXd ToHemisphere(const Eigen::Ref<const Eigen::MatrixXd>& z) const;

  /// Block of order m: h_l = sum_n block(l', n') z_n, l = m + 2 l', n = m + 2 n'.
  const Eigen::MatrixXd& ToHemisphereBlock(int m) const { return to_h_[m]; }
  const Eigen::MatrixXd& ToZernikeBlock(int m) const { return to_z_[m]; }

 private:
  int l_max_;
  std::vector<Eigen::MatrixXd> to_h_, to_z_;
};

/// Cos-weighted least-squares projection of `f(w)`, w over the upper hemisphere, onto H of degree
/// l_max. `quadrature_degree`: products of f with basis functions are integrated as if f had this
/// degree; exact if it has. Keeps the integral of f cos(theta).
Eigen::VectorXd ProjectCosineWeighted(const std::function<double(const Vec3d&)>& f, int l_max,
                                      int quadrature_degree);

}  // namespace lobe
