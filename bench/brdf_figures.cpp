#include "bench/brdf_figures.h"

#include <cstdio>
#include <string>
#include <vector>

#include <tbb/global_control.h>

#include "bench/timing.h"
#include "brdf/lobe_accuracy.h"

namespace lobe {
namespace {

MetallicRoughness Ggx(float roughness) {  // F = 1
  MetallicRoughness m;
  m.roughness = roughness;
  return m;
}

MetallicRoughness Dielectric(float roughness) {
  MetallicRoughness m = Ggx(roughness);
  m.metallic = 0;
  return m;
}

std::vector<Reflectance> Models() {
  const Rgb white = Rgb::Constant(1), half = Rgb::Constant(0.5f);
  std::vector<Reflectance> models;
  for (const float roughness : {1.0f, 0.7f, 0.5f, 0.4f, 0.3f, 0.2f, 0.1f}) models.push_back(Ggx(roughness));
  for (const float roughness : {0.6f, 0.3f}) models.push_back(Dielectric(roughness));
  for (const float exponent : {5.0f, 20.0f, 200.0f}) models.push_back(Phong{white, exponent});
  for (const float exponent : {20.0f, 200.0f}) models.push_back(BlinnPhong{white, exponent});
  for (const float alpha : {0.4f, 0.2f, 0.1f}) models.push_back(Ward{white, alpha});
  for (const float alpha : {0.4f, 0.2f}) models.push_back(CookTorrance{white, alpha});
  for (const float exponent : {20.0f, 200.0f}) models.push_back(AshikhminShirley{half, half, exponent});
  models.push_back(OrenNayar{half, 0.5f});
  models.push_back(Plastic(half, 1.5f, 0.4f));
  return models;
}

/// CPU time of making a material's lobes from nothing; call on one thread.
double BuildMilliseconds(const Reflectance& r, const LobeOptions& options) {
  std::vector<double> milliseconds;
  for (int run = 0; run < 5; ++run) {
    const double start = CpuSeconds();
    TableCache cache;
    MaterialLobes(r, options, cache);
    milliseconds.push_back(1e3 * (CpuSeconds() - start));
  }
  return Median(milliseconds);
}

void PrintRow(const Reflectance& r, const AccuracyMeter& meter, BrdfPart part, const LobeOptions& options) {
  TableCache cache;
  const MaterialLobes lobes(r, options, cache);
  const LobeAccuracy a = meter.Measure(lobes);
  std::printf(" %d | %.2f %% | %.2f %% | %.3f %% | %.1f %% | %.2f %% | %.0e | %d | %.1f |\n",
              part == BrdfPart::kGloss ? lobes.gloss.l_max : lobes.base.l_max, 100 * a.error.total,
              100 * a.error.truncated, 100 * a.error.between, 100 * a.worst, 100 * a.negative, a.albedo_error,
              lobes.spline().knots(), BuildMilliseconds(r, options));
}

constexpr const char* kColumns =
    " l_max | error | of it truncation | between knots | worst angle | negative part | albedo error | knots "
    "| "
    "build, ms |\n";

}  // namespace

void BrdfFigures() {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  std::printf("| model |%s|---|---|---|---|---|---|---|---|---|---|\n", kColumns);
  for (const Reflectance& r : Models()) {
    TableCache cache;
    const BrdfPart part = JudgedPart(MaterialLobes(r, LobeOptions{}, cache));
    const AccuracyMeter meter(r, part);
    if (part == BrdfPart::kBase) {  // has a degree of its own
      std::printf("| %s, base |", Describe(r).c_str());
      PrintRow(r, meter, part, LobeOptions{});
      continue;
    }
    for (const int l_max : {4, 8, 12, 16, 24, 32}) {
      std::printf("| %s |", Describe(r).c_str());
      PrintRow(r, meter, part, LobeOptions{.force_l_max = l_max});
    }
  }
}

void LobeErrorFigures() {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  std::printf("| model | asked |%s|---|---|---|---|---|---|---|---|---|---|---|\n", kColumns);
  for (const Reflectance& r : Models()) {
    TableCache cache;
    const BrdfPart part = JudgedPart(MaterialLobes(r, LobeOptions{}, cache));
    if (part == BrdfPart::kBase) continue;
    const AccuracyMeter meter(r, part);
    for (const double error : {0.2, 0.1, 0.02}) {
      std::printf("| %s | %g %% |", Describe(r).c_str(), 100 * error);
      PrintRow(r, meter, part, LobeOptions{.l_max = 32, .error = error});
    }
  }
}

}  // namespace lobe
