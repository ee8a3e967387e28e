#include "tests/support/rooms/room_materials.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "tests/support/glass.h"
#include "tests/support/metal.h"

namespace lobe::test {
namespace {

/// Of the models that are not glTF's: files hold slopes from 0.001 and exponents to a million.
constexpr float kLeastSlope = 0.0015f;

// cos^n theta_h falls as a Gaussian of slope alpha does: n = 2 / alpha^2 - 2 (Walter et al., EGSR 2007,
// section 5.2). Phong's lobe is about the mirror direction, which turns twice as fast as the half vector.
float HalfVectorExponent(float alpha) { return 2 / (alpha * alpha) - 2; }
float PhongExponent(float alpha) { return HalfVectorExponent(alpha) / 4; }
float SlopeOfHalfVectorExponent(float n) { return std::sqrt(2 / (n + 2)); }

MetallicRoughness Dielectric(const Rgb& colour, float roughness) {
  MetallicRoughness m = Metal(roughness, colour);
  m.metallic = 0;
  return m;
}

}  // namespace

Rgb DrawColour(RandomChoice& random, float brightest) {
  const float saturation = random.Chance(0.3f) ? random.Between(0.3f, 0.9f) : random.Between(0, 0.2f);
  Rgb colour;
  for (int c = 0; c < 3; ++c) colour[c] = 1 - saturation * random.Between(0, 1);
  return colour * (brightest / colour.maxCoeff());
}

float DrawAlbedo(RandomChoice& random) { return random.Between(0.15f, 0.95f); }

DrawnReflectance DrawReflectance(RandomChoice& random, const RoughnessRange& range, float albedo) {
  // Sharp ones as often as rough ones, where both may be.
  const float roughness = random.Chance(0.5f) ? random.Between(range.least, range.most)
                                              : random.LogBetween(range.least, range.most);
  const float alpha = std::clamp(roughness * roughness, kLeastSlope, 1.0f);
  const Rgb colour = DrawColour(random, albedo);
  switch (random.Whole(0, 9)) {
    case 0:
      return {Lambert{colour}, "lambert"};
    case 1:
      return {OrenNayar{colour / OrenNayar::kMostAlbedo, random.Between(0.1f, 0.8f)}, "oren-nayar"};
    case 2:
      return {Phong{colour, PhongExponent(alpha)}, "phong"};
    case 3:
      return {BlinnPhong{colour, HalfVectorExponent(alpha)}, "blinn-phong"};
    case 4:
      return {Ward{colour, alpha}, "ward"};
    case 5:
      return {CookTorrance{colour, alpha}, "cook-torrance"};
    case 6: {
      const float specular = random.Between(0.03f, 0.5f);
      return {AshikhminShirley{colour, Rgb::Constant(specular), HalfVectorExponent(alpha)},
              "ashikhmin-shirley"};
    }
    case 7:
      return {Plastic(colour, random.Between(1.3f, 1.8f), std::max(roughness, 0.02f)), "plastic"};
    case 8:
      return {Metal(roughness, colour), "metal"};
    default:
      return {Dielectric(colour, roughness), "dielectric"};
  }
}

DrawnReflectance DrawMatte(RandomChoice& random, float albedo) {
  const Rgb colour = DrawColour(random, albedo);
  switch (random.Whole(0, 3)) {
    case 0:
      return {OrenNayar{colour / OrenNayar::kMostAlbedo, random.Between(0.1f, 0.8f)}, "oren-nayar"};
    case 1:
      return {Dielectric(colour, random.Between(0.5f, 1)), "dielectric"};
    default:
      return {Lambert{colour}, "lambert"};
  }
}

DrawnReflectance DrawMetal(RandomChoice& random, const RoughnessRange& roughness, float albedo) {
  const Rgb colour = DrawColour(random, albedo);
  return {Metal(random.Between(roughness.least, roughness.most), colour), "metal"};
}

DrawnReflectance DrawTranslucent(RandomChoice& random, float albedo) {
  const Rgb colour = DrawColour(random, albedo);
  MetallicRoughness m = Dielectric(colour, random.Between(0.3f, 1));
  m.diffuse_transmission = random.Between(0.2f, 0.8f);
  m.diffuse_transmission_color = colour;
  return {m, "translucent"};
}

DrawnReflectance DrawGlass(RandomChoice& random, bool body) {
  const float ior = random.Between(1.3f, 1.7f);
  const Rgb colour =
      Rgb::Constant(1) - Rgb{random.Between(0, 0.3f), random.Between(0, 0.3f), random.Between(0, 0.3f)};
  if (body) return {ClearGlass(ior), "glass"};
  return {Pane(ior, colour), "pane"};
}

float RoughnessOf(const Reflectance& reflectance) {
  const float alpha = std::visit(
      [](const auto& m) -> float {
        using Model = std::decay_t<decltype(m)>;
        if constexpr (std::is_same_v<Model, Phong>) {
          return SlopeOfHalfVectorExponent(4 * m.exponent);
        } else if constexpr (std::is_same_v<Model, BlinnPhong> || std::is_same_v<Model, AshikhminShirley>) {
          return SlopeOfHalfVectorExponent(m.exponent);
        } else if constexpr (std::is_same_v<Model, Ward> || std::is_same_v<Model, CookTorrance>) {
          return m.alpha;
        } else if constexpr (std::is_same_v<Model, MetallicRoughness>) {
          return m.roughness * m.roughness;
        } else if constexpr (std::is_same_v<Model, Plastic>) {
          return m.roughness() * m.roughness();
        } else {
          return 1;
        }
      },
      reflectance);
  return std::sqrt(alpha);
}

}  // namespace lobe::test
