#pragma once

#include "render/camera_view.h"
#include "render/png.h"
#include "render/renderer.h"

namespace lobe {

/// The emitter mask of docs/conventions.md#error: pixels with any eye ray that ends on an emitter, grown by
/// two pixels in every direction, diagonals included. Error figures leave these pixels out, since an
/// emitter's own radiance is no achievement and outshines everything.
///
/// Eye rays are those of Renderer::Render with the same options (`options.crop` too; growth reaches into a
/// crop from outside it). An emitter seen in a mirror is not masked. Throws std::invalid_argument if
/// options.Validate() complains. Same bits for any number of threads.
Mask EmitterMask(const Scene& scene, const RayTracer& tracer, const CameraView& view,
                 const RenderOptions& options);

}  // namespace lobe
