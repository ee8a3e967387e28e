#pragma once

#include <array>
#include <memory>
#include <vector>

#include "brdf/measured_sampler.h"
#include "brdf/reflectance.h"

namespace lobe {

/// A direction drawn in proportion to (about) f |cos|.
struct SampledDirection {
  Vec3 wi = Vec3::UnitZ();   ///< local, unit; z < 0: through the sheet
  float pdf = 0;             ///< per steradian; 0: no direction, the path ends
  Rgb weight = Rgb::Zero();  ///< f |cos| / pdf, what light along wi is multiplied by
  /// An ideal reflection. `pdf` is then the probability with which it was chosen.
  bool delta = false;
};

struct ReflectanceValue {
  Rgb f = Rgb::Zero();  ///< sr^-1, without the cosine; reflected for wi.z > 0, transmitted for wi.z < 0
  float pdf = 0;        ///< with which Sample finds wi
};

/// One Reflectance prepared for paths: closed form and importance sampling in single precision, without
/// variants or allocation. Directions are local, unit and point away from the surface; `wo` must lie above
/// the horizon, at or below it everything is 0. Thread-safe.
///
/// Directions are drawn from a mixture of base (cosine), transmission (cosine on the other side) and gloss,
/// chosen by their directional albedos at wo. Gloss:
/// - GGX (glTF, plastic) by the half vectors visible from wo (Heitz, "Sampling the GGX Distribution of
/// Visible
///   Normals", JCGT 7(4), 2018) in the spherical-cap form of Dupuy and Benyoub ("Sampling Visible GGX Normals
///   with Spherical Caps", CGF 42(8), 2023);
/// - Ward and Cook-Torrance by the Gaussian of their half vectors' slopes, which is D cos;
/// - Ashikhmin-Shirley by half vectors in proportion to cos^n; Blinn-Phong too, mixed with the cosine the
/// more
///   the duller it is;
/// - Phong by its cosine power around the mirror direction;
/// - measured ones by their table of half vectors (brdf/measured_sampler.h).
/// Bases by the cosine, and Oren-Nayar's rising share uniformly.
///
/// Gloss finds some directions below the horizon; they come back with pdf 0. So the pdf integrates over the
/// sphere to 1 less the chance of that, and for an ideal mirror less the chance of its reflection.
class ReflectanceSampler {
 public:
  explicit ReflectanceSampler(const Reflectance& r);
  /// The coat alone, without what is under it.
  ReflectanceSampler Gloss() const;

  /// u1, u2, u3: uniform in [0, 1).
  SampledDirection Sample(const Vec3& wo, float u1, float u2, float u3) const;
  ReflectanceValue Evaluate(const Vec3& wo, const Vec3& wi) const;
  float Pdf(const Vec3& wo, const Vec3& wi) const { return Evaluate(wo, wi).pdf; }

  bool black() const { return kind_ == Kind::kDiffuse && diffuse_chance_ == 0 && transmission_chance_ == 0; }
  bool transmits() const { return transmission_mean_ > 0; }

 private:
  enum class Kind {  // of gloss; kDiffuse has none
    kDiffuse,
    kPhong,
    kWard,
    kGgx,
    kMirror,
    kBlinnPhong,
    kCookTorrance,
    kAshikhminShirley,
    kMeasured
  };
  // How the base varies: under a coat by 1 - F at the half vector; or as the model says.
  enum class BaseKind { kUnderCoat, kOrenNayar, kAshikhminShirley, kPlastic };
  struct Chances {  // of the parts, sum 1 unless all are black
    float gloss, base, transmission;
  };

  void SetMetallicRoughness(const MetallicRoughness& m);
  void SetPlastic(const Plastic& m);
  void TabulateGlossAlbedo();
  bool MixesBaseAndGloss() const;
  Chances ChancesAt(float cos_o) const;
  Rgb BaseValue(const Vec3& wo, const Vec3& wi, const Rgb& fresnel) const;
  float BasePdf(float cos_i) const;
  void AddHalfVectorGloss(const Vec3& wo, const Vec3& wi, float chance, ReflectanceValue* out) const;
  Rgb Fresnel(float cosine) const;
  Rgb UnderCoat(const Rgb& fresnel) const;
  float GlossAlbedo(float cos_o) const;
  Vec3 VisibleHalfVector(const Vec3& wo, float u1, float u2) const;

  Kind kind_ = Kind::kDiffuse;
  bool under_coat_by_max_ = false;
  BaseKind base_kind_ = BaseKind::kUnderCoat;
  float width_ = 1, width2_ = 1;  // alpha of GGX, Ward, Cook-Torrance; exponent of the Phongs; squared
  Rgb f0_ = Rgb::Zero(), f90_less_f0_ = Rgb::Zero();
  Rgb gloss_ = Rgb::Zero();                              // colour of the Phongs and Ward
  Rgb base_ = Rgb::Zero(), transmission_ = Rgb::Zero();  // under the coat, over pi
  float base_mean_ = 0, transmission_mean_ = 0;          // albedos under the coat, mean of channels
  float cosine_chance_ = 0;                              // of Blinn-Phong's directions
  float oren_a_ = 1, oren_b_ = 0;                        // Oren-Nayar's A and B; B is the uniform share
  std::shared_ptr<const Plastic> plastic_;
  std::shared_ptr<const MeasuredSampler> measured_;
  float diffuse_mean_ = 0;  // their sum, less what the coat takes at normal incidence
  float diffuse_chance_ = 0, transmission_chance_ = 0;  // shares of that sum
  static constexpr int kAngles = 16;
  std::array<float, kAngles + 1> gloss_albedo_{};  // GGX, mean of channels, equal steps in cos_o
};

}  // namespace lobe
