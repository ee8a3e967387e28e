#include "app/view_flags.h"

#include <numbers>

#include "app/commands.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

constexpr double kDefaultFov = 40;  ///< degrees, with --eye (chosen)

float Radians(double degrees) { return static_cast<float>(degrees * std::numbers::pi / 180); }

}  // namespace

void ViewFlags::AddTo(CLI::App* command) {
  command->add_option("--camera", camera_, "Camera of the file, by name [the first]")->type_name("NAME");
  command
      ->add_option("--size", size_, "Picture size in pixels, such as 640x480 [512 high, the camera's aspect]")
      ->type_name("WxH");
  command->add_option("--eye", eye_, "A camera of your own: where it stands, metres")->type_name("X,Y,Z");
  command->add_option("--target", target_, "With --eye: the point it looks at, metres")->type_name("X,Y,Z");
  command->add_option("--up", up_, "With --eye: the direction that is up in the picture [0,1,0]")
      ->type_name("X,Y,Z");
  command->add_option("--fov", fov_degrees_, "Vertical field of view, degrees [the camera's; 40 with --eye]")
      ->type_name("DEG");
}

void ViewFlags::Validate() {
  if (size_) picture_size_ = ParseSize("--size", *size_);
  if (fov_degrees_ && !(*fov_degrees_ > 0 && *fov_degrees_ < 180)) {
    throw UsageError("--fov: " + Short(*fov_degrees_) +
                     " is out of range: degrees between 0 and 180 are expected");
  }
  if (!eye_) {
    if (target_ || up_) throw UsageError("--target and --up belong to --eye, which is missing");
    return;
  }
  if (camera_) throw UsageError("--camera and --eye exclude each other; one of them is expected");
  if (!target_) throw UsageError("--eye needs --target, the point to look at");
  const Vec3 eye = ParseVector("--eye", *eye_), target = ParseVector("--target", *target_);
  const Vec3 up = up_ ? ParseVector("--up", *up_) : Vec3(0, 1, 0);
  try {
    own_camera_ = LookAt(eye, target, up, Radians(fov_degrees_.value_or(kDefaultFov)));
  } catch (const InputError& e) {
    throw UsageError(e.what());  // these values came from flags
  }
}

Camera ViewFlags::ChooseCamera(const Scene& scene) const {
  if (own_camera_) return *own_camera_;
  if (!camera_) return EveryCamera(scene).front();
  Camera camera = scene.FindCamera(*camera_);
  if (fov_degrees_) camera.fov_y = Radians(*fov_degrees_);
  return camera;
}

std::vector<Camera> ViewFlags::EveryCamera(const Scene& scene) const {
  if (scene.cameras.empty()) {
    throw InputError(scene.path +
                     ": has no camera; --eye and --target are expected to say where to look from");
  }
  std::vector<Camera> cameras = scene.cameras;
  for (Camera& camera : cameras) {
    if (fov_degrees_) camera.fov_y = Radians(*fov_degrees_);
  }
  return cameras;
}

}  // namespace lobe
