#include "render/renderer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "brdf/frame.h"
#include "solver/hash.h"

namespace lobe {
namespace {

constexpr int kTile = 8;  // pixels a side; their rays are traced together

// Inverse of the cumulative filter, one axis, tabulated.
class FilterSampler {
 public:
  explicit FilterSampler(PixelFilter filter) {
    if (filter == PixelFilter::kBox) return;
    // Blackman-Harris window, 4 terms, over [-1.5, 1.5] pixels.
    constexpr int kSteps = 1024;
    constexpr double kRadius = 1.5;
    std::vector<double> cumulative(kSteps + 1, 0.0);
    for (int i = 0; i < kSteps; ++i) {
      const double x = 2.0 * std::numbers::pi * (i + 0.5) / kSteps;
      cumulative[i + 1] = cumulative[i] + 0.35875 - 0.48829 * std::cos(x) + 0.14128 * std::cos(2 * x) -
                          0.01168 * std::cos(3 * x);
    }
    for (int i = 0, at = 0; i <= kInverse; ++i) {
      const double target = cumulative.back() * i / kInverse;
      while (at < kSteps - 1 && cumulative[at + 1] < target) ++at;
      const double step = cumulative[at + 1] - cumulative[at];
      const double u = step > 0 ? std::clamp((target - cumulative[at]) / step, 0.0, 1.0) : 0.0;
      inverse_.push_back(float(((at + u) / kSteps * 2.0 - 1.0) * kRadius));
    }
  }
  /// Offset from the pixel's centre.
  float Offset(float u) const {
    if (inverse_.empty()) return u - 0.5f;
    const float s = u * kInverse;
    const int i = std::min(int(s), kInverse - 1);
    return inverse_[i] + (s - float(i)) * (inverse_[i + 1] - inverse_[i]);
  }

 private:
  static constexpr int kInverse = 512;
  std::vector<float> inverse_;
};

}  // namespace

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

  explicit Impl(const Solution& s) : solution(s), tracer(s.scene) {}

  // Reflected light stored at a hit, towards `wo`, unclamped; `normal`: shading normal there.
  Rgb Stored(const RayHit& hit, const Vec3& wo, float* basis, Vec3* normal) const {
    const Mesh& mesh = solution.mesh;
    const auto where = mesh.Locate(hit.face, hit.side, hit.u, hit.v);
    const Vec3 geometric = solution.scene.GeometricNormal(solution.scene.faces[hit.face]);
    *normal = hit.side == Side::kFront ? geometric : Vec3(-geometric);
    if (where.element == kNone) return Rgb::Zero();
    const bool planar = mesh.patches[mesh.element_patch[where.element]].planar;
    if (!planar) {
      Vec3 n = Vec3::Zero();
      for (int i = 0; i < 3; ++i) n += where.weight[i] * mesh.node_normal[mesh.elements[where.element][i]];
      if (n.squaredNorm() > 0) *normal = n.normalized();
    }
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
      Vec3 normal;
      const Rgb stored = Stored(hit, wo, basis, &normal);
      const Rgb shown = stored.max(0.0f);
      sums.clamped += (throughput * (shown - stored)).sum();
      radiance += throughput * (material.emission + shown);

      if (solution.material_kinds[face.material] != GlossKind::kMirror) return radiance;
      const float cosine = std::clamp(wo.dot(normal), 0.0f, 1.0f);
      throughput *= std::get<MetallicRoughness>(material.reflectance).Fresnel(cosine);
      if ((throughput <= 0).all()) return radiance;
      if (depth == mirror_depth) {
        sums.cut_off += throughput.sum();
        return radiance;
      }
      const Vec3 at = ray.origin + ray.direction * hit.t;
      const Vec3 geometric = solution.scene.GeometricNormal(face) * (hit.side == Side::kFront ? 1.0f : -1.0f);
      Vec3 reflected = 2.0f * wo.dot(normal) * normal - wo;
      // A reflection about an interpolated normal may point into the surface.
      const float into = reflected.dot(geometric);
      if (into <= 0) reflected -= (into - 1e-4f) * geometric;
      ray = {at + geometric * tracer.epsilon(), 0.0f, reflected.normalized(),
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
  if (const std::string wrong = options.Validate(); !wrong.empty()) throw std::invalid_argument(wrong);
  const auto start = std::chrono::steady_clock::now();
  Image image(options.width, options.height);
  const int side = int(std::ceil(std::sqrt(double(options.samples_per_pixel))));
  const int samples = side * side;
  const FilterSampler filter(options.filter);

  struct Scratch {
    std::vector<Ray> rays;
    std::vector<RayHit> hits;
    std::vector<float> basis = std::vector<float>(kMaxBasisSize);
  };
  tbb::enumerable_thread_specific<Scratch> scratches;
  const int tiles_x = (options.width + kTile - 1) / kTile, tiles_y = (options.height + kTile - 1) / kTile;
  std::vector<Impl::Sums> sums(size_t(tiles_x) * tiles_y);
  std::atomic<int> done{0};
  std::atomic<bool> stop{false};
  std::mutex progress_mutex;

  tbb::parallel_for(0, tiles_x * tiles_y, [&](int tile) {
    if (stop.load(std::memory_order_relaxed)) return;
    Scratch& scratch = scratches.local();
    const int x0 = tile % tiles_x * kTile, y0 = tile / tiles_x * kTile;
    const int x1 = std::min(x0 + kTile, options.width), y1 = std::min(y0 + kTile, options.height);
    scratch.rays.clear();
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        RandomStream random(Mix(Mix(options.seed, 0xca3), uint64_t(y) * options.width + x));
        for (int s = 0; s < samples; ++s) {
          const float u = (float(s % side) + random.Next()) / side,
                      v = (float(s / side) + random.Next()) / side;
          scratch.rays.push_back(view.EyeRay(x + 0.5f + filter.Offset(u), y + 0.5f + filter.Offset(v)));
        }
      }
    }
    scratch.hits.resize(scratch.rays.size());
    impl_->tracer.Intersect(scratch.rays, scratch.hits, /*coherent=*/true);
    Impl::Sums& sum = sums[tile];
    sum.rays += scratch.rays.size();
    size_t ray = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        Rgb pixel = Rgb::Zero();
        for (int s = 0; s < samples; ++s, ++ray) {
          pixel += impl_->Shade(scratch.rays[ray], scratch.hits[ray], options.max_mirror_depth,
                                scratch.basis.data(), sum);
        }
        image.at(x, y) = pixel / float(samples);
        sum.shown += pixel.sum();
      }
    }
    const int finished = ++done;
    if (progress) {
      const std::unique_lock lock(progress_mutex, std::try_to_lock);
      if (lock.owns_lock() && !progress(double(finished) / (tiles_x * tiles_y))) stop = true;
    }
  });

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
    report->cut_off = cut / (3.0 * double(samples) * options.width * options.height);
    report->complete = !stop;
    report->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return image;
}

}  // namespace lobe
