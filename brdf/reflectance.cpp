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
  Rgb operator()(const BlinnPhong&) const { return Rgb::Zero(); }
  Rgb operator()(const CookTorrance&) const { return Rgb::Zero(); }
  Rgb operator()(const OrenNayar& m) const {
    const double sigma = m.sigma;
    return m.albedo * float(OrenNayar::White<double>(wi, wo, OrenNayar::A(sigma), OrenNayar::B(sigma)));
  }
  Rgb operator()(const AshikhminShirley& m) const {
    return m.diffuse * (1 - m.specular) * float(AshikhminShirley::WhiteBase(wi.z(), wo.z()));
  }
  Rgb operator()(const Plastic& m) const {
    return m.BaseScale() * (m.Through(float(wi.z())) * m.Through(float(wo.z())));
  }
  Rgb operator()(const Measured&) const { return Rgb::Zero(); }
};

// f0 + (1 - f0) rise.
Rgb Schlick(const Rgb& f0, double cos_d) { return f0 + (1 - f0) * float(SchlickRise(cos_d)); }

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
  Rgb operator()(const BlinnPhong& m) const {
    return m.albedo * float(BlinnPhong::White(HalfAngles<double>(wi, wo), double(m.exponent)));
  }
  Rgb operator()(const CookTorrance& m) const {
    const HalfAngles<double> h(wi, wo);
    return Schlick(m.f0, h.cos_d) * float(CookTorrance::White(h, wi.z(), wo.z(), double(m.alpha)));
  }
  Rgb operator()(const OrenNayar&) const { return Rgb::Zero(); }
  Rgb operator()(const AshikhminShirley& m) const {
    const HalfAngles<double> h(wi, wo);
    const double white = AshikhminShirley::WhiteGloss(h, wi.z(), wo.z(), double(m.exponent));
    return Schlick(m.specular, h.cos_d) * float(white);
  }
  Rgb operator()(const Plastic& m) const {
    const double alpha = double(m.roughness()) * m.roughness();
    const HalfAngles<double> h(wi, wo);
    return Schlick(Rgb::Constant(m.F0()), h.cos_d) *
           float(GgxD(h.cos_h(), alpha) * GgxV(wi.z(), wo.z(), alpha));
  }
  Rgb operator()(const Measured& m) const { return m.data->Value(wi, wo); }
};

struct Normal {
  template <typename Model>
  Rgb operator()(const Model& m) const {
    return m.albedo;
  }
  Rgb operator()(const MetallicRoughness& m) const { return m.F0() + m.UnderCoat(m.F0()) * m.DiffuseColor(); }
  Rgb operator()(const CookTorrance& m) const { return m.f0; }
  Rgb operator()(const AshikhminShirley& m) const {
    return m.specular + m.diffuse * (1 - m.specular) * AshikhminShirley::BaseFactor(1.0f);
  }
  // The smooth coat's f0, and the base of a smooth coat: T (1 - R_in) rho / (1 - rho R_in).
  Rgb operator()(const Plastic& m) const {
    const float inner = m.InnerReflectance();
    return m.F0() + (1 - m.F0()) * (1 - inner) * m.albedo() / (1 - m.albedo() * inner);
  }
  Rgb operator()(const Measured& m) const { return m.data->NormalAlbedo(); }
};

struct Words {
  std::ostream& out;

  void operator()(const Lambert&) const { out << "lambert"; }
  void operator()(const Phong& m) const { out << "phong exponent " << m.exponent; }
  void operator()(const Ward& m) const { out << "ward alpha " << m.alpha; }
  void operator()(const MetallicRoughness& m) const {
    out << "ggx roughness " << m.roughness;
    if (m.metallic < 1) out << " metallic " << m.metallic;
    if (IsGlass(m)) out << (m.thickness > 0 ? " glass ior " : " pane ior ") << m.ior;
  }
  void operator()(const BlinnPhong& m) const { out << "blinn-phong exponent " << m.exponent; }
  void operator()(const CookTorrance& m) const { out << "cook-torrance alpha " << m.alpha; }
  void operator()(const OrenNayar& m) const { out << "oren-nayar sigma " << m.sigma; }
  void operator()(const AshikhminShirley& m) const { out << "ashikhmin-shirley exponent " << m.exponent; }
  void operator()(const Plastic& m) const {
    out << "plastic ior " << m.ior() << " roughness " << m.roughness();
  }
  void operator()(const Measured& m) const { out << "measured " << m.data->name(); }
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

Rgb NormalAlbedo(const Reflectance& r) { return std::visit(Normal{}, r); }

std::string Describe(const Reflectance& r) {
  std::ostringstream words;
  std::visit(Words{words}, r);
  return words.str();
}

}  // namespace lobe
