#include "brdf/material_lobes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/lobe.h"
#include "sh/quadrature.h"
#include "sh/zernike.h"

namespace lobe {
namespace {

// The base under a coat is smooth: this degree leaves less than kBaseError of it out
// (docs/validation.md#base).
constexpr int kBaseDegreeCap = 8;
constexpr double kBaseError = 0.01;

// What is lost between knots may be this share of what may be lost in all. Squares add up, so that a tenth
// raises an error by half a percent of it (docs/validation.md#knots).
constexpr double kKnotShare = 0.1;
const double kTruncationShare = std::sqrt(1 - kKnotShare * kKnotShare);
// Lobes that lose less than this by truncation need no knots to match.
constexpr double kLeastError = 0.002;

std::string TableKey(const std::string& recipe, int l_max) { return recipe + " to " + std::to_string(l_max); }

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

// A part from the tables of its channels, which are read up to part.l_max.
void SetChannels(PartLobes& part, const IncidenceSpline& spline, const std::vector<ScalarTable>& channels) {
  const int l_max = part.l_max;
  const ZernikeTransform transform(l_max);
  const KnotChoice knots(channels[0].knots);
  const Eigen::MatrixXd to_knots[2] = {knots.ToKnots(spline, false), knots.ToKnots(spline, true)};
  for (int channel = 0; channel < 3; ++channel) {
    const ScalarTable& table = channels[channel];
    auto& control = part.control[channel];
    control.assign(size_t(spline.bins()) * part.RowCount(), 0.0f);
    for (int m = 0; m <= l_max; ++m) {
      const int size = (l_max - m) / 2 + 1;
      Eigen::MatrixXd values(table.knots, size);
      for (int n = 0; n < size; ++n) {
        values.col(n) = table.zernike.row(ScalarTable::RowIndex(m + 2 * n, m)).transpose();
      }
      const Eigen::MatrixXd at_knots = to_knots[m % 2] * values;
      const Eigen::MatrixXd bins =
          spline.ControlValues(at_knots * transform.ToHemisphereBlock(m).transpose(), m % 2 == 1);
      for (int l = 0; l < size; ++l) {
        for (int bin = 0; bin < spline.bins(); ++bin) {
          control[size_t(bin) * part.RowCount() + part.Row(m + 2 * l, m)] = float(bins(bin, l));
        }
      }
    }
    const Eigen::VectorXd flux = std::sqrt(std::numbers::pi) * to_knots[0] * table.zernike.row(0).transpose();
    part.flux_rest[channel] = FluxRest(spline, flux, table.albedo);
    part.albedo[channel].resize(table.albedo.size());
    for (int i = 0; i < table.albedo.size(); ++i) part.albedo[channel][i] = float(table.albedo[i]);
  }
}

Rgb LambertPart(PartLobes& part, const Rgb& albedo) {
  part.l_max = 0;
  part.error = {};
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

// The smallest degree that leaves room for the knots' share; `most` if none does.
int DegreeWithin(const ScalarTable& table, int most, double tolerance) {
  int l = 0;
  while (l < most && table.Error(l) > kTruncationShare * tolerance) ++l;
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

std::shared_ptr<const std::vector<ScalarTable>> TableCache::GetPlain(
    const std::string& key, const std::function<std::vector<ScalarTable>()>& build) {
  auto& tables = plain_tables_[key];
  if (!tables) tables = std::make_shared<std::vector<ScalarTable>>(build());
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

  Plan base_plan;
  if (const auto* lambert = std::get_if<Lambert>(&reflectance)) {
    diffuse_albedo_ = LambertPart(base, lambert->albedo);
  } else if (const auto* gltf = std::get_if<MetallicRoughness>(&reflectance)) {
    base_plan = PlanMetallicRoughnessBase(*gltf, base_cap, cache);
  } else if (const auto* oren = std::get_if<OrenNayar>(&reflectance); oren && oren->sigma == 0) {
    diffuse_albedo_ = LambertPart(base, oren->albedo);
  }
  if (const auto recipe = BaseRecipe(reflectance)) base_plan = PlanBase(*recipe, base_cap, cache);
  Plan gloss_plan;
  if (const auto recipe = GlossRecipe(reflectance)) gloss_plan = PlanGloss(*recipe, cap, options, cache);
  base_plan.ChooseKnots(kBaseError);
  gloss_plan.ChooseKnots(options.error);
  spline_ = std::make_shared<IncidenceSpline>(
      std::max({IncidenceSpline::kFewestKnots, base_plan.knots, gloss_plan.knots}));
  base_plan.Fill(base, *spline_);
  gloss_plan.Fill(gloss, *spline_);

  const bool lambertian_base = base.l_max < 0 || base.control[0].empty();
  diffuse_ = gloss.l_max < 0 && lambertian_base;
  if (!diffuse_ && lambertian_base) SplineOfLambert(base, *spline_);
}

void MaterialLobes::Plan::ChooseKnots(double tolerance) {
  for (const ScalarTable& table : judged) {
    const KnotChoice choice(table.knots);
    const double truncated = table.Error(l_max);
    int enough =
        choice.Fewest(table, l_max, kKnotShare * std::min(tolerance, std::max(truncated, kLeastError)));
    // Where truncation and knots err at different angles their averages add up to a little more.
    if (truncated <= kTruncationShare * tolerance) {
      while (enough < choice.MostMeasured() && choice.Measure(table, l_max, enough).total > tolerance)
        ++enough;
    }
    knots = std::max(knots, enough);
  }
}

void MaterialLobes::Plan::Fill(PartLobes& part, const IncidenceSpline& spline) const {
  if (l_max < 0) return;
  part.l_max = l_max;
  for (const ScalarTable& table : judged) {
    const LobeError error = KnotChoice(table.knots).Measure(table, l_max, spline.knots());
    if (error.total >= part.error.total) part.error = error;
  }
  SetChannels(part, spline, channels);
}

// The base of glTF: c_diff / pi (1 - F), F = f0 + (f90 - f0)(1 - V.H)^5 (of the largest channel with
// KHR_materials_specular). A constant and one universal table. What passes to the other side is weighed by
// the same coat, so its albedo comes from the same table.
MaterialLobes::Plan MaterialLobes::PlanMetallicRoughnessBase(const MetallicRoughness& gltf, int cap,
                                                             TableCache& cache) {
  const Rgb f0 = gltf.F0();
  const float f90 = gltf.F90();
  const bool coated = (f0 > 0).any() || f90 > 0;
  const Rgb diffuse = gltf.DiffuseColor(), passed = gltf.TransmissionColor();
  const Rgb f0_base = gltf.has_specular ? Rgb::Constant(f0.maxCoeff()) : f0;
  const Rgb constant = diffuse * (1 - f0_base), slope = diffuse * (f90 - f0_base);
  if (coated && gltf.roughness < kMirrorRoughness) kind_ = GlossKind::kMirror;
  transmits_ = Transmits(reflectance_);
  transmission_constant_ = passed * (1 - f0_base);
  transmission_slope_ = passed * (f90 - f0_base);
  const bool sloped_transmission = transmits_ && (transmission_slope_.abs() >= 1e-7f).any();
  const bool sloped = (slope.abs() >= 1e-7f).any();
  std::shared_ptr<const SchlickTables> white;
  if (sloped || sloped_transmission) {
    white = cache.Get(TableKey("lambert", kBaseDegreeCap), [&] {
      return SchlickTables::Build([](const Vec3d&, const Vec3d&) { return 1.0 / std::numbers::pi; },
                                  kBaseDegreeCap, HalfVectorRule{.width = 1.0});
    });
  }
  if (sloped_transmission) {
    for (const double albedo : white->rising.albedo) fresnel_albedo_.push_back(float(albedo));
  }
  if (!sloped) {
    if ((diffuse > 0).any() || !coated || transmits_) diffuse_albedo_ = LambertPart(base, constant);
    return {};
  }
  // The steepest channel decides.
  int steepest = 0;
  (slope / constant.max(1e-6f)).maxCoeff(&steepest);
  Plan plan;
  for (int c = 0; c < 3; ++c) plan.channels.push_back(white->Mix(constant[c], -slope[c]));
  plan.judged.push_back(plan.channels[steepest]);
  plan.l_max = DegreeWithin(plan.judged[0], cap, kBaseError);
  return plan;
}

MaterialLobes::Plan MaterialLobes::PlanBase(const LobeRecipe& recipe, int cap, TableCache& cache) {
  const auto tables = cache.GetPlain(TableKey(recipe.key, kBaseDegreeCap), [&] {
    ScalarTable built = ScalarTable::Build(recipe.f, kBaseDegreeCap, recipe.rule);
    for (int i = 0; recipe.albedo && i <= ScalarTable::kFine; ++i) {
      built.albedo[i] = recipe.albedo(IncidenceSpline::CosineOfParameter(double(i) / ScalarTable::kFine));
    }
    return std::vector<ScalarTable>{std::move(built)};
  });
  Plan plan;
  plan.judged = *tables;
  plan.l_max = DegreeWithin(plan.judged[0], cap, kBaseError);
  for (int c = 0; c < 3; ++c) plan.channels.push_back(plan.judged[0].Scaled(recipe.plain[c]));
  return plan;
}

MaterialLobes::Plan MaterialLobes::PlanGloss(const LobeRecipe& recipe, int cap, const LobeOptions& options,
                                             TableCache& cache) {
  const std::string key = TableKey(recipe.key, cap);
  const bool forced = options.force_l_max >= 0;
  bool within = true;
  Plan plan;
  const auto raise_degree = [&](const ScalarTable& f) {
    const int degree = forced ? cap : DegreeWithin(f, cap, options.error);
    plan.l_max = std::max(plan.l_max, degree);
    within = within && f.Error(degree) <= kTruncationShare * options.error;
  };
  if (recipe.channels) {
    plan.channels =
        *cache.GetPlain(key, [&] { return ScalarTable::BuildChannels(recipe.channels, cap, recipe.rule); });
    plan.judged = plan.channels;
    for (const ScalarTable& channel : plan.channels) raise_degree(channel);
  } else {
    const auto tables = cache.Get(key, [&] { return SchlickTables::Build(recipe.f, cap, recipe.rule); });
    // Degree and kind follow from f alone, so that colours share tables. Knots, and the error stated, are the
    // material's own: a dielectric's is larger, since Schlick's rise leaves most of its gloss at grazing
    // angles.
    raise_degree(tables->plain);
    plan.judged.push_back(tables->Mix(recipe.plain.mean(), recipe.rising.mean()));
    for (int c = 0; c < 3; ++c) plan.channels.push_back(tables->Mix(recipe.plain[c], recipe.rising[c]));
  }
  kind_ = within || forced ? GlossKind::kLobe : GlossKind::kSharp;
  return plan;
}

Rgb MaterialLobes::Albedo(float cos_theta_i) const {
  if (diffuse()) return diffuse_albedo_;
  return base.Albedo(cos_theta_i) + gloss.Albedo(cos_theta_i);
}

Rgb MaterialLobes::HemisphericalAlbedo() const {
  if (diffuse()) return diffuse_albedo_;
  // Chosen: grazing angles, where albedos bend most, weigh little; 32 points and 64 agree to 1e-4.
  const GaussLegendre cosine(32, 0, 1);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (size_t i = 0; i < cosine.nodes.size(); ++i) {
    sum += 2 * cosine.weights[i] * cosine.nodes[i] * Albedo(float(cosine.nodes[i])).cast<double>();
  }
  return sum.cast<float>();
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
