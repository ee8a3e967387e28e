// From a glTF scene to a picture in ten lines. Arguments: scene.glb picture.png
#include "render/png.h"
#include "render/renderer.h"
#include "scene/gltf_scene.h"
#include "solver/solver.h"

int main(int, char** argv) {
  lobe::SolveOptions options;
  options.mesh.max_edge = 0.8f;  // metres; finer is better and slower
  const lobe::Solution solution = lobe::Solve(lobe::ReadGltfScene(argv[1]), options);
  const lobe::Renderer renderer(solution);  // any number of views from here on
  const lobe::CameraView view(solution.scene.cameras[0], 256, 256);
  const lobe::Image image = renderer.Render(view, {.width = 256, .height = 256}, nullptr);
  lobe::WritePng(image, /*exposure=*/0, argv[2]);
}
