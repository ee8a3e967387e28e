#include "brdf/material_lobes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "sh/lobe.h"
#include "sh/zernike.h"

namespace lobe {
namespace {

// The base under a coat is smooth: this degree leaves less than kBaseError of it out
// (docs/validation.md#base).
constexpr int kBaseDegreeCap = 8;
constexpr double kBaseError = 0.01;

// From this exponent on Phong's end, 90 degrees from the mirror direction, is smooth enough to be integrated
// across (docs/validation.md#extremes).
constexpr float kSmoothPhong = 5;

std::string Key(const char* model, double parameter, int l_max, int knots) {
  std::ostringstream key;
  key.precision(9);
  key << model << ' ' << parameter << ' ' << l_max << ' ' << knots;
  return key.str();
}

// What the spline's flux lacks of the albedo, at each sample of the fine grid.
std::vector<float> FluxRest(const IncidenceSpline& spline, const Eigen::VectorXd& flux_at_knots,
                            const Eigen::VectorXd& albedo) {
  const Eigen::MatrixXd control = spline.ControlValues(flux_at_knots, /*odd=*/false);
  std::vector<float> rest(albedo.size());
  for (int i = 0; i < albedo.size(); ++i) {
    const auto stencil = spline.At(float(IncidenceSpline::CosineOfParameter(double(i) / ScalarTable::kFine)));
    double flux = 0;
    for (int k = 0; k < 4; ++k) flux += double(stencil.weight[k]) * control(stencil.bin[k], 0);
    rest[i] = float(albedo[i] - flux);
  }
  return rest;
}

// One channel of a part from its table, which is read up to part.l_max.
void SetChannel(PartLobes& part, int channel, const IncidenceSpline& spline, const ScalarTable& table) {
  const int l_max = part.l_max;
  const ZernikeTransform transform(l_max);
  auto& control = part.control[channel];
  control.assign(size_t(spline.bins()) * part.RowCount(), 0.0f);
  for (int m = 0; m <= l_max; ++m) {
    const int size = (l_max - m) / 2 + 1;
    Eigen::MatrixXd values(spline.knots(), size);
    for (int n = 0; n < size; ++n) {
      values.col(n) = table.zernike.row(ScalarTable::RowIndex(m + 2 * n, m)).transpose();
    }
    const Eigen::MatrixXd bins =
        spline.ControlValues(values * transform.ToHemisphereBlock(m).transpose(), m % 2 == 1);
    for (int l = 0; l < size; ++l) {
      for (int bin = 0; bin < spline.bins(); ++bin) {
        control[size_t(bin) * part.RowCount() + part.Row(m + 2 * l, m)] = float(bins(bin, l));
      }
    }
  }
  const Eigen::VectorXd flux = std::sqrt(std::numbers::pi) * table.zernike.row(0).transpose();
  part.flux_rest[channel] = FluxRest(spline, flux, table.albedo);
  part.albedo[channel].resize(table.albedo.size());
  for (int i = 0; i < table.albedo.size(); ++i) part.albedo[channel][i] = float(table.albedo[i]);
}

Rgb LambertPart(PartLobes& part, const Rgb& albedo) {
  part.l_max = 0;
  part.error = 0;
  for (int c = 0; c < 3; ++c) {
    part.control[c].clear();
    part.albedo[c].assign(ScalarTable::kFine + 1, albedo[c]);
    part.flux_rest[c].assign(ScalarTable::kFine + 1, 0.0f);
  }
  return albedo;
}

// A Lambertian part next to a glossy one goes through the same spline; its lobe is albedo / pi.
void SplineOfLambert(PartLobes& part, const IncidenceSpline& spline) {
  if (part.l_max != 0) return;
  for (int c = 0; c < 3; ++c) {
    const float coefficient =
        part.albedo[c][0] / float(std::numbers::pi) * std::sqrt(2.0f * float(std::numbers::pi));
    part.control[c].assign(spline.bins(), coefficient);
  }
}

int DegreeWithin(const ScalarTable& table, const LobeOptions& options) {
  if (options.force_l_max >= 0) return options.force_l_max;
  int l = 0;
  while (l < options.l_max && table.Error(l) > options.error) ++l;
  return l;
}

}  // namespace

const char* Name(GlossKind kind) {
  switch (kind) {
    case GlossKind::kNone:
      return "none";
    case GlossKind::kLobe:
      return "lobe";
    case GlossKind::kSharp:
      return "sharp";
    case GlossKind::kMirror:
      return "mirror";
  }
  return "";
}

std::shared_ptr<const SchlickTables> TableCache::Get(const std::string& key,
                                                     const std::function<SchlickTables()>& build) {
  auto& tables = tables_[key];
  if (!tables) tables = std::make_shared<SchlickTables>(build());
  return tables;
}

Rgb PartLobes::Albedo(float cos_theta_i) const {
  if (l_max < 0) return Rgb::Zero();
  const FineAngle at(cos_theta_i);
  Rgb out;
  for (int c = 0; c < 3; ++c) out[c] = at.Read(albedo[c]);
  return out;
}

MaterialLobes::MaterialLobes(const Reflectance& reflectance, const LobeOptions& options, TableCache& cache)
    : reflectance_(reflectance) {
  glass_ = IsGlass(reflectance);
  const int cap = options.force_l_max >= 0 ? options.force_l_max : options.l_max;
  const int base_cap = std::min(kBaseDegreeCap, options.force_l_max >= 0 ? kBaseDegreeCap : cap);
  const int knots = ScalarTable::DefaultKnots(std::max(cap, kBaseDegreeCap));
  spline_ = std::make_shared<IncidenceSpline>(knots);

  // The gloss f (plain + rising (1 - V.H)^5). Phong and Ward do not rise.
  const auto gloss_from = [&](const char* model, double parameter, const HalfVectorRule& rule,
                              const ScalarBrdf& f, const Rgb& plain, const Rgb& rising) {
    if ((plain <= 0).all() && (rising <= 0).all()) return;
    const auto tables = cache.Get(Key(model, parameter, cap, knots),
                                  [&] { return SchlickTables::Build(f, cap, rule, knots); });
    // Degree and kind follow from f alone, so that colours share tables. The error stated is the material's
    // own: a dielectric's is larger, since Schlick's rise leaves most of its gloss at grazing angles.
    gloss.l_max = DegreeWithin(tables->plain, options);
    const bool within = tables->plain.Error(gloss.l_max) <= options.error || options.force_l_max >= 0;
    kind_ = within ? GlossKind::kLobe : GlossKind::kSharp;
    gloss.error = tables->Mix(plain.mean(), rising.mean()).Error(gloss.l_max);
    for (int c = 0; c < 3; ++c) SetChannel(gloss, c, *spline_, tables->Mix(plain[c], rising[c]));
  };

  if (const auto* lambert = std::get_if<Lambert>(&reflectance)) {
    diffuse_albedo_ = LambertPart(base, lambert->albedo);
  } else if (const auto* phong = std::get_if<Phong>(&reflectance)) {
    const Reflectance white = Phong{Rgb::Constant(1), phong->exponent};
    gloss_from(
        "phong", phong->exponent,
        {.width = std::min(1.0, 1.0 / std::sqrt(phong->exponent + 1.0)),
         .half_around_mirror = phong->exponent < kSmoothPhong},
        [&](const Vec3d& wi, const Vec3d& wo) { return double(EvaluateGloss(white, wi, wo)[0]); },
        phong->albedo, Rgb::Zero());
  } else if (const auto* ward = std::get_if<Ward>(&reflectance)) {
    const Reflectance white = Ward{Rgb::Constant(1), ward->alpha};
    gloss_from(
        "ward", ward->alpha, {.width = std::min(1.0f, ward->alpha)},
        [&](const Vec3d& wi, const Vec3d& wo) { return double(EvaluateGloss(white, wi, wo)[0]); },
        ward->albedo, Rgb::Zero());
  } else if (const auto* gltf = std::get_if<MetallicRoughness>(&reflectance)) {
    const Rgb f0 = gltf->F0();
    const float f90 = gltf->F90();
    const bool coated = (f0 > 0).any() || f90 > 0;

    // Base: c_diff / pi (1 - F), F = f0 + (f90 - f0)(1 - V.H)^5 (of the largest channel with
    // KHR_materials_specular). A constant and one universal table. What passes to the other side is weighed
    // by the same coat, so its albedo comes from the same table.
    const Rgb diffuse = gltf->DiffuseColor(), passed = gltf->TransmissionColor();
    const Rgb f0_base = gltf->has_specular ? Rgb::Constant(f0.maxCoeff()) : f0;
    const Rgb constant = diffuse * (1 - f0_base), slope = diffuse * (f90 - f0_base);
    transmits_ = Transmits(reflectance);
    transmission_constant_ = passed * (1 - f0_base);
    transmission_slope_ = passed * (f90 - f0_base);
    const bool sloped_transmission = transmits_ && (transmission_slope_.abs() >= 1e-7f).any();
    const bool sloped = (slope.abs() >= 1e-7f).any();
    std::shared_ptr<const SchlickTables> white;
    if (sloped || sloped_transmission) {
      white = cache.Get(Key("lambert", 0, kBaseDegreeCap, knots), [&] {
        return SchlickTables::Build([](const Vec3d&, const Vec3d&) { return 1.0 / std::numbers::pi; },
                                    kBaseDegreeCap, HalfVectorRule{.width = 1.0}, knots);
      });
    }
    if (sloped_transmission) {
      for (const double albedo : white->rising.albedo) fresnel_albedo_.push_back(float(albedo));
    }
    if (!sloped) {
      if ((diffuse > 0).any() || !coated || transmits_) diffuse_albedo_ = LambertPart(base, constant);
    } else {
      // Only the Fresnel part is cut; the steepest channel decides.
      int steepest = 0;
      (slope / constant.max(1e-6f)).maxCoeff(&steepest);
      const auto whole = white->Mix(constant[steepest], -slope[steepest]);
      const auto error = [&](int l) { return slope[steepest] * white->rising.ErrorWithin(whole, l); };
      base.l_max = 0;
      while (base.l_max < base_cap && error(base.l_max) > kBaseError) ++base.l_max;
      base.error = error(base.l_max);
      for (int c = 0; c < 3; ++c) {
        SetChannel(base, c, *spline_, white->Mix(constant[c], -slope[c]));
      }
    }

    if (coated && gltf->roughness < kMirrorRoughness) {
      kind_ = GlossKind::kMirror;
    } else if (coated) {
      const double alpha = double(gltf->roughness) * gltf->roughness;
      gloss_from(
          "ggx", gltf->roughness, {.width = alpha},
          [alpha](const Vec3d& wi, const Vec3d& wo) {
            const Vec3d h = (wi + wo).normalized();
            return GgxD(h.z(), alpha) * GgxV(wi.z(), wo.z(), alpha);
          },
          f0, f90 - f0);
    }
  }
  const bool lambertian_base = base.l_max < 0 || base.control[0].empty();
  diffuse_ = gloss.l_max < 0 && lambertian_base;
  if (!diffuse_ && lambertian_base) SplineOfLambert(base, *spline_);
}

Rgb MaterialLobes::Albedo(float cos_theta_i) const {
  if (diffuse()) return diffuse_albedo_;
  return base.Albedo(cos_theta_i) + gloss.Albedo(cos_theta_i);
}

Rgb MaterialLobes::TransmissionAlbedo(float cos_theta_i) const {
  if (fresnel_albedo_.empty()) return transmission_constant_;
  return transmission_constant_ - transmission_slope_ * FineAngle(cos_theta_i).Read(fresnel_albedo_);
}

Rgb MaterialLobes::SentOn(float cos_theta_i) const {
  const auto* gltf = std::get_if<MetallicRoughness>(&reflectance_);
  if (!sends_on() || !gltf) return Rgb::Zero();
  const Rgb fresnel = gltf->Fresnel(cos_theta_i);
  if (!glass_) return fresnel;
  return fresnel + gltf->UnderCoat(fresnel) * gltf->GlassColor();
}

}  // namespace lobe
