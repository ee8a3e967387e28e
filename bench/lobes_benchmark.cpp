// What one basis evaluation, one contribution of arriving light and one material's table cost
// (docs/validation.md#speed). The counter `ns` is CPU nanoseconds for each of them, `limits` how many times
// the multiply-add limit that is: the arithmetic that is left if nothing but it takes time, at the rate that
// PeakMultiplyAdds measures right after.

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <vector>

#include <tbb/global_control.h>

#include "bench/peak_arithmetic.h"
#include "bench/timing.h"
#include "brdf/incident_moments.h"
#include "sh/hemisphere_basis.h"
#include "sh/lobe_lanes.h"
#include "tests/support/textbook_basis.h"

namespace lobe {
namespace {

constexpr int kDirections = 16;  // evaluated together: what one packet of rays asks for
constexpr double kPi = std::numbers::pi;

/// Unit vectors that fill the hemisphere, as separate coordinates.
struct Directions {
  alignas(64) float x[kDirections], y[kDirections], z[kDirections];
  Directions() {
    for (int i = 0; i < kDirections; ++i) {
      const double c = (i + 0.5) / kDirections, s = std::sqrt(1 - c * c), phi = 2.4 * i;
      x[i] = float(s * std::cos(phi));
      y[i] = float(s * std::sin(phi));
      z[i] = float(c);
    }
  }
};

/// Runs `batch` over and over; it does `items` things with at least `multiply_adds` for each (a
/// multiplication alone counts as one). 0: no limit is told.
template <typename Batch>
void Measure(benchmark::State& state, int items, double multiply_adds, const Batch& batch) {
  const double start = CpuSeconds();
  for (auto _ : state) {
    batch();
    benchmark::ClobberMemory();
  }
  const double each = (CpuSeconds() - start) / (double(state.iterations()) * items);
  state.counters["ns"] = each * 1e9;
  if (multiply_adds > 0) state.counters["limits"] = each * PeakMultiplyAdds() / multiply_adds;
}

// --- basis ---------------------------------------------------------------------------------------------

// Per step of l three (a z^2 + b, times q, less c q'), per function one by cos or sin of m phi, and four to
// the next m.
double BasisMultiplyAdds(int l_max) {
  double sum = 0;
  for (int m = 0; m <= l_max; ++m) {
    const int functions = (l_max - m) / 2 + 1;
    sum += 3 * (functions - 1) + (m > 0 ? 2 * functions + 4 : 0);
  }
  return sum;
}

void BasisBatch(benchmark::State& state) {
  const int l_max = int(state.range(0));
  const HemisphereBasis<float> basis(l_max);
  const Directions w;
  std::vector<float> out(size_t(basis.size()) * kDirections + 16);
  float* aligned = out.data() + (64 - reinterpret_cast<uintptr_t>(out.data()) % 64) % 64 / 4;
  Measure(state, kDirections, BasisMultiplyAdds(l_max),
          [&] { basis.EvaluateBatch(w.x, w.y, w.z, kDirections, aligned); });
}

void BasisSingle(benchmark::State& state) {
  const int l_max = int(state.range(0));
  const HemisphereBasis<float> basis(l_max);
  const Directions w;
  std::vector<float> out(basis.size());
  Measure(state, kDirections, BasisMultiplyAdds(l_max), [&] {
    for (int i = 0; i < kDirections; ++i) basis.Evaluate(w.x[i], w.y[i], w.z[i], out.data());
  });
}

void BasisTextbook(benchmark::State& state) {
  const int l_max = int(state.range(0));
  const test::TextbookBasis<float> basis(l_max);
  const Directions w;
  std::vector<float> out(CoefficientCount(l_max));
  Measure(state, kDirections, BasisMultiplyAdds(l_max), [&] {
    for (int i = 0; i < kDirections; ++i) basis.Evaluate(w.x[i], w.y[i], w.z[i], out.data());
  });
}

// Three channels of one lobe, read without writing the basis down: per function one for each channel instead.
void LobeRead(benchmark::State& state) {
  const int l_max = int(state.range(0));
  const LobeLanes lanes(l_max);
  const Directions w;
  std::vector<float> lobe(size_t(3) * CoefficientCount(l_max), 0.3f);
  alignas(64) float out[3 * kLanes] = {};
  double multiply_adds = BasisMultiplyAdds(l_max) - (l_max + 1) * (l_max + 2) / 2;
  multiply_adds += 3 * CoefficientCount(l_max) + 6 * (l_max + 1);
  Measure(state, kLanes, multiply_adds, [&] { lanes.Add(lobe.data(), l_max, w.x, w.y, w.z, out); });
}

// --- arriving light ------------------------------------------------------------------------------------

MetallicRoughness Metal(float roughness) {
  MetallicRoughness m;
  m.base_color = Rgb(0.9f, 0.8f, 0.7f);
  m.roughness = roughness;
  return m;
}

MaterialLobes MetalLobes(int l_max) {
  TableCache cache;
  LobeOptions options;
  options.force_l_max = l_max;
  return MaterialLobes(Metal(0.4f), options, cache);
}

// cos and sin of m phi, their product with three channels, and both into four bins of the spline.
double MomentMultiplyAdds(int l_max) { return 4 * l_max + 3 * 2 * (l_max + 1) * (1 + 4); }

void AddOne(benchmark::State& state) {
  const MaterialLobes material = MetalLobes(int(state.range(0)));
  const Directions w;
  IncidentMoments moments;
  moments.Start(material);
  Measure(state, kDirections, MomentMultiplyAdds(material.max_degree()), [&] {
    for (int i = 0; i < kDirections; ++i) moments.Add(Vec3(w.x[i], w.y[i], w.z[i]), Rgb(0.2f, 0.3f, 0.5f));
  });
}

void AddRing(benchmark::State& state) {
  constexpr int kCount = 64;
  const MaterialLobes material = MetalLobes(int(state.range(0)));
  std::vector<float> planes(3 * kCount);
  for (size_t i = 0; i < planes.size(); ++i) planes[i] = float(1 + std::sin(2.3 * double(i)));
  IncidentMoments moments;
  moments.Start(material);
  Measure(state, kCount, 0, [&] { moments.AddRing(0.6f, planes.data(), kCount, 0.3f); });
}

// Without moments: the table is met by every contribution. The lobe at theta_i from four bins of the spline,
// turned by phi_i, times each channel, onto the coefficients.
void AddTextbook(benchmark::State& state) {
  const MaterialLobes material = MetalLobes(int(state.range(0)));
  const PartLobes& part = material.gloss;
  const int l_max = part.l_max, rows = part.RowCount();
  const Directions w;
  std::vector<float> out(size_t(3) * part.count()), lobe(rows);
  const Rgb irradiance(0.2f, 0.3f, 0.5f);
  Measure(state, kDirections, 0, [&] {
    for (int i = 0; i < kDirections; ++i) {
      const auto stencil = material.spline().At(w.z[i]);
      const float s = std::hypot(w.x[i], w.y[i]), cos_phi = w.x[i] / s, sin_phi = w.y[i] / s;
      for (int c = 0; c < 3; ++c) {
        const float* control = part.control[c].data();
        for (int row = 0; row < rows; ++row) {
          lobe[row] = 0;
          for (int k = 0; k < 4; ++k)
            lobe[row] += stencil.weight[k] * control[size_t(stencil.bin[k]) * rows + row];
        }
        float* to = out.data() + size_t(c) * part.count();
        float cosine = irradiance[c], sine = 0;
        for (int m = 0; m <= l_max; ++m) {
          for (int l = m; l <= l_max; l += 2) {
            const float value = lobe[part.Row(l, m)];
            to[CoefficientIndex(l, m)] += value * cosine;
            if (m > 0) to[CoefficientIndex(l, -m)] += value * sine;
          }
          const float turned = cosine * cos_phi - sine * sin_phi;
          sine = cosine * sin_phi + sine * cos_phi;
          cosine = turned;
        }
      }
    }
  });
}

// --- tables --------------------------------------------------------------------------------------------

// A material's lobes at l_max 12, tables and all, on one core.
void Build(benchmark::State& state, const Reflectance& reflectance) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  LobeOptions options;
  options.force_l_max = 12;
  Measure(state, 1, 0, [&] {
    TableCache cache;
    benchmark::DoNotOptimize(MaterialLobes(reflectance, options, cache));
  });
}

// The same when another material of this roughness came before.
void BuildAgain(benchmark::State& state, const Reflectance& reflectance) {
  LobeOptions options;
  options.force_l_max = 12;
  TableCache cache;
  const MaterialLobes first(reflectance, options, cache);
  Measure(state, 1, 0, [&] { benchmark::DoNotOptimize(MaterialLobes(reflectance, options, cache)); });
}

MetallicRoughness Plastic(float roughness) {
  MetallicRoughness m = Metal(roughness);
  m.metallic = 0;
  return m;
}

#define LOBE_DEGREES Arg(4)->Arg(8)->Arg(12)->Arg(20)->Arg(32)
BENCHMARK(BasisBatch)->LOBE_DEGREES;
BENCHMARK(BasisSingle)->LOBE_DEGREES;
BENCHMARK(BasisTextbook)->LOBE_DEGREES;
BENCHMARK(LobeRead)->LOBE_DEGREES;
BENCHMARK(AddOne)->LOBE_DEGREES;
BENCHMARK(AddRing)->LOBE_DEGREES;
BENCHMARK(AddTextbook)->LOBE_DEGREES;
BENCHMARK_CAPTURE(Build, metal_roughness_0_2, Metal(0.2f))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Build, metal_roughness_0_4, Metal(0.4f))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Build, plastic_roughness_0_4, Plastic(0.4f))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Build, phong_20, Phong{Rgb::Constant(0.5f), 20})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Build, ward_0_2, Ward{Rgb::Constant(0.5f), 0.2f})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Build, cook_torrance_0_2, CookTorrance{Rgb::Constant(0.5f), 0.2f})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Build, ashikhmin_shirley_200,
                  AshikhminShirley{Rgb::Constant(0.5f), Rgb::Constant(0.5f), 200})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BuildAgain, metal_roughness_0_4, Metal(0.4f))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BuildAgain, plastic_roughness_0_4, Plastic(0.4f))->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lobe

BENCHMARK_MAIN();
