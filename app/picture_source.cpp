#include "app/picture_source.h"

#include "scene/gltf_scene.h"
#include "scene/input_error.h"
#include "solver/trust.h"

namespace lobe {

PictureSource::PictureSource(const std::string& path, bool path_traced, bool unconverged) {
  if (path_traced && !IsSolution(path)) {
    own_scene_ = std::make_unique<const Scene>(ReadGltfScene(path));
    scene_ = own_scene_.get();
  } else {
    solution_ = std::make_unique<const Solution>(ReadSolution(path));
    scene_ = &solution_->scene;
    if (!path_traced && !unconverged && JudgeSolution(*solution_) == Trust::kNotConverging) {
      throw InputError(path + ": " + lobe::TrustSentence(*solution_) + "; --unconverged renders it as it is");
    }
  }
  if (path_traced) {
    paths_ = std::make_unique<const PathTracer>(*scene_);
  } else {
    renderer_ = std::make_unique<const Renderer>(*solution_);
  }
}

PictureSource::~PictureSource() = default;

std::string PictureSource::TrustSentence() const {
  return renderer_ ? lobe::TrustSentence(*solution_) : std::string();
}

const RayTracer& PictureSource::tracer() const { return paths_ ? paths_->tracer() : renderer_->tracer(); }

LayeredImage PictureSource::Render(const CameraView& view, const RenderOptions& options,
                                   const LayerSet& layers, RenderReport* report,
                                   const std::function<bool(double)>& progress) const {
  if (renderer_) return renderer_->Render(view, options, layers, report, progress);
  LayeredImage image;
  image.color = RenderPathTraced(*paths_, view, options, report, progress);
  return image;
}

}  // namespace lobe
