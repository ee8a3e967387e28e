#include "app/render_views.h"

#include "app/commands.h"
#include "render/renderer.h"
#include "scene/input_error.h"

namespace lobe {

void RenderViews::AddTo(CLI::App* command) {
  one_.AddTo(command);
  command->add_flag("--all-cameras", all_cameras_, "Every camera of the file; -o then holds {camera}");
  command
      ->add_option("--camera-path", path_file_,
                   "A flight through keyframes, JSON (docs/format.md); -o then holds {frame}")
      ->type_name("FILE");
  command
      ->add_option("--frames", frame_count_,
                   "With --camera-path: so many frames, evenly from first to last key [every whole frame]")
      ->type_name("N");
  command
      ->add_option("--crop", crop_text_,
                   "Only these pixels of the picture, X1 and Y1 excluded; they are the same as in the whole")
      ->type_name("X0,Y0,X1,Y1");
}

void RenderViews::Validate() {
  one_.Validate();
  if (all_cameras_ && along_path()) {
    throw UsageError("--all-cameras and --camera-path exclude each other; one of them is expected");
  }
  if (several() && one_.one_camera_given()) {
    throw UsageError(std::string(all_cameras_ ? "--all-cameras" : "--camera-path") +
                     " chooses the views; --camera, --eye, --target and --up are not expected with it");
  }
  if (along_path() && one_.fov_given()) {
    throw UsageError("--fov: with --camera-path the keyframes say the field of view");
  }
  if (frame_count_ && !along_path()) throw UsageError("--frames belongs to --camera-path, which is missing");
  if (frame_count_ && (*frame_count_ < 1 || *frame_count_ > kMaxFrames)) {
    throw UsageError("--frames: " + std::to_string(*frame_count_) + " is out of range: 1 to " +
                     std::to_string(kMaxFrames) + " is expected");
  }
  if (crop_text_) crop_ = ParseRect("--crop", *crop_text_);
}

void RenderViews::ReadFiles() {
  if (!along_path()) return;
  path_ = ReadCameraPath(*path_file_);
  if (!frame_count_ && !path_->in_frames()) {
    throw UsageError("--camera-path: " + *path_file_ +
                     " has times instead of frame numbers; --frames is expected to say how many frames");
  }
  try {
    frames_ = path_->Frames(frame_count_);
    for (const PathFrame& frame : frames_)
      path_->At(frame.time);  // before work is done for those that have a view
  } catch (const InputError& e) {
    throw InputError(*path_file_ + ": " + e.what());
  }
}

std::vector<RenderView> RenderViews::Choose(const Scene& scene) const {
  std::vector<RenderView> views;
  const auto add = [&](const Camera& camera, std::optional<int> frame) {
    const std::string words = frame ? "frame " + std::to_string(*frame) : "'" + camera.name + "'";
    const PictureSize size = one_.ChooseSize(camera);
    RenderOptions fits{.width = size.width, .height = size.height, .crop = crop_};
    if (const std::string wrong = fits.Validate(); !wrong.empty()) {
      throw UsageError("--" + wrong + (several() ? " (" + words + ")" : ""));
    }
    views.push_back({camera, size, crop_, frame, words});
  };
  if (all_cameras_) {
    for (const Camera& camera : one_.EveryCamera(scene)) add(camera, std::nullopt);
  } else if (along_path()) {
    for (const PathFrame& frame : frames_) add(path_->At(frame.time), frame.number);
  } else {
    add(one_.ChooseCamera(scene), std::nullopt);
  }
  return views;
}

}  // namespace lobe
