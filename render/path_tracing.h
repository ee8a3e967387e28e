#pragma once

#include <functional>

#include "render/path_tracer.h"
#include "render/renderer.h"

namespace lobe {

/// A picture by path tracing: one path per eye ray, options.samples_per_pixel of them (mirror depth means
/// nothing here). Eye rays are those of Renderer::Render. Throws std::invalid_argument if options.Validate()
/// complains; `progress` as there; report->clamped and cut_off stay 0. Same bits for any number of
/// threads; pictures of different seeds are independent.
Image RenderPathTraced(const PathTracer& paths, const CameraView& view, const RenderOptions& options,
                       RenderReport* report = nullptr, const std::function<bool(double)>& progress = {});

}  // namespace lobe
