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

// For models with kinks (where cos_i = cos_o, or where G sets in), which the default rule meets to 1e-4.
HalfVectorRule Fine(double width) {
  return {.width = width, .polar = GaussLegendre(120, 0, 1), .azimuth = GaussLegendre(160, -1, 1)};
}

// Width of cos^n, as the alpha of a Gaussian of slopes.
double PowerWidth(double n) { return std::min(1.0, std::sqrt(2 / (n + 2))); }

std::vector<LobeRecipe> Ggx(float roughness, const Rgb& f0, const Rgb& f90) {
  const double alpha = double(roughness) * roughness;
  const auto f = [alpha](const Vec3d& wi, const Vec3d& wo) {
    const Vec3d h = (wi + wo).normalized();
    return GgxD(h.z(), alpha) * GgxV(wi.z(), wo.z(), alpha);
  };
  return {{Key("ggx", {roughness}), f, {.width = alpha}, f0, f90 - f0}};
}

struct Gloss {
  using Recipes = std::vector<LobeRecipe>;

  Recipes operator()(const Lambert&) const { return {}; }
  Recipes operator()(const OrenNayar&) const { return {}; }
  Recipes operator()(const Phong& m) const {
    const Reflectance white = Phong{Rgb::Constant(1), m.exponent};
    const auto f = [white](const Vec3d& wi, const Vec3d& wo) {
      return double(EvaluateGloss(white, wi, wo)[0]);
    };
    return {{Key("phong", {m.exponent}),
             f,
             {.width = std::min(1.0, 1.0 / std::sqrt(m.exponent + 1.0))},
             m.albedo,
             Rgb::Zero()}};
  }
  Recipes operator()(const Ward& m) const {
    const Reflectance white = Ward{Rgb::Constant(1), m.alpha};
    const auto f = [white](const Vec3d& wi, const Vec3d& wo) {
      return double(EvaluateGloss(white, wi, wo)[0]);
    };
    return {{Key("ward", {m.alpha}), f, {.width = std::min(1.0f, m.alpha)}, m.albedo, Rgb::Zero()}};
  }
  Recipes operator()(const MetallicRoughness& m) const {
    if (m.roughness < kMirrorRoughness) return {};
    return Ggx(m.roughness, m.F0(), Rgb::Constant(m.F90()));
  }
  Recipes operator()(const BlinnPhong& m) const {
    const double n = m.exponent;
    const auto f = [n](const Vec3d& wi, const Vec3d& wo) {
      return BlinnPhong::White(HalfAngles<double>(wi, wo), n);
    };
    return {{Key("blinn-phong", {n}), f, {.width = PowerWidth(n)}, m.albedo, Rgb::Zero()}};
  }
  Recipes operator()(const CookTorrance& m) const {
    const double alpha = m.alpha;
    const auto f = [alpha](const Vec3d& wi, const Vec3d& wo) {
      return CookTorrance::White(HalfAngles<double>(wi, wo), wi.z(), wo.z(), alpha);
    };
    return {{Key("cook-torrance", {alpha}), f, Fine(std::min(1.0, alpha)), m.f0, 1 - m.f0}};
  }
  Recipes operator()(const AshikhminShirley& m) const {
    const double n = m.exponent;
    const auto f = [n](const Vec3d& wi, const Vec3d& wo) {
      return AshikhminShirley::WhiteGloss(HalfAngles<double>(wi, wo), wi.z(), wo.z(), n);
    };
    return {{Key("ashikhmin-shirley", {n}), f, Fine(PowerWidth(n)), m.specular, 1 - m.specular}};
  }
  Recipes operator()(const Plastic& m) const {
    return Ggx(m.roughness(), Rgb::Constant(m.F0()), Rgb::Constant(1));
  }
  Recipes operator()(const Measured& m) const {
    Recipes channels;
    for (int c = 0; c < 3; ++c) {
      const auto f = [data = m.data, c](const Vec3d& wi, const Vec3d& wo) {
        return double(data->Value(wi, wo)[c]);
      };
      Rgb colour = Rgb::Zero();
      colour[c] = 1;
      channels.push_back(
          {"measured " + m.data->digest() + ' ' + std::to_string(c), f, m.data->Rule(), colour, Rgb::Zero()});
    }
    return channels;
  }
};

struct Base {
  using Recipes = std::vector<LobeRecipe>;

  template <typename Model>
  Recipes operator()(const Model&) const {
    return {};
  }
  Recipes operator()(const OrenNayar& m) const {
    if (m.sigma == 0) return {};  // Lambert
    const double a = OrenNayar::A<double>(m.sigma), b = OrenNayar::B<double>(m.sigma);
    const auto f = [a, b](const Vec3d& wi, const Vec3d& wo) {
      return OrenNayar::White<double>(wi, wo, a, b);
    };
    // It has a cone at normal incidence: rises in proportion to theta.
    const auto albedo = [a, b](double cos_i) { return OrenNayar::WhiteAlbedo(cos_i, a, b); };
    return {{Key("oren-nayar", {m.sigma}), f, Fine(1), m.albedo, Rgb::Zero(), albedo}};
  }
  Recipes operator()(const AshikhminShirley& m) const {
    const auto f = [](const Vec3d& wi, const Vec3d& wo) {
      return AshikhminShirley::WhiteBase(wi.z(), wo.z());
    };
    return {{"ashikhmin-shirley base", f, {}, m.diffuse * (1 - m.specular), Rgb::Zero()}};
  }
  Recipes operator()(const Plastic& m) const {
    const auto f = [m](const Vec3d& wi, const Vec3d& wo) {
      return double(m.Through(float(wi.z()))) * m.Through(float(wo.z()));
    };
    return {{Key("plastic base", {m.ior(), m.roughness()}), f, {}, m.BaseScale(), Rgb::Zero()}};
  }
};

std::vector<LobeRecipe> WithoutBlack(std::vector<LobeRecipe> recipes) {
  if (std::all_of(recipes.begin(), recipes.end(), [](const LobeRecipe& r) { return r.black(); })) return {};
  return recipes;
}

}  // namespace

std::vector<LobeRecipe> GlossRecipes(const Reflectance& r) { return WithoutBlack(std::visit(Gloss{}, r)); }
std::vector<LobeRecipe> BaseRecipes(const Reflectance& r) { return WithoutBlack(std::visit(Base{}, r)); }

}  // namespace lobe
