#include "render/renderer.h"

#include <chrono>
#include <span>
#include <sstream>

#include <tbb/enumerable_thread_specific.h>

#include "render/eye_rays.h"
#include "render/eye_shader.h"

namespace lobe {
std::string RenderOptions::Validate() const {
  std::ostringstream out;
  if (width < 1 || height < 1 || width > 65536 || height > 65536) {
    out << "size " << width << "x" << height << " is out of range: 1 to 65536 pixels a side is expected";
  } else if (crop != PixelRect{} && (crop.x0 < 0 || crop.y0 < 0 || crop.width() < 1 || crop.height() < 1 ||
                                     crop.x1 > width || crop.y1 > height)) {
    out << "crop " << crop.x0 << "," << crop.y0 << "," << crop.x1 << "," << crop.y1
        << " is out of range: pixels within 0,0," << width << "," << height << " are expected";
  } else if (samples_per_pixel < 1 || samples_per_pixel > 65536) {
    out << "samples per pixel " << samples_per_pixel << " is out of range: 1 to 65536 is expected";
  } else if (max_mirror_depth < 0 || max_mirror_depth > 1000) {
    out << "mirror depth " << max_mirror_depth << " is out of range: 0 to 1000 is expected";
  } else if (light_samples < 1 || light_samples > 65536) {
    out << "light samples " << light_samples << " is out of range: 1 to 65536 is expected";
  } else if (gather_samples < 1 || gather_samples > 65536) {
    out << "gather samples " << gather_samples << " is out of range: 1 to 65536 is expected";
  }
  return out.str();
}

struct Renderer::Impl {
  const Solution& solution;
  EyeShader shader;

  explicit Impl(const Solution& s) : solution(s), shader(s) {}

  // One pixel's layers, from its eye rays, what they hit and the light they brought.
  void PutLayers(const CameraView& view, std::span<const Ray> rays, std::span<const RayHit> hits,
                 const EyeLight& light, int x, int y, LayeredImage* image) const {
    const float each = 1.0f / float(rays.size());
    for (auto& [layer, values] : image->layers) {
      Rgb& out = values.at(x, y);
      switch (layer) {
        case Layer::kDirect:
          out = light.direct * each;
          break;
        case Layer::kIndirect:
          out = light.indirect * each;
          break;
        case Layer::kSpecular:
          out = light.specular * each;
          break;
        case Layer::kClamped:
          out = light.clamped * each;
          break;
        default:
          for (size_t i = 0; i < rays.size(); ++i) {
            if (hits[i].hit()) PutGeometry(layer, view, rays[i], hits[i], each, &out);
          }
      }
    }
  }
  void PutGeometry(Layer layer, const CameraView& view, const Ray& ray, const RayHit& hit, float each,
                   Rgb* out) const {
    if (layer == Layer::kAlbedo) {
      *out += each * NormalAlbedo(solution.scene.materials[shader.paths().material(hit.face)].reflectance);
    } else if (layer == Layer::kNormal) {
      *out += each * shader.paths().ShadingNormal(hit).array();
    } else if (layer == Layer::kPosition) {
      *out += each * (ray.origin + hit.t * ray.direction).array();
    } else {
      const float depth = -hit.t * ray.direction.dot(view.camera().back);
      *out = out->min(depth);
    }
  }
};

Renderer::Renderer(const Solution& solution) : impl_(std::make_unique<Impl>(solution)) {}
Renderer::~Renderer() = default;

const RayTracer& Renderer::tracer() const { return impl_->shader.paths().tracer(); }

Rgb Renderer::Radiance(const Ray& ray) const {
  EyeShader::Work work;
  RenderOptions options;
  options.mode = RenderMode::kStored;
  const RayHit hit = impl_->shader.paths().tracer().Intersect(ray);
  return impl_->shader.Shade(ray, hit, options, {}, /*split=*/false, work).Sum();
}

Image Renderer::Render(const CameraView& view, const RenderOptions& options, RenderReport* report,
                       const std::function<bool(double)>& progress) const {
  return Render(view, options, LayerSet(), report, progress).color;
}

LayeredImage Renderer::Render(const CameraView& view, const RenderOptions& options, const LayerSet& wanted,
                              RenderReport* report, const std::function<bool(double)>& progress) const {
  const auto start = std::chrono::steady_clock::now();
  const EyeRays eye_rays(view, options);
  const int samples = eye_rays.per_pixel();
  const PixelRect window = options.Window();
  LayeredImage image(window.width(), window.height(), wanted);

  struct Scratch {
    std::vector<Ray> rays;
    std::vector<RayHit> hits;
    EyeShader::Work work;
  };
  tbb::enumerable_thread_specific<Scratch> scratches;
  struct Sums {  // of a tile
    double clamped = 0, cut_off = 0, shown = 0;
    uint64_t rays = 0, pixels = 0;
  };
  std::vector<Sums> sums(TileCount(options));
  const bool split = wanted.Has(Layer::kDirect) || wanted.Has(Layer::kIndirect);

  const auto render_tile = [&](const Tile& tile) {
    Scratch& scratch = scratches.local();
    scratch.work.rays = 0;
    scratch.work.cut_off = 0;
    scratch.rays.clear();
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) eye_rays.Append(x, y, &scratch.rays);
    }
    scratch.hits.resize(scratch.rays.size());
    impl_->shader.paths().tracer().Intersect(scratch.rays, scratch.hits, /*coherent=*/true);
    Sums& sum = sums[tile.index];
    size_t ray = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        const uint64_t key = Mix(Mix(options.seed, 0x9a7e), uint64_t(y) * options.width + x);
        EyeLight pixel;
        for (int s = 0; s < samples; ++s) {
          pixel += impl_->shader.Shade(scratch.rays[ray + s], scratch.hits[ray + s], options,
                                       {key, uint32_t(s)}, split, scratch.work);
        }
        const Rgb colour = pixel.Sum();
        sum.shown += colour.sum();
        sum.clamped += pixel.clamped.sum();
        ++sum.pixels;
        if (window.Contains(x, y)) {
          const int column = x - window.x0, row = y - window.y0;
          image.color.at(column, row) = colour / float(samples);
          if (!wanted.empty()) {
            const std::span rays(scratch.rays.data() + ray, samples);
            const std::span hits(scratch.hits.data() + ray, samples);
            impl_->PutLayers(view, rays, hits, pixel, column, row, &image);
          }
        }
        ray += samples;
      }
    }
    sum.rays = scratch.rays.size() + scratch.work.rays;
    sum.cut_off = scratch.work.cut_off;
  };
  const bool complete = ForEachTile(options, render_tile, progress);

  if (report) {
    *report = {};
    double clamped = 0, shown = 0, cut = 0;
    uint64_t pixels = 0;
    for (const auto& s : sums) {
      clamped += s.clamped;
      shown += s.shown;
      cut += s.cut_off;
      pixels += s.pixels;
      report->rays += s.rays;
    }
    report->clamped = shown > 0 ? clamped / shown : 0;
    // Light behind the last mirror is taken to be as bright as the picture.
    report->cut_off = pixels > 0 ? cut / (3.0 * double(samples) * double(pixels)) : 0;
    report->complete = complete;
    report->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return image;
}

}  // namespace lobe
