#pragma once

// What tests of path classes share: scenes whose receiver gets light of one class alone, and the comparison
// of solutions with the path tracer over several seeds.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/path_tracer.h"
#include "render/renderer.h"
#include "solver/solver.h"
#include "tests/support/glass.h"
#include "tests/support/metal.h"
#include "tests/support/polygon_light.h"
#include "tests/support/scene_builder.h"

namespace lobe::test {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline const std::vector<Transport> kBoth = {Transport::kLinks, Transport::kShooting};
inline const std::vector<Transport> kLinksOnly = {Transport::kLinks};

// Reflects `rho` and passes `tau`, without a coat.
inline MetallicRoughness Sheet(float rho, float tau) {
  MetallicRoughness m = Metal(1, Rgb::Constant(2 * rho));
  m.metallic = 0;
  m.has_specular = true;
  m.specular = 0;
  m.diffuse_transmission = 0.5f;
  m.diffuse_transmission_color = Rgb::Constant(2 * tau);
  return m;
}

// Low, so that what the receiver sends into a mirror and gets back hardly counts beside its class.
inline constexpr float kReceiverAlbedo = 0.05f;

// A builder with what most scenes need. `Up` and `Down`: a rectangle at height y that looks up or down.
struct Stage : SceneBuilder {
  uint32_t receiver = AddMaterial("receiver", Lambert{Rgb::Constant(kReceiverAlbedo)});
  uint32_t lamp = AddEmitter(Rgb(10, 8, 6));
  uint32_t Up(float x0, float x1, float z0, float z1, float y, uint32_t material) {
    return AddQuad({x0, y, z0}, {x0, y, z1}, {x1, y, z1}, {x1, y, z0}, material);
  }
  uint32_t Down(float x0, float x1, float z0, float z1, float y, uint32_t material) {
    return AddQuad({x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1}, material);
  }
  uint32_t AddPane(const MetallicRoughness& glass = Pane(1.5f, Rgb(0.9f, 0.8f, 0.6f))) {
    return AddMaterial("pane", glass, Rgb::Zero(), /*double_sided=*/true);
  }
};

// Places spread evenly over the faces of one material.
inline std::vector<SurfacePoint> PointsOf(const Scene& scene, uint32_t material, int per_face) {
  std::vector<SurfacePoint> out;
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    if (scene.faces[f].material != material) continue;
    for (int i = 0; i < per_face; ++i) {
      // Plastic-number sequence (Roberts 2018).
      float u = 0.5f + 0.7548777f * float(i), v = 0.5f + 0.5698403f * float(i);
      u = std::sqrt(u - std::floor(u));
      v = (v - std::floor(v)) * u;
      out.push_back({f, Side::kFront, 1 - u, v});
    }
  }
  return out;
}

inline Vec3 PositionOf(const Scene& scene, const SurfacePoint& at) {
  const auto p = scene.Corners(scene.faces[at.face]);
  return p[0] * (1 - at.u - at.v) + p[1] * at.u + p[2] * at.v;
}

using Figure = std::function<Rgb(const Solution&)>;

// Mean over solves with seeds of their own, and the standard error of that mean.
inline Estimate OverSeeds(const Scene& scene, SolveOptions options, const Figure& figure) {
  constexpr int kSeeds = 4;
  Eigen::Array3d sum = Eigen::Array3d::Zero(), sum2 = sum;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    options.seed = uint64_t(seed);
    const Eigen::Array3d x = figure(Solve(scene, options)).cast<double>();
    sum += x;
    sum2 += x * x;
  }
  const Eigen::Array3d mean = sum / kSeeds;
  return {mean, ((sum2 / kSeeds - mean * mean).max(0.0) / (kSeeds - 1)).sqrt()};
}

inline Estimate MeanOf(const std::vector<Estimate>& estimates) {
  Estimate out;
  for (const Estimate& e : estimates) {
    out.mean += e.mean / double(estimates.size());
    out.standard_error += (e.standard_error / double(estimates.size())).square();
  }
  out.standard_error = out.standard_error.sqrt();
  return out;
}

// `discretisation`: what mesh and lobes may be off by, as a fraction.
inline void ExpectSame(const Estimate& got, const Estimate& want, double discretisation,
                       const std::string& what) {
  for (int c = 0; c < 3; ++c) {
    ASSERT_GT(want.mean[c], 0) << what;
    const double error = std::hypot(got.standard_error[c], want.standard_error[c]);
    EXPECT_LT(error, 0.03 * want.mean[c]) << what << ": too noisy to tell";
    EXPECT_NEAR(got.mean[c], want.mean[c], 3 * error + discretisation * want.mean[c])
        << what << ", channel " << c << ": off by " << got.mean[c] / want.mean[c] - 1;
  }
}

inline SolveOptions Options(Transport transport, int links = 1024, float max_edge = 0.15f) {
  SolveOptions o;
  o.transport = transport;
  o.mesh.max_edge = max_edge;
  o.refine.error = 0;
  o.links = links;
  o.residual = 1e-4;
  return o;
}

// Irradiance of the diffuse receiver, mean over its points, from the solution's nodes.
inline Figure IrradianceAt(const std::vector<SurfacePoint>& points) {
  return [=](const Solution& s) {
    Rgb sum = Rgb::Zero();
    for (const SurfacePoint& p : points) {
      const Mesh::Location where = s.mesh.Locate(p.face, p.side, p.u, p.v);
      if (where.element == kNone) continue;  // was found to be dark
      const NodeWeights w = Interpolate(s.mesh, s.hidden, where);
      for (int k = 0; k < w.count; ++k) sum += w.weight[k] * s.total.Flux(w.node[k]);
    }
    return Rgb(sum / (kReceiverAlbedo * float(points.size())));
  };
}

inline Estimate TracedIrradiance(const Scene& scene, const std::vector<SurfacePoint>& points, int samples) {
  const PathTracer paths(scene);
  std::vector<Estimate> all;
  for (size_t i = 0; i < points.size(); ++i) all.push_back(paths.Irradiance(points[i], samples, 1000 + i));
  return MeanOf(all);
}

// The receiver's light against the path tracer's.
inline void ExpectReceiverAsTraced(const Stage& stage, const std::string& what,
                                   const std::vector<Transport>& transports, double discretisation,
                                   int samples, const SolveOptions& base = Options(Transport::kLinks)) {
  const Scene scene = stage.Build();
  const auto points = PointsOf(scene, stage.receiver, 8);
  const Estimate want = TracedIrradiance(scene, points, samples);
  for (const Transport t : transports) {
    SolveOptions o = base;
    o.transport = t;
    ExpectSame(OverSeeds(scene, o, IrradianceAt(points)), want, discretisation, what + " by " + Name(t));
  }
}

// The same against lamps that are seen straight, given as polygons of radiance (10, 8, 6).
inline void ExpectReceiverAsLit(const Stage& stage, const std::string& what,
                                const std::vector<Transport>& transports, double discretisation,
                                const std::vector<Vec3>& lamp, const SolveOptions& base) {
  const Scene scene = stage.Build();
  const auto points = PointsOf(scene, stage.receiver, 8);
  Estimate want;
  for (const SurfacePoint& p : points) {
    const double e = test::PolygonIrradiance(PositionOf(scene, p).cast<double>(), Vec3d::UnitY(), lamp);
    want.mean += Eigen::Array3d(10, 8, 6) * e / double(points.size());
  }
  for (const Transport t : transports) {
    SolveOptions o = base;
    o.transport = t;
    ExpectSame(OverSeeds(scene, o, IrradianceAt(points)), want, discretisation, what + " by " + Name(t));
  }
}

// What an eye sees of the faces of one material from one direction, mean over points.
inline void ExpectSeenAsTraced(const Scene& scene, uint32_t material, const Vec3& wo, const std::string& what,
                               const std::vector<Transport>& transports, double discretisation, int samples,
                               const SolveOptions& base = Options(Transport::kLinks)) {
  const auto points = PointsOf(scene, material, 8);
  const PathTracer paths(scene);
  std::vector<Estimate> all;
  for (size_t i = 0; i < points.size(); ++i)
    all.push_back(paths.ExitantRadiance(points[i], wo, samples, i + 1));
  const auto seen = [&](const Solution& s) {
    const Renderer renderer(s);
    Rgb sum = Rgb::Zero();
    for (const SurfacePoint& p : points) {
      sum += renderer.Radiance({PositionOf(scene, p) + 0.05f * wo, 0, -wo, kInfinity});
    }
    return Rgb(sum / float(points.size()));
  };
  for (const Transport t : transports) {
    SolveOptions o = base;
    o.transport = t;
    ExpectSame(OverSeeds(scene, o, seen), MeanOf(all), discretisation, what + " by " + Name(t));
  }
}

}  // namespace lobe::test
