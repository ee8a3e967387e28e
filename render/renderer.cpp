#include "render/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

#include <tbb/enumerable_thread_specific.h>

#include "brdf/frame.h"
#include "render/eye_rays.h"
#include "render/stored_tiles.h"
#include "scene/mirror.h"

namespace lobe {
std::string RenderOptions::Validate() const {
  std::ostringstream out;
  if (width < 1 || height < 1 || width > 65536 || height > 65536) {
    out << "size " << width << "x" << height << " is out of range: 1 to 65536 pixels a side is expected";
  } else if (samples_per_pixel < 1 || samples_per_pixel > 65536) {
    out << "samples per pixel " << samples_per_pixel << " is out of range: 1 to 65536 is expected";
  } else if (max_mirror_depth < 0 || max_mirror_depth > 1000) {
    out << "mirror depth " << max_mirror_depth << " is out of range: 0 to 1000 is expected";
  }
  return out.str();
}

struct Renderer::Impl {
  const Solution& solution;
  RayTracer tracer;

  struct Sums {  // what a picture lost
    double clamped = 0, cut_off = 0, shown = 0;
    uint64_t rays = 0;
  };

  const StoredTiles tiles;

  explicit Impl(const Solution& s) : solution(s), tracer(s.scene), tiles(s, tracer, WithoutMirrors(s)) {}

  // Of every side of every material: is what one sees of it the light stored there?
  static std::vector<uint8_t> WithoutMirrors(const Solution& s) {
    std::vector<uint8_t> handled;
    for (const GlossKind kind : s.material_kinds)
      handled.insert(handled.end(), 2, kind != GlossKind::kMirror);
    return handled;
  }

  // Reflected light stored at a place, towards `wo`, unclamped.
  Rgb Stored(const Mesh::Location& where, const Vec3& wo, float* basis) const {
    if (where.element == kNone) return Rgb::Zero();
    const Mesh& mesh = solution.mesh;
    const bool planar = mesh.patches[mesh.element_patch[where.element]].planar;
    const NodeWeights w = Interpolate(mesh, solution.hidden, where);
    Rgb out = Rgb::Zero();
    for (int k = 0; k < w.count; ++k) {
      const bool same_basis = planar && k > 0 && !solution.total.degrees(w.node[k]).diffuse();
      out +=
          w.weight[k] * (same_basis ? solution.total.RadianceFromBasis(w.node[k], basis)
                                    : solution.total.Radiance(
                                          w.node[k], Frame(mesh.node_normal[w.node[k]]).ToLocal(wo), basis));
    }
    return out;
  }

  Rgb Shade(Ray ray, RayHit hit, int mirror_depth, float* basis, Sums& sums) const {
    Rgb radiance = Rgb::Zero(), throughput = Rgb::Constant(1);
    for (int depth = 0;; ++depth) {
      if (!hit.hit()) return radiance;
      const Face& face = solution.scene.faces[hit.face];
      const Material& material = solution.scene.materials[face.material];
      if (hit.side == Side::kBack && !material.double_sided) return radiance;
      const Vec3 wo = -ray.direction.normalized();
      const auto where = solution.mesh.Locate(hit.face, hit.side, hit.u, hit.v);
      const Rgb stored = Stored(where, wo, basis);
      const Rgb shown = stored.max(0.0f);
      sums.clamped += (throughput * (shown - stored)).sum();
      radiance += throughput * (material.emission + shown);

      if (solution.material_kinds[face.material] != GlossKind::kMirror) return radiance;
      const HitPoint at = FindHitPoint(solution.scene, solution.mesh, ray, hit, where);
      const float cosine = std::clamp(wo.dot(at.normal), 0.0f, 1.0f);
      throughput *= std::get<MetallicRoughness>(material.reflectance).Fresnel(cosine);
      if ((throughput <= 0).all()) return radiance;
      if (depth == mirror_depth) {
        sums.cut_off += throughput.sum();
        return radiance;
      }
      ray = {at.position + at.geometric_normal * tracer.epsilon(), 0.0f, MirrorDirection(wo, at),
             std::numeric_limits<float>::infinity()};
      hit = tracer.Intersect(ray);
      ++sums.rays;
    }
  }
};

Renderer::Renderer(const Solution& solution) : impl_(std::make_unique<Impl>(solution)) {}
Renderer::~Renderer() = default;

Rgb Renderer::Radiance(const Ray& ray) const {
  std::vector<float> basis(kMaxBasisSize);
  Impl::Sums sums;
  return impl_->Shade(ray, impl_->tracer.Intersect(ray), RenderOptions{}.max_mirror_depth, basis.data(),
                      sums);
}

Image Renderer::Render(const CameraView& view, const RenderOptions& options, RenderReport* report,
                       const std::function<bool(double)>& progress) const {
  const auto start = std::chrono::steady_clock::now();
  const EyeRays eye_rays(view, options);
  Image image(options.width, options.height);

  tbb::enumerable_thread_specific<std::vector<float>> bases([] { return std::vector<float>(kMaxBasisSize); });
  const int tile_side = impl_->tiles.TileSide(eye_rays, options.width, options.height);
  std::vector<Impl::Sums> sums(TileCount(options.width, options.height, tile_side));

  const auto render_tile = [&](const Tile& tile) {
    Impl::Sums& sum = sums[tile.index];
    float* basis = bases.local().data();
    const auto shade = [&](const Ray& ray, const RayHit& hit) {
      return impl_->Shade(ray, hit, options.max_mirror_depth, basis, sum);
    };
    StoredTiles::Sums stored;
    impl_->tiles.Render(eye_rays, tile, shade, &image, &stored);
    sum.clamped += stored.clamped;
    sum.shown += stored.shown;
    sum.rays += stored.rays;
  };
  const bool complete = ForEachTile(options.width, options.height, tile_side, render_tile, progress);

  if (report) {
    *report = {};
    double clamped = 0, shown = 0, cut = 0;
    for (const auto& s : sums) {
      clamped += s.clamped;
      shown += s.shown;
      cut += s.cut_off;
      report->rays += s.rays;
    }
    report->clamped = shown > 0 ? clamped / shown : 0;
    // Light behind the last mirror is taken to be as bright as the picture.
    report->cut_off = cut / (3.0 * eye_rays.per_pixel() * options.width * options.height);
    report->complete = complete;
    report->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return image;
}

}  // namespace lobe
