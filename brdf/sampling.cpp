#include "brdf/sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kInvPi = std::numbers::inv_pi_v<float>;

float Pow5(float x) {
  const float x2 = x * x;
  return x2 * x2 * x;
}

Vec3 CosineDirection(float u1, float u2) {
  const float r = std::sqrt(u1), phi = 2 * kPi * u2;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u1)};
}

Vec3 UniformDirection(float u1, float u2) {  // on the hemisphere
  const float r = std::sqrt(u1 * (2 - u1)), phi = 2 * kPi * u2;
  return {r * std::cos(phi), r * std::sin(phi), 1 - u1};
}

Vec3 Mirrored(const Vec3& w) { return {-w.x(), -w.y(), w.z()}; }

// D without its pi, from the slope side of the half vector: 1 - cos^2 would cancel in float for sharp lobes.
float GgxDTimesPi(const Vec3& h, float a2) {
  const float s = h.x() * h.x() + h.y() * h.y() + a2 * h.z() * h.z();
  return a2 / (s * s);
}

// c + sqrt(a^2 + (1 - a^2) c^2): 2 c over it is Smith's G1 of GGX.
float SmithSum(float cosine, float a2) { return cosine + std::sqrt(a2 + (1 - a2) * cosine * cosine); }

float GgxVisibility(float cos_i, float cos_o, float a2) {
  return 0.5f / (cos_i * std::sqrt(a2 + (1 - a2) * cos_o * cos_o) +
                 cos_o * std::sqrt(a2 + (1 - a2) * cos_i * cos_i));
}

// cos^n of the angle between unit a and b, accurate for large n because it starts from their difference.
float CosinePower(const Vec3& a, const Vec3& b, float n) {
  const float less = 0.5f * (a - b).squaredNorm();
  return less < 1 ? std::exp(n * std::log1p(-less)) : 0.0f;
}

}  // namespace

ReflectanceSampler::ReflectanceSampler(const Reflectance& r) {
  // The colours under the coat are read off the closed form at normal incidence, where F = f0, so that
  // brdf/reflectance.h stays their one home.
  const Vec3d up(0, 0, 1);
  base_ = EvaluateBase(r, up, up);
  transmission_ = EvaluateTransmission(r, up, -up);
  if (const auto* phong = std::get_if<Phong>(&r)) {
    kind_ = Kind::kPhong;
    width_ = phong->exponent;
    gloss_ = phong->albedo;
  } else if (const auto* ward = std::get_if<Ward>(&r)) {
    kind_ = Kind::kWard;
    width_ = ward->alpha;
    gloss_ = ward->albedo;
  } else if (const auto* m = std::get_if<MetallicRoughness>(&r)) {
    SetMetallicRoughness(*m);
  } else if (const auto* blinn = std::get_if<BlinnPhong>(&r)) {
    kind_ = Kind::kBlinnPhong;
    width_ = blinn->exponent;
    gloss_ = blinn->albedo * BlinnPhong::Factor(width_);
    cosine_chance_ = std::clamp(2 / (width_ + 2), 0.05f, 1.0f);
  } else if (const auto* cook = std::get_if<CookTorrance>(&r)) {
    kind_ = Kind::kCookTorrance;
    width_ = cook->alpha;
    f0_ = cook->f0;
    f90_less_f0_ = 1 - f0_;
  } else if (const auto* oren = std::get_if<OrenNayar>(&r)) {
    base_kind_ = BaseKind::kOrenNayar;
    base_ = oren->albedo * kInvPi;
    oren_a_ = OrenNayar::A(oren->sigma);
    oren_b_ = OrenNayar::B(oren->sigma);
  } else if (const auto* ashikhmin = std::get_if<AshikhminShirley>(&r)) {
    kind_ = Kind::kAshikhminShirley;
    base_kind_ = BaseKind::kAshikhminShirley;
    width_ = ashikhmin->exponent;
    f0_ = ashikhmin->specular;
    f90_less_f0_ = 1 - f0_;
    base_ = ashikhmin->diffuse * (1 - f0_) * kInvPi;
  } else if (const auto* plastic = std::get_if<Plastic>(&r)) {
    SetPlastic(*plastic);
  } else if (const auto* measured = std::get_if<Measured>(&r)) {
    kind_ = Kind::kMeasured;
    measured_ = std::make_shared<const MeasuredSampler>(measured->data);
  }
  width2_ = width_ * width_;
  base_mean_ = base_.mean() * kPi;
  transmission_mean_ = transmission_.mean() * kPi;
  if (const float sum = base_mean_ + transmission_mean_; sum > 0) {
    // Of half vectors the diffuse parts meet few at grazing, whatever wo: their albedo hardly falls there.
    diffuse_mean_ = base_kind_ == BaseKind::kUnderCoat ? sum * (1 - f0_.mean()) : sum;
    diffuse_chance_ = base_mean_ / sum;
    transmission_chance_ = transmission_mean_ / sum;
  }
  if (kind_ == Kind::kGgx) TabulateGlossAlbedo();
}

void ReflectanceSampler::SetMetallicRoughness(const MetallicRoughness& m) {
  f0_ = m.F0();
  f90_less_f0_ = m.F90() - f0_;
  under_coat_by_max_ = m.has_specular;
  const Rgb through = UnderCoat(f0_);
  for (int c = 0; c < 3; ++c) {
    base_[c] = through[c] > 0 ? base_[c] / through[c] : 0;
    transmission_[c] = through[c] > 0 ? transmission_[c] / through[c] : 0;
  }
  if ((f0_ > 0).any() || m.F90() > 0) kind_ = m.roughness < kMirrorRoughness ? Kind::kMirror : Kind::kGgx;
  width_ = m.roughness * m.roughness;
}

void ReflectanceSampler::SetPlastic(const Plastic& m) {
  kind_ = Kind::kGgx;
  base_kind_ = BaseKind::kPlastic;
  width_ = m.roughness() * m.roughness();
  f0_ = Rgb::Constant(m.F0());
  f90_less_f0_ = 1 - f0_;
  // For chances: what leaves at normal incidence of light from everywhere, T(0) times the mean of T.
  base_ = m.BaseScale() * (m.Through(1) * m.ior() * m.ior() * (1 - m.InnerReflectance()));
  plastic_ = std::make_shared<const Plastic>(m);
}

// A few percent, which is plenty for a chance.
void ReflectanceSampler::TabulateGlossAlbedo() {
  constexpr int kSide = 12;  // squared, directions an angle
  for (int i = 0; i <= kAngles; ++i) {
    const float cos_o = std::max(float(i) / kAngles, 1e-3f);
    const Vec3 wo(std::sqrt(1 - cos_o * cos_o), 0, cos_o);
    float sum = 0;
    for (int j = 0; j < kSide * kSide; ++j) {
      const Vec3 h =
          VisibleHalfVector(wo, (float(j % kSide) + 0.5f) / kSide, (float(j / kSide) + 0.5f) / kSide);
      const float cos_h = wo.dot(h), cos_i = 2 * cos_h * h.z() - cos_o;
      if (!(cos_i > 0)) continue;
      // F G2 / G1.
      sum +=
          Fresnel(cos_h).mean() * 2 * cos_i * GgxVisibility(cos_i, cos_o, width2_) * SmithSum(cos_o, width2_);
    }
    gloss_albedo_[i] = sum / (kSide * kSide);
  }
}

ReflectanceSampler ReflectanceSampler::Gloss() const {
  ReflectanceSampler gloss = *this;
  gloss.base_ = gloss.transmission_ = Rgb::Zero();
  gloss.base_mean_ = gloss.transmission_mean_ = 0;
  gloss.diffuse_mean_ = gloss.diffuse_chance_ = gloss.transmission_chance_ = 0;
  return gloss;
}

Rgb ReflectanceSampler::Fresnel(float cosine) const {
  return f0_ + f90_less_f0_ * Pow5(1 - std::min(std::abs(cosine), 1.0f));
}

Rgb ReflectanceSampler::UnderCoat(const Rgb& fresnel) const {
  return under_coat_by_max_ ? Rgb::Constant(1 - fresnel.maxCoeff()) : Rgb(1 - fresnel);
}

float ReflectanceSampler::GlossAlbedo(float cos_o) const {
  if (kind_ != Kind::kGgx) return Fresnel(cos_o).mean();
  const float s = cos_o * kAngles;
  const int i = std::min(int(s), kAngles - 1);
  return gloss_albedo_[i] + (s - float(i)) * (gloss_albedo_[i + 1] - gloss_albedo_[i]);
}

bool ReflectanceSampler::MixesBaseAndGloss() const {
  return (kind_ == Kind::kGgx || kind_ == Kind::kMirror || kind_ == Kind::kAshikhminShirley) &&
         diffuse_mean_ > 0;
}

ReflectanceSampler::Chances ReflectanceSampler::ChancesAt(float cos_o) const {
  if (kind_ == Kind::kDiffuse) return {0, diffuse_chance_, transmission_chance_};
  if (!MixesBaseAndGloss()) return {1, 0, 0};
  const float gloss = GlossAlbedo(cos_o);
  // A part that is there never goes without samples: its share is an estimate.
  const float chance = std::clamp(gloss / (gloss + diffuse_mean_), 0.02f, 0.98f);
  return {chance, (1 - chance) * diffuse_chance_, (1 - chance) * transmission_chance_};
}

Vec3 ReflectanceSampler::VisibleHalfVector(const Vec3& wo, float u1, float u2) const {
  const Vec3 stretched = Vec3(wo.x() * width_, wo.y() * width_, wo.z()).normalized();
  const float phi = 2 * kPi * u1;
  const float z = (1 - u2) * (1 + stretched.z()) - stretched.z();
  const float sine = std::sqrt(std::clamp((1 - z) * (1 + z), 0.0f, 1.0f));
  const Vec3 h = Vec3(sine * std::cos(phi), sine * std::sin(phi), z) + stretched;
  return Vec3(h.x() * width_, h.y() * width_, std::max(h.z(), 0.0f)).normalized();
}

Rgb ReflectanceSampler::BaseValue(const Vec3& wo, const Vec3& wi, const Rgb& fresnel) const {
  switch (base_kind_) {
    case BaseKind::kUnderCoat:
      return base_ * UnderCoat(fresnel);
    case BaseKind::kOrenNayar:
      return base_ * (kPi * OrenNayar::White<float>(wi, wo, oren_a_, oren_b_));
    case BaseKind::kAshikhminShirley:
      return base_ * (kPi * AshikhminShirley::WhiteBase(wi.z(), wo.z()));
    case BaseKind::kPlastic:
      return plastic_->BaseScale() * (plastic_->Through(wi.z()) * plastic_->Through(wo.z()));
  }
  return Rgb::Zero();
}

float ReflectanceSampler::BasePdf(float cos_i) const {
  return (1 - oren_b_) * cos_i * kInvPi + oren_b_ * 0.5f * kInvPi;
}

// Gloss that is drawn by half vectors: f, and density of the half vector over 4 wo.h.
void ReflectanceSampler::AddHalfVectorGloss(const Vec3& wo, const Vec3& wi, float chance,
                                            ReflectanceValue* out) const {
  const HalfAngles<float> h(wi, wo);
  const float by_half_vector = 0.25f / h.cos_d;
  if (kind_ == Kind::kCookTorrance) {
    out->f += Fresnel(h.cos_d) * CookTorrance::White(h, wi.z(), wo.z(), width_);
    out->pdf += chance * CookTorrance::BeckmannD(h, width_) * h.cos_h() * by_half_vector;
    return;
  }
  const float power = h.CosinePower(width_), pdf = (width_ + 1) * 0.5f * kInvPi * power * by_half_vector;
  if (kind_ == Kind::kBlinnPhong) {
    out->f += gloss_ * power;
    out->pdf += chance * ((1 - cosine_chance_) * pdf + cosine_chance_ * wi.z() * kInvPi);
  } else {
    out->f += Fresnel(h.cos_d) * AshikhminShirley::WhiteGloss(h, wi.z(), wo.z(), width_);
    out->pdf += chance * pdf;
  }
}

ReflectanceValue ReflectanceSampler::Evaluate(const Vec3& wo, const Vec3& wi) const {
  ReflectanceValue out;
  if (!(wo.z() > 0) || wi.z() == 0) return out;
  if (kind_ == Kind::kDiffuse) {
    const bool above = wi.z() > 0;
    out.f = !above ? transmission_ : base_kind_ == BaseKind::kUnderCoat ? base_ : BaseValue(wo, wi, f0_);
    out.pdf = (above ? diffuse_chance_ : transmission_chance_) * BasePdf(std::abs(wi.z()));
    return out;
  }
  if (wi.z() < 0) {
    if (transmission_mean_ == 0) return out;
    const Vec3 mirrored(wi.x(), wi.y(), -wi.z());
    const float cos_h = wo.dot((wo + mirrored).normalized());
    out.f = transmission_ * UnderCoat(Fresnel(cos_h));
    out.pdf = ChancesAt(wo.z()).transmission * -wi.z() * kInvPi;
    return out;
  }
  if (kind_ == Kind::kPhong) {
    const float power = CosinePower(Mirrored(wo), wi, width_) * 0.5f * kInvPi;
    out.f = gloss_ * ((width_ + 2) * power);
    out.pdf = (width_ + 1) * power;
    return out;
  }
  if (kind_ == Kind::kMeasured) {
    out.f = measured_->Value(wo, wi);
    out.pdf = measured_->Pdf(wo, wi);
    return out;
  }
  const Vec3 sum = wo + wi;
  if (kind_ == Kind::kWard) {
    const float hz2 = sum.z() * sum.z(), h2 = sum.squaredNorm();
    const float tan2 = (sum.x() * sum.x() + sum.y() * sum.y()) / hz2;
    const float gauss = std::exp(-tan2 / width2_) * kInvPi / width2_;
    out.f = gloss_ * (gauss * h2 / (hz2 * hz2));
    // Of h: gauss / cos^3 theta_h; of wi: that over 4 wo.h, with |sum| = 2 wo.h.
    out.pdf = gauss * h2 / (2 * hz2 * sum.z());
    return out;
  }
  const Vec3 h = sum.normalized();
  const Rgb fresnel = Fresnel(wo.dot(h));
  const Chances chances = ChancesAt(wo.z());
  if (base_mean_ > 0) {
    out.f = BaseValue(wo, wi, fresnel);
    out.pdf = chances.base * BasePdf(wi.z());
  }
  if (kind_ == Kind::kBlinnPhong || kind_ == Kind::kCookTorrance || kind_ == Kind::kAshikhminShirley) {
    AddHalfVectorGloss(wo, wi, chances.gloss, &out);
  } else if (kind_ == Kind::kGgx) {
    const float d = GgxDTimesPi(h, width2_) * kInvPi;
    out.f += fresnel * (d * GgxVisibility(wi.z(), wo.z(), width2_));
    out.pdf += chances.gloss * d / (2 * SmithSum(wo.z(), width2_));  // G1 D / (4 cos_o)
  }
  return out;
}

SampledDirection ReflectanceSampler::Sample(const Vec3& wo, float u1, float u2, float u3) const {
  SampledDirection out;
  if (!(wo.z() > 0)) return out;
  const Chances chances = ChancesAt(wo.z());
  if (u3 < chances.gloss) {
    switch (kind_) {
      case Kind::kDiffuse:
        break;  // it has no gloss
      case Kind::kMirror:
        out.wi = Mirrored(wo);
        out.pdf = chances.gloss;
        out.weight = Fresnel(wo.z()) / chances.gloss;
        out.delta = true;
        return out;
      case Kind::kPhong: {
        const float log_cos = std::log1p(-u1) / (width_ + 1), phi = 2 * kPi * u2;
        const float less = -std::expm1(log_cos), cosine = 1 - less, sine = std::sqrt(less * (1 + cosine));
        const Vec3 z = Mirrored(wo);
        const Vec3 x = std::abs(z.x()) < 0.7f ? Vec3(0, z.z(), -z.y()).normalized()
                                              : Vec3(-z.z(), 0, z.x()).normalized();
        out.wi = (x * (sine * std::cos(phi)) + z.cross(x) * (sine * std::sin(phi)) + z * cosine).normalized();
        break;
      }
      case Kind::kWard:
      case Kind::kCookTorrance: {
        const float slope = width_ * std::sqrt(-std::log1p(-u1)), phi = 2 * kPi * u2;
        const Vec3 h = Vec3(slope * std::cos(phi), slope * std::sin(phi), 1).normalized();
        out.wi = (2 * wo.dot(h) * h - wo).normalized();
        break;
      }
      case Kind::kBlinnPhong:
      case Kind::kAshikhminShirley: {
        if (u3 < cosine_chance_) {
          out.wi = CosineDirection(u1, u2);
          break;
        }
        const float log_cos = std::log1p(-u1) / (width_ + 1), phi = 2 * kPi * u2;
        const float less = -std::expm1(log_cos), sine = std::sqrt(less * (2 - less));
        const Vec3 h(sine * std::cos(phi), sine * std::sin(phi), 1 - less);
        out.wi = (2 * wo.dot(h) * h - wo).normalized();
        break;
      }
      case Kind::kMeasured:
        out.wi = measured_->Sample(wo, u1, u2, u3);
        break;
      case Kind::kGgx: {
        const Vec3 h = VisibleHalfVector(wo, u1, u2);
        out.wi = (2 * wo.dot(h) * h - wo).normalized();
        break;
      }
    }
    if (!(out.wi.z() > 0)) return out;
  } else {
    const bool through = u3 >= chances.gloss + chances.base;
    if ((through ? chances.transmission : chances.base) == 0) return out;  // black, or u3 at a rounding error
    // Places of u3 within [gloss, gloss + base) choose between Oren-Nayar's two shares.
    const bool uniform = oren_b_ > 0 && (u3 - chances.gloss) < oren_b_ * chances.base;
    out.wi = uniform ? UniformDirection(u1, u2) : CosineDirection(u1, u2);
    if (through) out.wi.z() = -out.wi.z();
  }
  const ReflectanceValue value = Evaluate(wo, out.wi);
  if (!(value.pdf > 0)) return out;
  out.pdf = value.pdf;
  out.weight = value.f * (std::abs(out.wi.z()) / value.pdf);
  return out;
}

}  // namespace lobe
