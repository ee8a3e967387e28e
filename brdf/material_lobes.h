#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "brdf/incidence_spline.h"
#include "brdf/knot_choice.h"
#include "brdf/lobe_recipe.h"
#include "brdf/lobe_table.h"
#include "brdf/reflectance.h"

namespace lobe {

/// What a material's gloss costs (DESIGN 3). Base, the diffuse part under it, is apart.
enum class GlossKind {
  kNone,    ///< none: Lambert's one coefficient, or a base that varies (Oren-Nayar)
  kLobe,    ///< within tolerance under the cap
  kSharp,   ///< beyond it: a capped lobe whose energy is right carries light onwards
  kMirror,  ///< no lobe, only recursion
};
const char* Name(GlossKind kind);

struct LobeOptions {
  /// Cap on the degree of a lobe, inclusive, 0..32. Memory and time per glossy node grow as
  /// (l_max+1)(l_max+2)/2. Default measured in docs/validation.md#degree.
  int l_max = 20;
  /// Flux-weighted error (0.1 = 10 %) a lobe may have; the smallest degree within it is taken (for GGX with F
  /// = 1), and the fewest knots over theta_i that add little to it. Default measured in
  /// docs/validation.md#degree.
  double error = 0.10;
  /// Gives every gloss part exactly this degree; -1: choose by error.
  int force_l_max = -1;
};

/// One part (base or gloss) of a material as lobes, three channels.
struct PartLobes {
  int l_max = -1;  ///< -1: the part is black
  /// Of the degree and knots taken, 0 when exact. Under a coat the degree is chosen on F = 1, by roughness
  /// alone; this is the error with the material's own Fresnel, larger for dielectrics. Of measured channels,
  /// which have tables of their own, the largest.
  LobeError error;
  /// Control values over the incidence spline, control[c][bin * RowCount() + Row(l, m)], m >= 0: the H_lm
  /// coefficients of the light leaving for irradiance 1 at incident azimuth 0.
  std::array<std::vector<float>, 3> control;
  /// On ScalarTable's fine grid of t: directional albedo, and what the spline's flux lacks of it. The
  /// rest is added as a constant lobe, so that the flux is right between knots too.
  std::array<std::vector<float>, 3> albedo, flux_rest;

  int count() const { return l_max < 0 ? 0 : (l_max + 1) * (l_max + 2) / 2; }
  int RowCount() const { return (l_max / 2 + 1) * ((l_max + 1) / 2 + 1); }
  /// Rows run over m for each step (l - m) / 2, so that loops over them vectorise over m.
  int Row(int l, int m) const {
    const int step = (l - m) / 2;
    return step * (l_max + 2 - step) + m;
  }
  Rgb Albedo(float cos_theta_i) const;
};

/// Tables by model and parameter, shared by the materials of one scene.
class TableCache {
 public:
  std::shared_ptr<const SchlickTables> Get(const std::string& key,
                                           const std::function<SchlickTables()>& build);
  /// The same for what has no coat's Fresnel: one table, or one a channel.
  std::shared_ptr<const std::vector<ScalarTable>> GetPlain(
      const std::string& key, const std::function<std::vector<ScalarTable>()>& build);

 private:
  std::map<std::string, std::shared_ptr<const SchlickTables>> tables_;
  std::map<std::string, std::shared_ptr<const std::vector<ScalarTable>>> plain_tables_;
};

/// Everything transport needs to know of a material's reflection and transmission.
class MaterialLobes {
 public:
  MaterialLobes(const Reflectance& reflectance, const LobeOptions& options, TableCache& cache);

  GlossKind kind() const { return kind_; }
  /// Base and gloss are Lambertian or black: nodes hold one coefficient and never meet a lobe routine.
  bool diffuse() const { return diffuse_; }
  const IncidenceSpline& spline() const { return *spline_; }  ///< common to both parts; not for diffuse()
  /// Of one lobe, base and gloss. A node keeps what it sends in all, and while solving what is unshot.
  size_t lobe_bytes() const { return 3 * sizeof(float) * size_t(base.count() + gloss.count()); }
  int max_degree() const { return std::max(base.l_max, gloss.l_max); }

  /// Directional albedo at incident cosine: base + gloss lobes. Mirror reflection is not in it, nor what
  /// glass lets on.
  Rgb Albedo(float cos_theta_i) const;
  /// Its mean over the hemisphere, weighted by the cosine: what is reflected of light that arrives alike from
  /// everywhere. Exact for diffuse() materials.
  Rgb HemisphericalAlbedo() const;
  /// Ideal glass (IsGlass), with or without a coat.
  bool glass() const { return glass_; }
  /// An opaque ideal mirror.
  bool mirror() const { return kind_ == GlossKind::kMirror && !glass_; }
  /// Some light goes on as a ray: by an ideal mirror coat, or through glass.
  bool sends_on() const { return glass_ || kind_ == GlossKind::kMirror; }
  /// Fraction that does, from outside in air; 0 unless sends_on().
  Rgb SentOn(float cos_theta_i) const;
  Rgb DiffuseAlbedo() const { return diffuse_albedo_; }  ///< reflected; for diffuse() materials

  /// Light passes to the other side. Such a material always has a base (a black one at least), since that
  /// is the part by which transmitted light leaves.
  bool transmits() const { return transmits_; }
  /// Fraction of the irradiance arriving at this cosine that leaves from the other side: the exact albedo of
  /// EvaluateTransmission. Zero if it does not transmit.
  Rgb TransmissionAlbedo(float cos_theta_i) const;

  PartLobes base, gloss;

 private:
  /// A part before its knots are known: tables of the three channels, and knots that suffice for it.
  struct Plan {
    int l_max = -1;
    std::vector<ScalarTable> channels;
    /// Those, or mixtures of them, that decide about errors.
    std::vector<ScalarTable> judged;
    int knots = 0;

    void ChooseKnots(double tolerance);
    void Fill(PartLobes& part, const IncidenceSpline& spline) const;
  };
  Plan PlanMetallicRoughnessBase(const MetallicRoughness& gltf, int cap, TableCache& cache);
  Plan PlanBase(const LobeRecipe& recipe, int cap, TableCache& cache);
  Plan PlanGloss(const LobeRecipe& recipe, int cap, const LobeOptions& options, TableCache& cache);

  GlossKind kind_ = GlossKind::kNone;
  Reflectance reflectance_;
  bool diffuse_ = true, glass_ = false;
  Rgb diffuse_albedo_ = Rgb::Zero();
  bool transmits_ = false;
  // TransmissionAlbedo is the constant less the slope times Fresnel's albedo, on ScalarTable's fine grid;
  // without a coat there is no slope, and the grid stays empty.
  Rgb transmission_constant_ = Rgb::Zero(), transmission_slope_ = Rgb::Zero();
  std::vector<float> fresnel_albedo_;
  std::shared_ptr<const IncidenceSpline> spline_;
};

}  // namespace lobe
