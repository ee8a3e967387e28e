#include "render/renderer.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <sstream>

#include <tbb/enumerable_thread_specific.h>

#include "render/eye_rays.h"
#include "render/eye_shader.h"
#include "render/tile_renderer.h"

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
  } else if (!(specular_cutoff >= 1e-6f && specular_cutoff < 1)) {
    out << "specular cut-off " << specular_cutoff
        << " is out of range: at least 0.000001 and below 1 is expected";
  } else if (light_samples < 1 || light_samples > 65536) {
    out << "light samples " << light_samples << " is out of range: 1 to 65536 is expected";
  } else if (gather_samples < 1 || gather_samples > 65536) {
    out << "gather samples " << gather_samples << " is out of range: 1 to 65536 is expected";
  }
  return out.str();
}

namespace {

// What a pixel's random numbers follow from.
uint64_t PixelKey(const RenderOptions& options, int x, int y) {
  return Mix(Mix(options.seed, 0x9a7e), uint64_t(y) * options.width + x);
}

}  // namespace

struct Renderer::Impl {
  const Solution& solution;
  EyeShader shader;

  explicit Impl(const Solution& s) : solution(s), shader(s) {}

  struct Scratch {
    PixelRays pixel;
    EyeShader::Work work;
  };
  struct Sums {  // of a tile
    double clamped = 0, cut_off = 0, shown = 0;
    uint64_t rays = 0, eye_rays = 0;
  };

  // Of every side of every material: is what the eye sees of it read from lobes alone in this mode?
  std::vector<uint8_t> ReadFromLobes(const RenderOptions& options) const {
    std::vector<uint8_t> out;
    for (uint32_t m = 0; m < solution.scene.materials.size(); ++m) {
      const bool stored = shader.paths().specular().kind(m) == SpecularSurfaces::Kind::kNone &&
                          shader.ReadingOf(m, kNone, options) == EyeShader::Reading::kStored;
      out.insert(out.end(), 2, stored);
    }
    return out;
  }

  // Elements on such sides that are not.
  std::vector<uint8_t> NotReadFromLobes(const RenderOptions& options) const {
    std::vector<uint8_t> out;
    if (options.mode != RenderMode::kAuto) return out;
    for (const NotStored what : shader.curved()) out.push_back(what != NotStored::kNothing);
    return out;
  }

  // Every eye ray on its own, so that what it brings can be told apart.
  void RenderLayers(const CameraView& view, const EyeRays& eye_rays, const RenderOptions& options,
                    const LayerSet& wanted, const Tile& tile, Scratch& scratch, LayeredImage* image,
                    Sums* sum) const {
    const int samples = eye_rays.per_pixel();
    const PixelRect window = options.Window(), part = Intersection(tile.rect(), window);
    const bool split = wanted.Has(Layer::kDirect) || wanted.Has(Layer::kIndirect);
    PixelRays& pixel = scratch.pixel;
    for (int y = part.y0; y < part.y1; ++y) {
      for (int x = part.x0; x < part.x1; ++x) {
        pixel.Trace(eye_rays, shader.paths().tracer(), x, y);
        EyeLight light;
        for (int s = 0; s < samples; ++s) {
          light += shader.Shade(pixel.rays[s], pixel.hits[s], options, {PixelKey(options, x, y), uint32_t(s)},
                                split, scratch.work);
        }
        const Rgb colour = light.Sum();
        image->color.at(x - window.x0, y - window.y0) = colour / float(samples);
        sum->shown += colour.sum();
        sum->clamped += light.clamped.sum();
        sum->eye_rays += uint64_t(samples);
        PutLayers(view, pixel.rays, pixel.hits, light, x - window.x0, y - window.y0, image);
      }
    }
  }

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
      const Material& material = solution.scene.materials[shader.paths().material(hit.face)];
      if (hit.side == Side::kBack && !material.double_sided && !material.body()) return;  // black
      *out += each * NormalAlbedo(material.reflectance);
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
  const PixelRect window = options.Window();
  LayeredImage image(window.width(), window.height(), wanted);

  const TileRenderer tiles(impl_->solution, tracer(), impl_->shader.stored().locator(),
                           impl_->ReadFromLobes(options), impl_->NotReadFromLobes(options));
  const int side = wanted.empty() ? tiles.TileSide(eye_rays, options.width, options.height) : kSmallTile;
  tbb::enumerable_thread_specific<Impl::Scratch> scratches;
  std::vector<Impl::Sums> sums(TileCount(options, side));
  const auto render_tile = [&](const Tile& tile) {
    Impl::Scratch& scratch = scratches.local();
    Impl::Sums& sum = sums[tile.index];
    scratch.work.rays = 0;
    scratch.work.cut_off = 0;
    if (!wanted.empty()) {
      impl_->RenderLayers(view, eye_rays, options, wanted, tile, scratch, &image, &sum);
    } else {
      const auto shade = [&](const Ray& ray, const RayHit& hit, int x, int y, int sample) {
        const EyeLight light =
            impl_->shader.Shade(ray, hit, options, {PixelKey(options, x, y), uint32_t(sample)},
                                /*split=*/false, scratch.work);
        sum.clamped += light.clamped.sum();
        return light.Sum();
      };
      TileRenderer::Sums stored;
      tiles.Render(eye_rays, tile, window, shade, &image.color, &stored);
      sum.clamped += stored.clamped;
      sum.shown += stored.shown;
      sum.eye_rays += stored.rays;
    }
    sum.rays += sum.eye_rays + scratch.work.rays;
    sum.cut_off += scratch.work.cut_off;
  };
  const bool complete = ForEachTile(options, side, render_tile, progress);

  if (report) {
    *report = {};
    double clamped = 0, shown = 0, cut = 0;
    uint64_t eye_ray_count = 0;
    for (const auto& s : sums) {
      clamped += s.clamped;
      shown += s.shown;
      cut += s.cut_off;
      report->rays += s.rays;
      eye_ray_count += s.eye_rays;
    }
    report->clamped = shown > 0 ? clamped / shown : 0;
    // What is behind the last mirror is taken to be as bright as the picture.
    report->cut_off = eye_ray_count > 0 ? cut / (3.0 * double(eye_ray_count)) : 0;
    report->samples_per_pixel = eye_rays.per_pixel();
    report->complete = complete;
    report->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return image;
}

}  // namespace lobe
