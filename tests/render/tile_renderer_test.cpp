#include "render/tile_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "brdf/frame.h"
#include "render/film_grid.h"
#include "render/packet_light.h"
#include "render/renderer.h"
#include "scene/gltf_scene.h"
#include "solver/solver.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

// What a ray shows of stored light, the plain way.
struct Shown {
  Rgb radiance = Rgb::Zero(), clamped = Rgb::Zero();
};
Shown PlainlyShown(const Solution& s, const RayTracer& tracer, const Ray& ray) {
  const RayHit hit = tracer.Intersect(ray);
  if (!hit.hit()) return {};
  const Material& material = s.scene.material(s.scene.faces[hit.face]);
  if (hit.side == Side::kBack && !material.double_sided) return {};
  const auto where = s.mesh.Locate(hit.face, hit.side, hit.u, hit.v);
  Rgb stored = Rgb::Zero();
  std::vector<float> basis(kMaxBasisSize);
  if (where.element != kNone) {
    const NodeWeights w = Interpolate(s.mesh, s.hidden, where);
    for (int k = 0; k < w.count; ++k) {
      stored += w.weight[k] * s.total.Radiance(w.node[k],
                                               Frame(s.mesh.node_normal[w.node[k]]).ToLocal(-ray.direction),
                                               basis.data());
    }
  }
  return {material.emission + stored.max(0.0f), stored.max(0.0f) - stored};
}

// The largest absolute value of any node's lobe, found among random directions.
float LargestLobe(const Solution& s) {
  std::mt19937 bits(5);
  std::normal_distribution<float> normal;
  std::vector<float> basis(kMaxBasisSize);
  float size = 0;
  for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
    for (int i = 0; i < 16; ++i) {
      Vec3 w = Vec3(normal(bits), normal(bits), normal(bits)).normalized();
      w.z() = std::abs(w.z());
      size = std::max(size, s.total.Radiance(n, w, basis.data()).abs().maxCoeff());
    }
  }
  return size;
}

void ExpectAgrees(const Solution& s, const Camera& camera, RenderOptions o, const std::string& what) {
  const RayTracer tracer(s.scene);
  const CameraView view(camera, o.width, o.height);
  RenderReport report;
  const Image got = Renderer(s).Render(view, o, &report);
  const EyeRays eye_rays(view, o);
  // Rays that pass an edge within a rounding error may see either side of it.
  const float bound = float(FilmGrid::kTolerance) * LargestLobe(s);
  double clamped = 0, shown = 0, difference = 0;
  int off = 0;
  for (int y = 0; y < o.height; ++y) {
    for (int x = 0; x < o.width; ++x) {
      std::vector<Ray> rays;
      eye_rays.Append(x, y, &rays);
      Rgb sum = Rgb::Zero();
      for (const Ray& ray : rays) {
        const Shown one = PlainlyShown(s, tracer, ray);
        sum += one.radiance;
        clamped += one.clamped.sum();
      }
      const Rgb expected = sum / float(rays.size());
      shown += sum.sum();
      difference += (got.at(x, y) - expected).abs().sum() * double(rays.size());
      off += (got.at(x, y) - expected).abs().maxCoeff() > bound + 1e-5f * expected.maxCoeff();
    }
  }
  EXPECT_LE(off, o.width * o.height / 1000) << what;
  EXPECT_LT(difference, 5e-4 * shown) << what << ", the whole picture";
  EXPECT_NEAR(report.clamped, clamped / shown, 1e-4) << what;
  EXPECT_EQ(report.rays, uint64_t(o.width) * o.height * eye_rays.per_pixel());
}

RenderOptions Size(int width, int height, int samples = 4, PixelFilter filter = PixelFilter::kBox) {
  RenderOptions o;
  o.width = width;
  o.height = height;
  o.samples_per_pixel = samples;
  o.filter = filter;
  o.mode = RenderMode::kStored;
  return o;
}

const Solution& Cornell() {
  static const Solution solution = [] {
    SolveOptions o;
    o.mesh.max_edge = 0.8f;
    return Solve(ReadGltfScene(std::string(LOBE_TEST_DATA) + "/scenes/cornell_glossy.glb"), o);
  }();
  return solution;
}

// A glossy ball and a Lambertian one in a room, a lamp, a one-sided sheet seen from its back.
const Solution& Balls() {
  static const Solution solution = [] {
    test::SceneBuilder b;
    MetallicRoughness glossy;
    glossy.base_color = Rgb(0.8f, 0.6f, 0.3f);
    glossy.metallic = 1;
    glossy.roughness = 0.4f;
    const uint32_t white = b.AddLambert(Rgb::Constant(0.6f));
    b.AddBox({0, 0, 0}, {2, 2, 2}, white, true);
    b.AddQuad({0.5f, 1.9f, 0.5f}, {1.5f, 1.9f, 0.5f}, {1.5f, 1.9f, 1.5f}, {0.5f, 1.9f, 1.5f},
              b.AddEmitter(Rgb(5, 4, 3)));
    b.AddSphere({0.7f, 0.6f, 0.8f}, 0.4f, b.AddMaterial("glossy", glossy));
    b.AddSphere({1.5f, 0.5f, 0.9f}, 0.3f, white);
    b.AddQuad({0.1f, 1.2f, 0.3f}, {0.1f, 1.6f, 0.3f}, {0.5f, 1.6f, 0.3f}, {0.5f, 1.2f, 0.3f}, white);
    b.AddCamera("view", {1, 1, 1.95f}, {1, 0.8f, 0}, Vec3::UnitY(), 1.0f);
    SolveOptions o;
    o.mesh.max_edge = 0.3f;
    return Solve(b.Build(), o);
  }();
  return solution;
}

TEST(TileRendererTest, ShowWhatThePlainWayShowsInAGlossyRoom) {
  const Camera& camera = Cornell().scene.cameras.at(0);
  ExpectAgrees(Cornell(), camera, Size(96, 64), "narrow tiles");
  ExpectAgrees(Cornell(), Cornell().scene.cameras.at(1), Size(96, 64), "the other view");
  ExpectAgrees(Cornell(), camera, Size(37, 21, 1), "odd size, one sample");
  ExpectAgrees(Cornell(), camera, Size(37, 21, 9, PixelFilter::kBlackmanHarris), "over the tiles' edges");
  ExpectAgrees(Cornell(), camera, Size(1, 1, 16), "one pixel");
  Camera zoom = camera;
  zoom.fov_y = 0.05f;
  ExpectAgrees(Cornell(), zoom, Size(64, 64, 4), "long lens");
}

TEST(TileRendererTest, ShowWhatThePlainWayShowsOnCurvedGlossAndWideLenses) {
  Camera camera = Balls().scene.cameras.at(0);
  ExpectAgrees(Balls(), camera, Size(120, 90), "balls");
  ExpectAgrees(Balls(), camera, Size(60, 60, 4, PixelFilter::kBlackmanHarris), "filter");
  camera.fov_y = 2.9f;
  ExpectAgrees(Balls(), camera, Size(48, 48), "166 degrees");
}

TEST(TileRendererTest, HiddenNodesHaveNoWeight) {
  Solution s = Balls();
  for (uint32_t n = 0; n < s.mesh.node_count(); ++n) s.hidden[n] = n % 3 == 1 || n % 7 < 2;
  ExpectAgrees(s, s.scene.cameras.at(0), Size(90, 70), "hidden by hand");
}

TEST(TileRendererTest, ClampNegativeLightAndSayHowMuch) {
  Solution s = Balls();
  for (uint32_t n = 0; n < s.mesh.node_count(); n += 2) {
    for (float& c : s.total.all(n)) c = -c;
  }
  ExpectAgrees(s, s.scene.cameras.at(0), Size(60, 60), "every other node negative");
}

TEST(TileRendererTest, GiveTheSameBitsForAnyNumberOfThreadsAndAgain) {
  const Solution& s = Balls();
  const Renderer renderer(s);
  const RenderOptions o = Size(130, 75);
  std::vector<Image> images;
  for (const int threads : {1, 2, 7, 1}) {
    tbb::task_arena arena(threads);
    arena.execute(
        [&] { images.push_back(renderer.Render(CameraView(s.scene.cameras[0], 130, 75), o, nullptr)); });
  }
  for (const Image& image : images) {
    EXPECT_EQ(std::memcmp(images[0].pixels.data(), image.pixels.data(), image.pixels.size() * sizeof(Rgb)),
              0);
  }
}

TEST(TileRendererTest, AskTheGeneralWayForWhatIsNotHandledAndNothingElse) {
  const Solution& s = Balls();
  const RayTracer tracer(s.scene);
  std::vector<uint8_t> handled(2 * s.scene.materials.size(), 1);
  const uint32_t gloss = uint32_t(std::find_if(s.scene.materials.begin(), s.scene.materials.end(),
                                               [](const Material& m) { return m.name == "glossy"; }) -
                                  s.scene.materials.begin());
  handled[2 * gloss] = handled[2 * gloss + 1] = 0;
  const ElementLocator locator(s.mesh);
  const TileRenderer tiles(s, tracer, locator, handled);
  const CameraView view(s.scene.cameras[0], 64, 64);
  const EyeRays eye_rays(view, Size(64, 64, 1));
  Image image(64, 64);
  TileRenderer::Sums sums;
  int asked = 0, met = 0;
  const auto general = [&](const Ray& ray, const RayHit& hit, int x, int y, int sample) -> Rgb {
    ++asked;
    std::vector<Ray> rays;
    eye_rays.Append(x, y, &rays);
    EXPECT_EQ(ray.direction, rays.at(sample).direction);
    EXPECT_EQ(s.scene.faces[hit.face].material, gloss);
    return Rgb(100, 200, 300);
  };
  tiles.Render(eye_rays, {0, 0, 0, 64, 64}, {0, 0, 64, 64}, general, &image, &sums);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      std::vector<Ray> rays;
      eye_rays.Append(x, y, &rays);
      const RayHit hit = tracer.Intersect(rays[0]);
      const bool glossy = hit.hit() && s.scene.faces[hit.face].material == gloss;
      met += glossy;
      EXPECT_EQ((image.at(x, y) == Rgb(100, 200, 300)).all(), glossy);
    }
  }
  EXPECT_EQ(asked, met);
  EXPECT_GT(met, 100);
}

TEST(PacketLightTest, ReadsLobesOncePerTileOrExactly) {
  const Solution& s = Cornell();
  const RayTracer tracer(s.scene);
  const ElementLocator locator(s.mesh);
  const std::vector<uint8_t> handled(2 * s.scene.materials.size(), 1);
  const auto read = [&](float fov) {
    Camera camera = s.scene.cameras.at(0);
    camera.fov_y = fov;
    const CameraView view(camera, 32, 32);
    const EyeRays eye_rays(view, Size(32, 32));
    PacketLight light(s, locator, handled);
    light.Start(eye_rays.film(), 0, 0, 32, 32);
    EyePacket rays;
    PacketHits hits;
    alignas(64) float radiance[3 * kLanes];
    for (int y = 0; y < 32; y += 2) {
      for (int x = 0; x < 32; x += 2) {
        eye_rays.Packet(x, y, 0, &rays);
        tracer.IntersectPacket(eye_rays.eye(), rays.x, rays.y, rays.z, &hits);
        EXPECT_EQ(light.Read(rays, hits, 0xffff, radiance), 0u);
      }
    }
    return light.counts();
  };
  const auto narrow = read(0.01f), wide = read(0.7f);
  EXPECT_GT(narrow.grids, 0u);
  EXPECT_EQ(narrow.exact_reads, 0u);
  EXPECT_LT(narrow.grids, 60u) << "256 packets, a few nodes";
  EXPECT_GT(wide.exact_reads, 100u) << "the whole picture as one tile is too wide for degree 20";
}

}  // namespace
}  // namespace lobe
