// One test for each class of light paths (Heckbert's letters: L lamp, D diffuse, G glossy, S mirror, T
// through a sheet, E eye). Each scene is made so that all light of its receiver is of one class: a class that
// transport leaves out, or carries twice, is off by 100 %, where a few per cent are allowed.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/path_tracer.h"
#include "render/renderer.h"
#include "solver/planar_mirrors.h"
#include "solver/solver.h"
#include "tests/support/polygon_light.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
const std::vector<Transport> kBoth = {Transport::kLinks, Transport::kShooting};
const std::vector<Transport> kLinksOnly = {Transport::kLinks};

MetallicRoughness Metal(float roughness, const Rgb& colour = Rgb::Constant(1)) {
  MetallicRoughness m;
  m.base_color = colour;
  m.roughness = roughness;
  return m;
}

// Reflects `rho` and passes `tau`, without a coat.
MetallicRoughness Sheet(float rho, float tau) {
  MetallicRoughness m = Metal(1, Rgb::Constant(2 * rho));
  m.metallic = 0;
  m.has_specular = true;
  m.specular = 0;
  m.diffuse_transmission = 0.5f;
  m.diffuse_transmission_color = Rgb::Constant(2 * tau);
  return m;
}

// Low, so that what the receiver sends into a mirror and gets back hardly counts beside its class.
constexpr float kReceiverAlbedo = 0.05f;

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
};

// Places spread evenly over the faces of one material.
std::vector<SurfacePoint> PointsOf(const Scene& scene, uint32_t material, int per_face) {
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

Vec3 PositionOf(const Scene& scene, const SurfacePoint& at) {
  const auto p = scene.Corners(scene.faces[at.face]);
  return p[0] * (1 - at.u - at.v) + p[1] * at.u + p[2] * at.v;
}

using Figure = std::function<Rgb(const Solution&)>;

// Mean over solves with seeds of their own, and the standard error of that mean.
Estimate OverSeeds(const Scene& scene, SolveOptions options, const Figure& figure) {
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

Estimate MeanOf(const std::vector<Estimate>& estimates) {
  Estimate out;
  for (const Estimate& e : estimates) {
    out.mean += e.mean / double(estimates.size());
    out.standard_error += (e.standard_error / double(estimates.size())).square();
  }
  out.standard_error = out.standard_error.sqrt();
  return out;
}

// `discretisation`: what mesh and lobes may be off by, as a fraction.
void ExpectSame(const Estimate& got, const Estimate& want, double discretisation, const std::string& what) {
  for (int c = 0; c < 3; ++c) {
    ASSERT_GT(want.mean[c], 0) << what;
    const double error = std::hypot(got.standard_error[c], want.standard_error[c]);
    EXPECT_LT(error, 0.03 * want.mean[c]) << what << ": too noisy to tell";
    EXPECT_NEAR(got.mean[c], want.mean[c], 3 * error + discretisation * want.mean[c])
        << what << ", channel " << c << ": off by " << got.mean[c] / want.mean[c] - 1;
  }
}

SolveOptions Options(Transport transport, int links = 1024, float max_edge = 0.15f) {
  SolveOptions o;
  o.transport = transport;
  o.mesh.max_edge = max_edge;
  o.refine.error = 0;
  o.links = links;
  o.residual = 1e-4;
  return o;
}

// Irradiance of the diffuse receiver, mean over its points, from the solution's nodes.
Figure IrradianceAt(const std::vector<SurfacePoint>& points) {
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

Estimate TracedIrradiance(const Scene& scene, const std::vector<SurfacePoint>& points, int samples) {
  const PathTracer paths(scene);
  std::vector<Estimate> all;
  for (size_t i = 0; i < points.size(); ++i) all.push_back(paths.Irradiance(points[i], samples, 1000 + i));
  return MeanOf(all);
}

// The receiver's light against the path tracer's.
void ExpectReceiverAsTraced(const Stage& stage, const std::string& what,
                            const std::vector<Transport>& transports, double discretisation, int samples,
                            const SolveOptions& base = Options(Transport::kLinks)) {
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
void ExpectReceiverAsLit(const Stage& stage, const std::string& what,
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
void ExpectSeenAsTraced(const Scene& scene, uint32_t material, const Vec3& wo, const std::string& what,
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

TEST(PathClassTest, LE_IsSeenByTheEyeAndInNoLobe) {
  Stage b;
  const uint32_t glowing = b.AddMaterial("glowing", Lambert{Rgb::Constant(0.5f)}, Rgb(3, 2, 1));
  b.Up(0, 1, 0, 1, 0, glowing);  // alone in the void
  const Scene scene = b.Build();
  for (const Transport t : kBoth) {
    const Solution s = Solve(scene, Options(t));
    for (uint32_t p = 0; p < s.total.patch_count(); ++p) {
      for (const float v : s.total.patch_values(p)) ASSERT_EQ(v, 0);
    }
    const Rgb seen = Renderer(s).Radiance({{0.4f, 1, 0.3f}, 0, -Vec3::UnitY(), kInfinity});
    EXPECT_TRUE((seen == Rgb(3, 2, 1)).all());
  }
}

TEST(PathClassTest, LDE_StraightLight) {
  for (const float half : {0.05f, 0.8f}) {
    Stage b;
    b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
    b.Down(-half, half, -half, half, 1, b.lamp);
    ExpectReceiverAsLit(b, "LDE", kBoth, 0.01,
                        {{-half, 1, -half}, {half, 1, -half}, {half, 1, half}, {-half, 1, half}},
                        Options(Transport::kLinks));
  }
}

// The lamp looks up, so the floor sees its black back and nothing but the ceiling's light.
TEST(PathClassTest, LDDE_OverADiffuseCeiling) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-0.3f, 0.3f, -0.3f, 0.3f, 1, b.lamp);
  b.Down(-1, 1, -1, 1, 2, b.AddLambert(Rgb(0.8f, 0.6f, 0.4f)));
  ExpectReceiverAsTraced(b, "LDDE", kBoth, 0.02, 10000);
}

TEST(PathClassTest, LGDE_OverAGlossyCeiling) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.3f, -0.7f, -0.3f, 0.3f, 1, b.lamp);
  b.Down(-1.5f, 1.5f, -1, 1, 2, b.AddMaterial("brushed", Metal(0.5f, Rgb(0.9f, 0.7f, 0.5f))));
  ExpectReceiverAsTraced(b, "LGDE", kBoth, 0.03, 10000, Options(Transport::kLinks, 512, 0.2f));
}

TEST(PathClassTest, LDGE_ADiffuseCeilingInAGlossyFloor) {
  Stage b;
  const uint32_t floor = b.AddMaterial("brushed", Metal(0.5f, Rgb(0.9f, 0.7f, 0.5f)));
  b.Up(0, 1, -0.5f, 0.5f, 0, floor);
  b.Up(-1.3f, -0.7f, -0.3f, 0.3f, 1, b.lamp);
  b.Down(-1.5f, 1.5f, -1, 1, 2, b.AddLambert(Rgb(0.8f, 0.6f, 0.4f)));
  ExpectSeenAsTraced(b.Build(), floor, Vec3(0.4f, 0.9f, 0.2f).normalized(), "LDGE", kBoth, 0.04, 3000);
}

// Floor and lamp look up to a perfect mirror at y = 2: the floor sees the lamp's image at y = 3.
TEST(PathClassTest, LSDE_ASmallLampInAPlanarMirrorIsShotByItsImage) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.3f, -0.9f, -0.2f, 0.2f, 1, b.lamp);
  b.Down(-2, 2, -2, 2, 2, b.AddMaterial("mirror", Metal(0)));
  ExpectReceiverAsLit(b, "LSDE small", kLinksOnly, 0.01,
                      {{-1.3f, 3, -0.2f}, {-0.9f, 3, -0.2f}, {-0.9f, 3, 0.2f}, {-1.3f, 3, 0.2f}},
                      Options(Transport::kLinks));
}

// The lamp is no smaller than a twentieth of the mirror: links find it.
TEST(PathClassTest, LSDE_ALargeLampInAPlanarMirrorIsFoundByLinks) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.6f, -0.6f, -0.5f, 0.5f, 1, b.lamp);
  b.Down(-1.5f, 1.5f, -1, 1, 2, b.AddMaterial("mirror", Metal(0, Rgb(0.9f, 0.6f, 0.3f))));
  ExpectReceiverAsTraced(b, "LSDE large", kLinksOnly, 0.02, 16000, Options(Transport::kLinks, 2048, 0.25f));
}

TEST(PathClassTest, LSDE_ByACurvedMirror) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.9f, -0.5f, -0.8f, 0.8f, 0.8f, b.lamp);
  b.AddSphere({0, 1.8f, 0}, 0.8f, b.AddMaterial("ball", Metal(0, Rgb(0.9f, 0.6f, 0.3f))), 16);
  ExpectReceiverAsTraced(b, "LSDE sphere", kLinksOnly, 0.03, 15000, Options(Transport::kLinks, 2048, 0.25f));
}

// A periscope: up, to the right, down; the unfolded way is 1 + 2 + 1 long. The lamp lies aside in z: straight
// overhead the first ring of links sees it as a whole or not at all, and the noise is far greater.
TEST(PathClassTest, LSSDE_ByTwoMirrors) {
  Stage b;
  const uint32_t mirror = b.AddMaterial("mirror", Metal(0)), black = b.AddLambert(Rgb::Zero());
  b.Up(-0.2f, 0.2f, 0.6f, 1, 0, b.receiver);
  b.Up(-2.3f, -1.7f, -1.3f, -0.7f, 0, b.lamp);
  // Through (-2, 1), looking to (1, -1), and through (0, 1), looking to (-1, -1).
  b.AddQuad({-2.7f, 0.3f, 1.2f}, {-2.7f, 0.3f, -1.2f}, {-1.3f, 1.7f, -1.2f}, {-1.3f, 1.7f, 1.2f}, mirror);
  b.AddQuad({0.7f, 0.3f, -1.2f}, {0.7f, 0.3f, 1.2f}, {-0.7f, 1.7f, 1.2f}, {-0.7f, 1.7f, -1.2f}, mirror);
  // Between lamp and receiver.
  b.AddQuad({-1, -0.5f, -2}, {-1, -0.5f, 2}, {-1, 0.5f, 2}, {-1, 0.5f, -2}, black);
  ExpectReceiverAsLit(b, "LSSDE", kLinksOnly, 0.02,
                      {{-0.3f, 4, -1.3f}, {0.3f, 4, -1.3f}, {0.3f, 4, -0.7f}, {-0.3f, 4, -0.7f}},
                      Options(Transport::kLinks, 3000, 0.3f));
}

// The lamp lights a plate that the receiver sees in the ceiling's mirror only.
TEST(PathClassTest, LDSDE_DiffuseLightOverAMirrorOntoADiffuseSurface) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-2, -0.5f, -1, 1, 1, b.AddLambert(Rgb(0.8f, 0.6f, 0.4f)));
  b.Down(-1.8f, -1.3f, -0.4f, 0.4f, 1.4f, b.lamp);
  b.Down(-1.5f, 1, -1, 1, 2, b.AddMaterial("mirror", Metal(0, Rgb(0.9f, 0.8f, 0.7f))));
  ExpectReceiverAsTraced(b, "LDSDE", kLinksOnly, 0.03, 30000, Options(Transport::kLinks, 2048, 0.2f));
}

TEST(PathClassTest, LTDE_ThroughASheet) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Down(-0.5f, 0.5f, -0.5f, 0.5f, 2, b.lamp);
  b.Up(-2, 2, -2, 2, 1, b.AddMaterial("sheet", Sheet(0.3f, 0.45f), Rgb::Zero(), true));
  ExpectReceiverAsTraced(b, "LTDE", kBoth, 0.02, 4000, Options(Transport::kLinks, 512, 0.25f));
}

TEST(PathClassTest, LDTDE_DiffuseLightThroughASheet) {
  Stage b;
  b.Up(-0.5f, 0.5f, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-0.3f, 0.3f, -0.3f, 0.3f, 1.5f, b.lamp);
  b.Down(-1, 1, -1, 1, 2.3f, b.AddLambert(Rgb(0.8f, 0.6f, 0.4f)));
  b.Up(-2.5f, 2.5f, -2.5f, 2.5f, 1, b.AddMaterial("sheet", Sheet(0.3f, 0.45f), Rgb::Zero(), true));
  ExpectReceiverAsTraced(b, "LDTDE", kBoth, 0.03, 8000, Options(Transport::kLinks, 512, 0.25f));
}

// A varnished mirror: the receiver gets what its base scatters and what its coat mirrors; an eye sees the
// base and, by the ray that goes on, the receiver.
TEST(PathClassTest, LSDE_AndLDDE_OverADielectricMirrorWithABase) {
  Stage b;
  MetallicRoughness varnish = Metal(0, Rgb(0.7f, 0.5f, 0.3f));
  varnish.metallic = 0;
  varnish.ior = 2.5f;  // a coat that matters: 18 %
  const uint32_t plate = b.AddMaterial("varnish", varnish);
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.3f, -0.7f, -0.3f, 0.3f, 1, b.lamp);
  b.Down(-1.5f, 1.5f, -1, 1, 2, plate);
  ExpectReceiverAsTraced(b, "varnish", kLinksOnly, 0.02, 12000, Options(Transport::kLinks, 1024, 0.2f));
  ExpectSeenAsTraced(b.Build(), plate, Vec3(0.2f, -1, 0.1f).normalized(), "varnish seen", kLinksOnly, 0.03,
                     4000, Options(Transport::kLinks, 1024, 0.2f));
}

// Without its mirrors every scene above is dark where it is looked at: what was measured is the class.
TEST(PathClassTest, TheReceiversOfMirrorScenesAreDarkWithoutMirrors) {
  Stage b;
  b.Up(0, 1, -0.5f, 0.5f, 0, b.receiver);
  b.Up(-1.3f, -0.9f, -0.2f, 0.2f, 1, b.lamp);
  const uint32_t black = b.AddLambert(Rgb::Zero());
  b.Down(-2, 2, -2, 2, 2, black);
  const Scene scene = b.Build();
  for (const SurfacePoint& p : PointsOf(scene, b.receiver, 4)) {
    EXPECT_EQ(PathTracer(scene).Irradiance(p, 500).mean.sum(), 0);
  }
}

}  // namespace
}  // namespace lobe
