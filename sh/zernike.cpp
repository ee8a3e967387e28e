#include "sh/zernike.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sh/hemisphere_basis.h"

namespace lobe {

ZernikeStep::ZernikeStep(int m, int j) {
  if (j == 0) {
    // The general form is 0/0 at j = 0, m = 0.
    a = 0.5 * m + 1.0;
    b = -0.5 * m;
    c = 0.0;
    return;
  }
  const double s = 2.0 * j + m, d = 2.0 * (j + 1.0) * (j + m + 1.0);
  a = (s + 1.0) * (s + 2.0) / d;
  b = -double(m) * m * (s + 1.0) / (d * s);
  c = 2.0 * j * (j + m) * (s + 2.0) / (d * s);
}

double ZernikeScale(int n, int m) { return std::sqrt((m == 0 ? 1.0 : 2.0) * (n + 1) / std::numbers::pi); }

void ZernikeRadial(int m, int n_max, double rho, double* out) {
  const double x = 2.0 * rho * rho - 1.0;
  double before = 0, p = std::pow(rho, m);
  for (int n = m, j = 0; n <= n_max; n += 2, ++j) {
    out[j] = ZernikeScale(n, m) * p;
    const ZernikeStep step(m, j);
    const double next = (step.a * x + step.b) * p - step.c * before;
    before = p;
    p = next;
  }
}

ZernikeTransform::ZernikeTransform(int l_max) : l_max_(l_max), to_h_(l_max + 1), to_z_(l_max + 1) {
  const HemisphereBasis<double> basis(l_max);
  // H Z and H Z cos are polynomials in z of degree at most 2 l_max + 1 after the azimuth is integrated.
  const GaussLegendre rule(l_max + 1, 0.0, 1.0);
  for (int m = 0; m <= l_max; ++m) {
    const int size = (l_max - m) / 2 + 1;
    to_h_[m] = Eigen::MatrixXd::Zero(size, size);
    to_z_[m] = Eigen::MatrixXd::Zero(size, size);
  }
  Eigen::VectorXd h(basis.size()), radial(l_max / 2 + 1);
  for (size_t i = 0; i < rule.nodes.size(); ++i) {
    const double z = rule.nodes[i], rho = std::sqrt(1.0 - z * z);
    basis.Evaluate(rho, 0.0, z, h.data());  // azimuth 0: the cosine terms alone
    for (int m = 0; m <= l_max; ++m) {
      ZernikeRadial(m, l_max, rho, radial.data());
      const int size = (l_max - m) / 2 + 1;
      const double w = rule.weights[i] * (m == 0 ? 2.0 : 1.0) * std::numbers::pi;
      for (int l = 0; l < size; ++l) {
        const double hl = w * h[CoefficientIndex(m + 2 * l, m)];
        for (int n = 0; n <= l; ++n) {  // what lies past the diagonal is zero by degree
          to_z_[m](n, l) += hl * radial[n] * z;
        }
        for (int n = l; n < size; ++n) to_h_[m](l, n) += hl * radial[n];
      }
    }
  }
}

namespace {

Eigen::MatrixXd ApplyBlocks(const std::vector<Eigen::MatrixXd>& blocks, int l_max,
                            const Eigen::Ref<const Eigen::MatrixXd>& in) {
  if (in.rows() != CoefficientCount(l_max)) {
    throw std::invalid_argument("ZernikeTransform: " + std::to_string(in.rows()) + " coefficients given, " +
                                std::to_string(CoefficientCount(l_max)) + " expected");
  }
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(in.rows(), in.cols());
  for (int order = -l_max; order <= l_max; ++order) {
    const int m = std::abs(order), size = (l_max - m) / 2 + 1;
    for (int i = 0; i < size; ++i) {
      for (int j = i; j < size; ++j) {
        out.row(CoefficientIndex(m + 2 * i, order)) +=
            blocks[m](i, j) * in.row(CoefficientIndex(m + 2 * j, order));
      }
    }
  }
  return out;
}

}  // namespace

Eigen::MatrixXd ZernikeTransform::ToZernike(const Eigen::Ref<const Eigen::MatrixXd>& h) const {
  return ApplyBlocks(to_z_, l_max_, h);
}

Eigen::MatrixXd ZernikeTransform::ToHemisphere(const Eigen::Ref<const Eigen::MatrixXd>& z) const {
  return ApplyBlocks(to_h_, l_max_, z);
}

Eigen::VectorXd ProjectCosineWeighted(const std::function<double(const Vec3d&)>& f, int l_max,
                                      int quadrature_degree) {
  // f Z cos: degree quadrature_degree + l_max + 1 in z, quadrature_degree + l_max in azimuth.
  const HemisphereQuadrature rule((quadrature_degree + l_max + 2) / 2);
  Eigen::VectorXd z = Eigen::VectorXd::Zero(CoefficientCount(l_max));
  std::vector<double> radial(l_max / 2 + 1);
  for (size_t i = 0; i < rule.weights.size(); ++i) {
    const Vec3d& w = rule.directions[i];
    const double value = f(w) * rule.weights[i] * w.z();
    const double phi = std::atan2(w.y(), w.x());
    const double rho = std::hypot(w.x(), w.y());
    for (int m = 0; m <= l_max; ++m) {
      ZernikeRadial(m, l_max, rho, radial.data());
      const double c = value * std::cos(m * phi), s = value * std::sin(m * phi);
      for (int n = m; n <= l_max; n += 2) {
        z[CoefficientIndex(n, m)] += c * radial[(n - m) / 2];
        if (m > 0) z[CoefficientIndex(n, -m)] += s * radial[(n - m) / 2];
      }
    }
  }
  return ZernikeTransform(l_max).ToHemisphere(z);
}

}  // namespace lobe
