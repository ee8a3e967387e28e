#pragma once

#include <functional>
#include <memory>
#include <string>

#include "render/path_tracing.h"
#include "render/renderer.h"

namespace lobe {

/// What pictures are made from, read and prepared once for all views: a solution's lobes, or, by path
/// tracing, the scene of a solution or a scene that was never solved.
class PictureSource {
 public:
  /// Throws InputError; lobes need a solution, and one that has converged unless `unconverged` lets others
  /// pass.
  PictureSource(const std::string& path, bool path_traced, bool unconverged);
  ~PictureSource();

  const Scene& scene() const { return *scene_; }
  /// What is to be said of the solution's lobes (solver/trust.h); empty if nothing, and by path tracing.
  std::string TrustSentence() const;
  const RayTracer& tracer() const;
  /// By path tracing `layers` must be empty.
  LayeredImage Render(const CameraView& view, const RenderOptions& options, const LayerSet& layers,
                      RenderReport* report, const std::function<bool(double)>& progress) const;

 private:
  std::unique_ptr<const Solution> solution_;
  std::unique_ptr<const Scene> own_scene_;
  const Scene* scene_;
  std::unique_ptr<const Renderer> renderer_;
  std::unique_ptr<const PathTracer> paths_;
};

}  // namespace lobe
