#include "brdf/reflectance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;

double Pow5(double x) { return x * x * x * x * x; }

bool AboveHorizon(const Vec3d& wi, const Vec3d& wo) { return wi.z() > 0 && wo.z() > 0; }

Rgb FresnelAtHalf(const MetallicRoughness& m, const Vec3d& wi, const Vec3d& wo) {
  return m.Fresnel(float(std::abs(wi.dot((wi + wo).normalized()))));
}

// What the coat lets through to the base and back out again.
Rgb UnderTheCoat(const MetallicRoughness& m, const Vec3d& wi, const Vec3d& wo) {
  return m.UnderCoat(FresnelAtHalf(m, wi, wo));
}

// Which part of each model is smooth ("base") and which is the coat ("gloss").
struct Base {
  const Vec3d &wi, &wo;

  Rgb operator()(const Lambert& m) const { return m.albedo / float(kPi); }
  Rgb operator()(const Phong&) const { return Rgb::Zero(); }
  Rgb operator()(const Ward&) const { return Rgb::Zero(); }
  Rgb operator()(const MetallicRoughness& m) const {
    return m.DiffuseColor() * UnderTheCoat(m, wi, wo) / float(kPi);
  }
};

struct Gloss {
  const Vec3d &wi, &wo;

  Rgb operator()(const Lambert&) const { return Rgb::Zero(); }
  Rgb operator()(const Phong& m) const {
    const double cos_mirror = wi.z() * wo.z() - wi.x() * wo.x() - wi.y() * wo.y();
    if (cos_mirror <= 0) return Rgb::Zero();
    const double n = m.exponent;
    return m.albedo * float((n + 2.0) / (2.0 * kPi) * std::pow(cos_mirror, n));
  }
  Rgb operator()(const Ward& m) const {
    // With unnormalised h = wi + wo the paper's 1 / (4 (wi.h)^2 cos^4 theta_h) is (h.h) / h_z^4, because
    // |h| = 2 wi.h/|h|; and tan^2 theta_h = (h_x^2 + h_y^2) / h_z^2.
    const Vec3d h = wi + wo;
    const double a2 = double(m.alpha) * m.alpha, hz2 = h.z() * h.z();
    const double tan2 = (h.x() * h.x() + h.y() * h.y()) / hz2;
    return m.albedo * float(std::exp(-tan2 / a2) / (kPi * a2) * h.squaredNorm() / (hz2 * hz2));
  }
  Rgb operator()(const MetallicRoughness& m) const {
    if (m.roughness < kMirrorRoughness) return Rgb::Zero();
    const double alpha = double(m.roughness) * m.roughness;
    const Vec3d h = (wi + wo).normalized();
    return m.Fresnel(float(std::abs(wi.dot(h)))) * float(GgxD(h.z(), alpha) * GgxV(wi.z(), wo.z(), alpha));
  }
};

}  // namespace

Rgb MetallicRoughness::DiffuseColor() const {
  return base_color * ((1.0f - metallic) * (1.0f - transmission) * (1.0f - diffuse_transmission));
}

Rgb MetallicRoughness::TransmissionColor() const {
  return diffuse_transmission_color * ((1.0f - metallic) * (1.0f - transmission) * diffuse_transmission);
}

Rgb MetallicRoughness::GlassColor() const { return base_color * ((1.0f - metallic) * transmission); }

Rgb MetallicRoughness::F0(float outer_ior) const {
  // Also right for KHR_materials_ior's "ior 0", which asks for f0 = 1.
  const float r = (ior - outer_ior) / (ior + outer_ior);
  const Rgb dielectric = (r * r * specular_color).min(1.0f) * specular;
  return dielectric + metallic * (base_color - dielectric);
}

float MetallicRoughness::F90() const { return specular + metallic * (1.0f - specular); }

Rgb MetallicRoughness::Fresnel(float cos_theta) const {
  const Rgb f0 = F0();
  return f0 + (F90() - f0) * float(Pow5(1.0 - cos_theta));
}

Rgb MetallicRoughness::UnderCoat(const Rgb& fresnel) const {
  return has_specular ? Rgb::Constant(1.0f - fresnel.maxCoeff()) : Rgb(1.0f - fresnel);
}

Rgb EvaluateBase(const Reflectance& r, const Vec3d& wi, const Vec3d& wo) {
  return AboveHorizon(wi, wo) ? std::visit(Base{wi, wo}, r) : Rgb::Zero();
}

Rgb EvaluateGloss(const Reflectance& r, const Vec3d& wi, const Vec3d& wo) {
  return AboveHorizon(wi, wo) ? std::visit(Gloss{wi, wo}, r) : Rgb::Zero();
}

Rgb EvaluateTransmission(const Reflectance& r, const Vec3d& wi, const Vec3d& wo) {
  const auto* m = std::get_if<MetallicRoughness>(&r);
  const Vec3d mirrored(wo.x(), wo.y(), -wo.z());
  if (!m || !AboveHorizon(wi, mirrored)) return Rgb::Zero();
  return m->TransmissionColor() * UnderTheCoat(*m, wi, mirrored) / float(kPi);
}

bool Transmits(const Reflectance& r) {
  const auto* m = std::get_if<MetallicRoughness>(&r);
  if (!m) return false;
  // F0 <= F90, so that a coat that reflects everything at normal incidence does so at every angle.
  return (m->TransmissionColor() * m->UnderCoat(m->F0()) > 0).any();
}

bool IsGlass(const Reflectance& r) {
  const auto* m = std::get_if<MetallicRoughness>(&r);
  return m && m->roughness < kMirrorRoughness && (m->GlassColor() * m->UnderCoat(m->F0()) > 0).any();
}

Rgb NormalAlbedo(const Reflectance& r) {
  if (const auto* m = std::get_if<MetallicRoughness>(&r)) {
    return m->F0() + m->UnderCoat(m->F0()) * m->DiffuseColor();
  }
  return std::visit(
      [](const auto& model) {
        if constexpr (requires { model.albedo; }) return model.albedo;
        return Rgb(Rgb::Zero());  // unreachable: metallic-roughness came first
      },
      r);
}

double GgxD(double cos_h, double alpha) {
  if (cos_h <= 0) return 0;
  const double a2 = alpha * alpha;
  // sin^2 + a^2 cos^2, rather than cos^2 (a^2 - 1) + 1, which cancels for small alpha.
  const double s = (1.0 - cos_h) * (1.0 + cos_h) + a2 * cos_h * cos_h;
  return a2 / (kPi * s * s);
}

double GgxV(double cos_i, double cos_o, double alpha) {
  if (cos_i <= 0 || cos_o <= 0) return 0;
  const double a2 = alpha * alpha;
  const double shadowed = cos_i * std::sqrt(a2 + (1.0 - a2) * cos_o * cos_o);
  const double masked = cos_o * std::sqrt(a2 + (1.0 - a2) * cos_i * cos_i);
  return 0.5 / (shadowed + masked);
}

std::string Describe(const Reflectance& r) {
  std::ostringstream words;
  if (std::holds_alternative<Lambert>(r)) {
    words << "lambert";
  } else if (const auto* phong = std::get_if<Phong>(&r)) {
    words << "phong exponent " << phong->exponent;
  } else if (const auto* ward = std::get_if<Ward>(&r)) {
    words << "ward alpha " << ward->alpha;
  } else {
    const auto& m = std::get<MetallicRoughness>(r);
    words << "ggx roughness " << m.roughness;
    if (m.metallic < 1) words << " metallic " << m.metallic;
    if (IsGlass(r)) words << (m.thickness > 0 ? " glass ior " : " pane ior ") << m.ior;
  }
  return words.str();
}

}  // namespace lobe
