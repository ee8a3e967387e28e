// Prints the figures of docs/validation.md as Markdown: figures TOPIC. Topics are listed without one.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <tbb/global_control.h>

#include "bench/brdf_figures.h"
#include "bench/timing.h"
#include "bench/topics.h"
#include "brdf/frame.h"
#include "render/path_tracing.h"
#include "scene/gltf_scene.h"
#include "scene/refine.h"
#include "scene/sample_points.h"
#include "sh/lobe.h"
#include "sh/zernike.h"
#include "solver/exposure.h"
#include "solver/hash.h"
#include "solver/shooting.h"
#include "solver/solver.h"
#include "tests/support/adaptive_albedo.h"
#include "tests/support/block_z_scores.h"
#include "tests/support/gloss_furnace.h"
#include "tests/support/metal.h"
#include "tests/support/scene_builder.h"
#include "tests/support/truth.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;
const std::string kTests = "tests";  // run from the project's root
const char* const kBoxes[] = {"cornell_diffuse", "cornell_glossy"};

ScalarTable GgxTable(double roughness, int l_max) {
  const double a = roughness * roughness;
  return ScalarTable::Build(
      [a](const Vec3d& wi, const Vec3d& wo) {
        const Vec3d h = (wi + wo).normalized();
        return GgxD(h.z(), a) * GgxV(wi.z(), wo.z(), a);
      },
      l_max, HalfVectorRule{.width = a});
}

MetallicRoughness Metal(float roughness) { return test::Metal(roughness, Rgb::Constant(0.9f)); }

// --- sphere and tables -------------------------------------------------------------------------------

void Basis() {
  std::printf("| l_max | orthonormality, double | worst float - double |\n|---|---|---|\n");
  for (const int l_max : {4, 8, 16, 32, 48, 64}) {
    const HemisphereBasis<double> exact(l_max);
    const HemisphereBasis<float> single(l_max);
    const HemisphereQuadrature rule(l_max);
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(exact.size(), exact.size());
    Eigen::VectorXd h(exact.size());
    std::vector<float> f(exact.size());
    double worst = 0;
    for (size_t i = 0; i < rule.weights.size(); ++i) {
      const Eigen::Vector3f w = rule.directions[i].cast<float>();
      single.Evaluate(w.x(), w.y(), w.z(), f.data());
      exact.Evaluate(double(w.x()), double(w.y()), double(w.z()), h.data());
      for (int k = 0; k < exact.size(); ++k) worst = std::max(worst, std::abs(double(f[k]) - h[k]));
      const Vec3d& d = rule.directions[i];
      exact.Evaluate(d.x(), d.y(), d.z(), h.data());
      gram.selfadjointView<Eigen::Lower>().rankUpdate(h, rule.weights[i]);
    }
    gram.diagonal().array() -= 1;
    std::printf("| %d | %.1e | %.1e |\n", l_max,
                gram.triangularView<Eigen::Lower>().toDenseMatrix().cwiseAbs().maxCoeff(), worst);
  }
  const Eigen::MatrixXd lobe = Eigen::MatrixXd::Random(CoefficientCount(24), 3);
  double flux = 0;
  for (int l = 0; l < 24; ++l) {
    flux = std::max(flux, (LobeFlux(ChangeDegree(lobe, l)) - LobeFlux(lobe)).cwiseAbs().maxCoeff());
  }
  std::printf("\nChange of degree from 24 to 0..23, worst change of flux: %.1e\n", flux);
}

void Degree() {
  const int degrees[] = {4, 6, 8, 12, 16, 20, 24, 32};
  std::printf("| roughness |");
  for (const int l : degrees) std::printf(" l_max %d (%d) |", l, CoefficientCount(l));
  std::printf("\n|---|---|---|---|---|---|---|---|---|\n");
  for (const double roughness : {1.0, 0.7, 0.6, 0.5, 0.4, 0.35, 0.3, 0.2, 0.1}) {
    const auto table = GgxTable(roughness, 32);
    std::printf("| %.2f |", roughness);
    for (const int l : degrees) std::printf(" %.1f %% |", 100 * table.Error(l));
    std::printf("\n");
  }
}

// Flux of the lobes against an adaptive quadrature that shares nothing with brdf/.
void Flux() {
  struct Model {
    const char* name;
    Reflectance reflectance;
    double width;
  };
  std::vector<Model> models;
  for (const float roughness : {0.05f, 0.1f, 0.2f, 0.3f, 0.5f, 0.7f, 1.0f}) {
    models.push_back({"metal,", Metal(roughness), double(roughness) * roughness});
  }
  MetallicRoughness coat = Metal(0.3f);
  coat.metallic = 0;
  models.push_back({"dielectric,", coat, 0.09});
  for (const float n : {5.0f, 20.0f, 200.0f})
    models.push_back({"", Phong{Rgb::Constant(1), n}, 1 / std::sqrt(n + 1.0)});
  for (const float a : {0.1f, 0.4f}) models.push_back({"", Ward{Rgb::Constant(1), a}, a});
  std::printf(
      "| model | at knots, worst | between knots to 89 degrees, worst of l_max 0, 6, 12, 24 "
      "|\n|---|---|---|\n");
  TableCache cache;
  for (const Model& model : models) {
    const ScalarBrdf gloss = [&](const Vec3d& a, const Vec3d& b) {
      return double(EvaluateGloss(model.reflectance, a, b)[0]);
    };
    const ScalarBrdf base = [&](const Vec3d& a, const Vec3d& b) {
      return double(EvaluateBase(model.reflectance, a, b)[0]);
    };
    const auto table = ScalarTable::Build(gloss, 0, HalfVectorRule{.width = model.width}, 24);
    const IncidenceSpline spline(24);
    double at_knots = 0, between = 0;
    for (int k = 0; k < 23; k += 2) {
      at_knots = std::max(at_knots, std::abs(std::sqrt(kPi) * table.zernike(0, k) -
                                             test::AdaptiveAlbedo(gloss, spline.KnotCosine(k), model.width)));
    }
    for (const double degrees : {2.0, 17.0, 38.0, 55.5, 69.0, 79.0, 85.2, 88.0, 89.0}) {
      const double c = std::cos(degrees * kPi / 180), s = std::sqrt(1 - c * c);
      double exact = test::AdaptiveAlbedo(gloss, c, model.width);
      if (EvaluateBase(model.reflectance, Vec3d(0, 0, 1), Vec3d(0, 0, 1))[0] > 0)
        exact += test::AdaptiveAlbedo(base, c, 1);
      for (const int l_max : {0, 6, 12, 24}) {
        LobeOptions options;
        options.force_l_max = l_max;
        const MaterialLobes material(model.reflectance, options, cache);
        IncidentMoments moments;
        moments.Start(material);
        moments.Add(Vec3(float(0.6 * s), float(0.8 * s), float(c)), Rgb::Constant(1));
        Eigen::MatrixXf b = Eigen::MatrixXf::Zero(material.base.count(), 3),
                        g = Eigen::MatrixXf::Zero(material.gloss.count(), 3);
        moments.Finish(b.data(), g.data());
        double flux = LobeFlux(g.cast<double>())(0);
        if (b.rows() > 0) flux += LobeFlux(b.cast<double>())(0);
        between = std::max(between, std::abs(flux - exact));
      }
    }
    std::printf("| %s %s | %.0e | %.0e |\n", model.name, Describe(model.reflectance).c_str(), at_knots,
                between);
  }
}

// Between knots: the spline's lobe against a projection made at that angle, cos-weighted relative L2, and its
// flux before the rest is added.
void Knots() {
  std::printf(
      "| roughness | l_max | knots | worst flux error before the rest | worst lobe error to 85 degrees |\n"
      "|---|---|---|---|---|\n");
  for (const double roughness : {1.0, 0.5, 0.3}) {
    for (const int l_max : {12, 20}) {
      for (const int knots : {12, 16, 24, 36}) {
        const double a = roughness * roughness;
        const ScalarBrdf f = [a](const Vec3d& wi, const Vec3d& wo) {
          const Vec3d h = (wi + wo).normalized();
          return GgxD(h.z(), a) * GgxV(wi.z(), wo.z(), a);
        };
        const auto table = ScalarTable::Build(f, l_max, HalfVectorRule{.width = a}, knots);
        // A table with many knots holds the truth at angles between ours.
        const int fine = 4 * (knots - 1) + 1;
        const auto truth = ScalarTable::Build(f, l_max, HalfVectorRule{.width = a}, fine);
        const IncidenceSpline spline(knots), fine_spline(fine);
        double flux = 0, error = 0;
        for (int j = 0; j < fine; ++j) {
          const double c = fine_spline.KnotCosine(j);
          const auto s = spline.At(float(c));
          Eigen::VectorXd z = Eigen::VectorXd::Zero(table.zernike.rows());
          for (int n = 0; n <= l_max; ++n) {
            for (int m = n % 2; m <= n; m += 2) {
              const int row = ScalarTable::RowIndex(n, m);
              const Eigen::MatrixXd control =
                  spline.ControlValues(table.zernike.row(row).transpose(), m % 2 == 1);
              for (int k = 0; k < 4; ++k) {
                z[row] += (k == 0 && s.mirrored && m % 2 == 1 ? -1 : 1) * s.weight[k] * control(s.bin[k], 0);
              }
            }
          }
          flux = std::max(flux, std::sqrt(kPi) * std::abs(z[0] - truth.zernike(0, j)));
          if (c > std::cos(85 * kPi / 180)) {
            error = std::max(error, (z - truth.zernike.col(j)).norm() / std::sqrt(truth.norm2[j]));
          }
        }
        std::printf("| %.1f | %d | %d | %.1e | %.2f %% |\n", roughness, l_max, knots, flux, 100 * error);
      }
    }
  }
}

// Lobes of a material from nothing, on one thread.
void Tables() {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  MetallicRoughness plastic = Metal(0.4f);
  plastic.metallic = 0;
  const Reflectance models[] = {Metal(1.0f),
                                Metal(0.4f),
                                Metal(0.2f),
                                plastic,
                                Phong{Rgb::Constant(0.8f), 20},
                                Ward{Rgb::Constant(0.8f), 0.2f}};
  std::printf("| model | l_max 8, ms | l_max 12, ms | l_max 20, ms |\n|---|---|---|---|\n");
  const auto row = [](const std::string& name, const std::vector<Reflectance>& materials) {
    std::printf("| %s |", name.c_str());
    for (const int l_max : {8, 12, 20}) {
      std::vector<double> milliseconds;
      for (int run = 0; run < 5; ++run) {
        const double start = CpuSeconds();
        TableCache cache;
        for (const Reflectance& r : materials) MaterialLobes(r, LobeOptions{.l_max = l_max}, cache);
        milliseconds.push_back(1e3 * (CpuSeconds() - start));
      }
      std::printf(" %.1f |", Median(milliseconds));
    }
    std::printf("\n");
  };
  for (const Reflectance& model : models) row(Describe(model), {model});
  std::vector<Reflectance> box;
  for (const auto& m : ReadGltfScene(kTests + "/scenes/cornell_glossy.glb").materials)
    box.push_back(m.reflectance);
  row("all of cornell_glossy", box);
}

// --- directions --------------------------------------------------------------------------------------

// Moments of arriving light, one thread: contributions one by one against rings of them.
void Accumulation() {
  constexpr int kCount = 64, kRings = 24, kRepeats = 400;
  std::printf(
      "| l_max | Add, ns a contribution | AddRing of %d, ns a contribution | ratio |\n|---|---|---|---|\n",
      kCount);
  TableCache cache;
  for (const int l_max : {8, 12, 20}) {
    LobeOptions options;
    options.force_l_max = l_max;
    const MaterialLobes material(Metal(0.4f), options, cache);
    std::vector<float> planes(3 * kCount), out(size_t(3) * kMaxBasisSize);
    for (size_t i = 0; i < planes.size(); ++i) planes[i] = float(1 + std::sin(2.3 * double(i)));
    std::vector<Vec3> directions;
    for (int ring = 0; ring < kRings; ++ring) {
      const double c = (ring + 0.5) / kRings, s = std::sqrt(1 - c * c);
      for (int j = 0; j < kCount; ++j) {
        const double phi = 0.1 * ring + 2 * kPi * j / kCount;
        directions.emplace_back(float(s * std::cos(phi)), float(s * std::sin(phi)), float(c));
      }
    }
    IncidentMoments moments;
    const auto time = [&](auto&& add_ring) {
      moments.Start(material);
      const double start = CpuSeconds();
      for (int repeat = 0; repeat < kRepeats; ++repeat) {
        for (int ring = 0; ring < kRings; ++ring) add_ring(ring);
      }
      const double seconds = CpuSeconds() - start;
      moments.Finish(nullptr, out.data());
      return seconds / (double(kRepeats) * kRings * kCount) * 1e9;
    };
    std::vector<double> single, whole, ratio;
    for (int run = 0; run < 5; ++run) {
      single.push_back(time([&](int ring) {
        for (int j = 0; j < kCount; ++j) {
          moments.Add(directions[ring * kCount + j],
                      Rgb(planes[j], planes[kCount + j], planes[2 * kCount + j]));
        }
      }));
      whole.push_back(time([&](int ring) {
        moments.AddRing(directions[ring * kCount].z(), planes.data(), kCount, 0.1f * float(ring));
      }));
      ratio.push_back(single.back() / whole.back());
    }
    std::printf("| %d | %.0f | %.1f | %.0f |\n", l_max, Median(single), Median(whole), Median(ratio));
  }
}

// --- mesh ------------------------------------------------------------------------------------------------

// A box of one and a half million elements, some of them asked for by chance.
void RefinementSpeed() {
  const Scene scene = ReadGltfScene(kTests + "/scenes/cornell_diffuse.glb");
  const TessellateOptions options{.max_edge = 0.035f};
  const double start = CpuSeconds();
  const Mesh mesh = Tessellate(scene, options);
  std::printf("Tessellate: %zu elements, %.2f CPU s\n\n", mesh.element_count(), CpuSeconds() - start);
  std::printf("| asked for | elements after | RefineMesh, CPU s | us per element | of it sample points |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const double share : {0.0, 0.01, 0.1, 1.0}) {
    std::vector<float> priority(mesh.element_count());
    RandomStream random(Mix(1));
    for (float& p : priority) p = random.Next() < share ? 1.0f : 0.0f;
    const double t0 = CpuSeconds();
    Refinement r = RefineMesh(scene, mesh, priority, options, size_t{1} << 30);
    const double t1 = CpuSeconds();
    PlaceSamplePoints(&r.mesh, options.border_inset);
    const double t2 = CpuSeconds(), count = double(r.mesh.element_count());
    std::printf("| %g %% | %.0f | %.2f | %.2f | %.2f |\n", 100 * share, count, t1 - t0,
                1e6 * (t1 - t0) / count, 1e6 * (t2 - t1) / count);
  }
}

// Path and shadow rays as paths trace them, in turn: directions by the cosine, targets evenly over the lamps'
// triangles.
void RecordRays(const Scene& scene, const RayTracer& tracer, std::vector<Ray>* path,
                std::vector<Ray>* shadow) {
  std::vector<uint32_t> lamps;
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    if (scene.material(scene.faces[f]).emits()) lamps.push_back(f);
  }
  RandomStream random(5);
  const Camera& camera = scene.cameras[0];
  while (path->size() < 300000) {
    Ray ray = CameraView(camera, 256, 256).EyeRay(256 * random.Next(), 256 * random.Next());
    for (int bounce = 0; bounce < 12; ++bounce) {
      const RayHit hit = tracer.Intersect(ray);
      if (!hit.hit() || hit.side == Side::kBack) break;
      const auto p = scene.Corners(scene.faces[hit.face]);
      const Vec3 n = scene.GeometricNormal(scene.faces[hit.face]);
      const Vec3 from = (1 - hit.u - hit.v) * p[0] + hit.u * p[1] + hit.v * p[2] + n * tracer.epsilon();
      const auto q = scene.Corners(scene.faces[lamps[random.NextBits() % lamps.size()]]);
      const float s = std::sqrt(random.Next()), t = random.Next();
      const Vec3 to = (1 - s) * q[0] + s * (1 - t) * q[1] + s * t * q[2];
      if (n.dot(to - from) > 0) shadow->push_back({from, 0, to - from, 1 - 1e-5f});
      const float r = std::sqrt(random.Next()), phi = 2 * float(kPi) * random.Next();
      ray = {from, 0, Frame(n).ToWorld({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r)}),
             std::numeric_limits<float>::infinity()};
      path->push_back(ray);
    }
  }
}

void Paths() {
  std::printf(
      "| scene | faces | rays a path | million rays/s of paths | of bare rays, one by one | paths over bare, "
      "median of 5 |\n"
      "|---|---|---|---|---|---|\n");
  for (const char* name : {"cornell_diffuse", "cornell_glossy", "glossy_floor", "lampshade"}) {
    const Scene scene = ReadGltfScene(kTests + "/scenes/" + name + ".glb");
    const PathTracer paths(scene);
    const Camera& camera = scene.cameras[0];
    std::vector<Ray> path, shadow;
    RecordRays(scene, paths.tracer(), &path, &shadow);
    std::vector<double> ratios, path_rates, bare_rates;
    double rays_a_path = 0, sink = 0;
    constexpr int kPaths = 40000;
    for (int run = 0; run < 5; ++run) {
      const double t0 = CpuSeconds();
      uint64_t rays = 0;
      RandomStream random(run);
      const CameraView view(camera, 256, 256);
      for (int i = 0; i < kPaths; ++i) {
        sink += paths.Radiance(view.EyeRay(256 * random.Next(), 256 * random.Next()), random, &rays).sum();
      }
      const double t1 = CpuSeconds();
      // As many of each kind as paths trace: one and one.
      for (const Ray& ray : path) sink += paths.tracer().Intersect(ray).t;
      const double t2 = CpuSeconds();
      for (const Ray& ray : shadow) sink += paths.tracer().Occluded(ray);
      const double t3 = CpuSeconds();
      rays_a_path = double(rays) / kPaths;
      path_rates.push_back(double(rays) / (t1 - t0) * 1e-6);
      bare_rates.push_back(2e-6 / ((t2 - t1) / double(path.size()) + (t3 - t2) / double(shadow.size())));
      ratios.push_back(path_rates.back() / bare_rates.back());
    }
    for (auto* list : {&ratios, &path_rates, &bare_rates}) std::sort(list->begin(), list->end());
    std::printf("| %s | %zu | %.1f | %.2f | %.2f | %.0f %% |%s\n", name, scene.faces.size(), rays_a_path,
                path_rates[2], bare_rates[2], 100 * ratios[2], sink == 0.125 ? " " : "");
  }
  std::printf(
      "\n| view | CPU s a picture | pixel error | mean against the references' | largest block score (bound) "
      "| rms of "
      "scores | standard error of a block |\n|---|---|---|---|---|---|---|\n");
  for (const char* name : kBoxes) {
    const Scene scene = ReadGltfScene(kTests + "/scenes/" + name + ".glb");
    const PathTracer paths(scene);
    for (const Camera& camera : scene.cameras) {
      const std::string truth = kTests + "/truth/" + name + "." + camera.name;
      const Image a = ReadExr(truth + ".a.exr"), b = ReadExr(truth + ".b.exr");
      const Mask mask = ReadPngMask(truth + ".mask.png");
      RenderOptions o;
      o.width = a.width;
      o.height = a.height;
      o.samples_per_pixel = 64;
      const CameraView view(camera, a.width, a.height);
      const double start = CpuSeconds();
      const Image c = RenderPathTraced(paths, view, o);
      o.seed = 2;
      const Image d = RenderPathTraced(paths, view, o);
      const double seconds = 0.5 * (CpuSeconds() - start);
      const test::BlockZScores z(c, d, a, b, mask);
      std::printf("| %s %s | %.1f | %.1f %% | %+.2f ± %.2f %% | %.2f (%.2f) | %.2f | %.1f %% |\n", name,
                  camera.name.c_str(), seconds, 100 * Compare(c, a, &b, &mask).pixel_error,
                  100 * z.mean_error, 100 * z.mean_standard_error, z.worst, z.bound, z.rms,
                  100 * z.relative_error);
    }
  }
}

const Topics kTopics = {{"basis", Basis},
                        {"brdf", BrdfFigures},
                        {"lobe-error", LobeErrorFigures},
                        {"dering", DeringFigures},
                        {"degree", Degree},
                        {"flux", Flux},
                        {"knots", Knots},
                        {"incidence", IncidenceFigures},
                        {"tables", Tables},
                        {"accumulation", Accumulation},
                        {"refinement", RefinementSpeed},
                        {"paths", Paths}};

}  // namespace
}  // namespace lobe

int main(int argc, char** argv) { return lobe::PrintTopic("figures", lobe::kTopics, argc, argv); }
