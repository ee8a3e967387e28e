#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/view_flags.h"
#include "render/camera_path.h"

namespace lobe {

/// A picture to be rendered.
struct RenderView {
  Camera camera;
  PictureSize size;
  PixelRect crop;            ///< empty: all of it
  std::optional<int> frame;  ///< of a camera path
  std::string words;         ///< for people: "'view0'", "frame 12"
};

/// The flags of `lobe render` that say which views there will be: those of one camera (ViewFlags), or
/// --all-cameras, or --camera-path with --frames; and --crop.
class RenderViews {
 public:
  void AddTo(CLI::App* command);

  /// Everything that can be said without opening a file. Throws UsageError.
  void Validate();
  /// Reads the camera path, if there is one. Throws InputError.
  void ReadFiles();
  /// All views, in order, their crops within their pictures. Throws InputError or UsageError.
  std::vector<RenderView> Choose(const Scene& scene) const;

  bool all_cameras() const { return all_cameras_; }
  bool along_path() const { return path_file_.has_value(); }
  bool several() const { return all_cameras() || along_path(); }

 private:
  ViewFlags one_;
  bool all_cameras_ = false;
  std::optional<std::string> path_file_, crop_text_;
  std::optional<int> frame_count_;

  // From the flags and files, once checked.
  PixelRect crop_;
  std::optional<CameraPath> path_;
  std::vector<PathFrame> frames_;
};

}  // namespace lobe
