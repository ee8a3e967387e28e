#include "brdf/lobe_recipe.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <sstream>

namespace lobe {
namespace {

std::string Key(const char* model, std::initializer_list<double> parameters) {
  std::ostringstream key;
  key.precision(9);
  key << model;
  for (const double p : parameters) key << ' ' << p;
  return key.str();
}

// Width of cos^n, as the alpha of a Gaussian of slopes.
double PowerWidth(double n) { return std::min(1.0, std::sqrt(2 / (n + 2))); }

LobeRecipe Ggx(float roughness, const Rgb& f0, const Rgb& f90) {
  const double alpha = double(roughness) * roughness;
  const auto f = [alpha](const Vec3d& wi, const Vec3d& wo) {
    const Vec3d h = (wi + wo).normalized();
    return GgxD(h.z(), alpha) * GgxV(wi.z(), wo.z(), alpha);
  };
  return LobeRecipe{Key("ggx", {roughness}), f, {.width = alpha}, f0, f90 - f0};
}

// From this exponent on Phong's end, 90 degrees from the mirror direction, is smooth enough to be integrated
// across (docs/validation.md#extremes).
constexpr float kSmoothPhong = 5;

struct Gloss {
  using Recipe = std::optional<LobeRecipe>;

  Recipe operator()(const Lambert&) const { return {}; }
  Recipe operator()(const OrenNayar&) const { return {}; }
  Recipe operator()(const Phong& m) const {
    const Reflectance white = Phong{Rgb::Constant(1), m.exponent};
    const auto f = [white](const Vec3d& wi, const Vec3d& wo) {
      return double(EvaluateGloss(white, wi, wo)[0]);
    };
    return LobeRecipe{Key("phong", {m.exponent}),
                      f,
                      {.width = std::min(1.0, 1.0 / std::sqrt(m.exponent + 1.0)),
                       .half_around_mirror = m.exponent < kSmoothPhong},
                      m.albedo,
                      Rgb::Zero()};
  }
  Recipe operator()(const Ward& m) const {
    const Reflectance white = Ward{Rgb::Constant(1), m.alpha};
    const auto f = [white](const Vec3d& wi, const Vec3d& wo) {
      return double(EvaluateGloss(white, wi, wo)[0]);
    };
    return LobeRecipe{Key("ward", {m.alpha}), f, {.width = std::min(1.0f, m.alpha)}, m.albedo, Rgb::Zero()};
  }
  Recipe operator()(const MetallicRoughness& m) const {
    if (m.roughness < kMirrorRoughness) return {};
    return Ggx(m.roughness, m.F0(), Rgb::Constant(m.F90()));
  }
  Recipe operator()(const BlinnPhong& m) const {
    const double n = m.exponent;
    const auto f = [n](const Vec3d& wi, const Vec3d& wo) {
      return BlinnPhong::White(HalfAngles<double>(wi, wo), n);
    };
    return LobeRecipe{Key("blinn-phong", {n}), f, {.width = PowerWidth(n)}, m.albedo, Rgb::Zero()};
  }
  Recipe operator()(const CookTorrance& m) const {
    const double alpha = m.alpha;
    const auto f = [alpha](const Vec3d& wi, const Vec3d& wo) {
      return CookTorrance::White(HalfAngles<double>(wi, wo), wi.z(), wo.z(), alpha);
    };
    return LobeRecipe{Key("cook-torrance", {alpha}),
                      f,
                      {.width = std::min(1.0, alpha), .kinks = CookTorrance::Kinks},
                      m.f0,
                      1 - m.f0};
  }
  Recipe operator()(const AshikhminShirley& m) const {
    const double n = m.exponent;
    const auto f = [n](const Vec3d& wi, const Vec3d& wo) {
      return AshikhminShirley::WhiteGloss(HalfAngles<double>(wi, wo), wi.z(), wo.z(), n);
    };
    return LobeRecipe{Key("ashikhmin-shirley", {n}),
                      f,
                      {.width = PowerWidth(n), .kinks = AshikhminShirley::Kinks},
                      m.specular,
                      1 - m.specular};
  }
  Recipe operator()(const Plastic& m) const {
    return Ggx(m.roughness(), Rgb::Constant(m.F0()), Rgb::Constant(1));
  }
  Recipe operator()(const Measured& m) const {
    LobeRecipe recipe;
    recipe.key = "measured " + m.data->digest();
    recipe.rule = m.data->Rule();
    recipe.channels = [data = m.data](const Vec3d& wi, const Vec3d& wo) { return data->Value(wi, wo); };
    return recipe;
  }
};

struct Base {
  using Recipe = std::optional<LobeRecipe>;

  template <typename Model>
  Recipe operator()(const Model&) const {
    return {};
  }
  Recipe operator()(const OrenNayar& m) const {
    if (m.sigma == 0) return {};  // Lambert
    const double a = OrenNayar::A<double>(m.sigma), b = OrenNayar::B<double>(m.sigma);
    const auto f = [a, b](const Vec3d& wi, const Vec3d& wo) {
      return OrenNayar::White<double>(wi, wo, a, b);
    };
    // It has a cone at normal incidence: rises in proportion to theta.
    const auto albedo = [a, b](double cos_i) { return OrenNayar::WhiteAlbedo(cos_i, a, b); };
    // Kinks where the horizontal parts are at right angles, which the default rule meets to 1e-4.
    const HalfVectorRule fine{.polar = GaussLegendre(120, 0, 1), .azimuth = GaussLegendre(160, -1, 1)};
    return LobeRecipe{Key("oren-nayar", {m.sigma}), f, fine, m.albedo, Rgb::Zero(), albedo};
  }
  Recipe operator()(const AshikhminShirley& m) const {
    const auto f = [](const Vec3d& wi, const Vec3d& wo) {
      return AshikhminShirley::WhiteBase(wi.z(), wo.z());
    };
    return LobeRecipe{"ashikhmin-shirley base", f, {}, m.diffuse * (1 - m.specular), Rgb::Zero()};
  }
  Recipe operator()(const Plastic& m) const {
    const auto f = [m](const Vec3d& wi, const Vec3d& wo) {
      return double(m.Through(float(wi.z()))) * m.Through(float(wo.z()));
    };
    return LobeRecipe{Key("plastic base", {m.ior(), m.roughness()}), f, {}, m.BaseScale(), Rgb::Zero()};
  }
};

std::optional<LobeRecipe> UnlessBlack(const std::optional<LobeRecipe>& recipe) {
  const bool black = recipe && !recipe->channels && (recipe->plain <= 0).all() && (recipe->rising <= 0).all();
  return black ? std::nullopt : recipe;
}

}  // namespace

std::optional<LobeRecipe> GlossRecipe(const Reflectance& r) { return UnlessBlack(std::visit(Gloss{}, r)); }
std::optional<LobeRecipe> BaseRecipe(const Reflectance& r) { return UnlessBlack(std::visit(Base{}, r)); }

}  // namespace lobe
