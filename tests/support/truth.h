#pragma once

#include <string>
#include <vector>

#include "render/compare.h"
#include "render/exr.h"
#include "render/renderer.h"

namespace lobe::test {

/// Renders every camera of `solution` (stored mode, default samples) and compares with the pair of references
/// FOLDER/truth/NAME.CAMERA.{a,b}.exr under their mask. In the order of the cameras.
inline std::vector<Comparison> CompareWithTruth(const Solution& solution, const std::string& folder,
                                                const std::string& name) {
  const Renderer renderer(solution);
  std::vector<Comparison> out;
  for (const Camera& camera : solution.scene.cameras) {
    const std::string truth = folder + "/truth/" + name + "." + camera.name;
    const Image a = ReadExr(truth + ".a.exr"), b = ReadExr(truth + ".b.exr");
    const Mask mask = ReadPngMask(truth + ".mask.png");
    RenderOptions view;
    view.width = a.width;
    view.height = a.height;
    view.mode = RenderMode::kStored;  // what a solve is judged by; the default gathers
    const Image picture = renderer.Render(CameraView(camera, a.width, a.height), view, nullptr);
    out.push_back(Compare(picture, a, &b, &mask));
  }
  return out;
}

}  // namespace lobe::test
