#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/values.h"

namespace lobe {

/// The flags that say where a picture is seen from and how large it is: a camera of the file by name, or
/// one of the user's own by --eye, --target, --up and --fov; and --size.
class ViewFlags {
 public:
  void AddTo(CLI::App* command);

  /// Everything that can be said without a scene. Throws UsageError. To be called before the others.
  void Validate();
  /// Any of them given?
  bool given() const { return camera_ || eye_ || target_ || up_ || fov_degrees_ || size_; }

  /// Do they say where to look from, by name or by numbers?
  bool one_camera_given() const { return camera_ || eye_ || target_ || up_; }
  bool fov_given() const { return fov_degrees_.has_value(); }

  /// Throws InputError if the scene has no camera, or none of that name.
  Camera ChooseCamera(const Scene& scene) const;
  /// All cameras of the file, with --fov if that is given. Throws InputError if there are none.
  std::vector<Camera> EveryCamera(const Scene& scene) const;
  PictureSize ChooseSize(const Camera& camera) const { return picture_size_.value_or(DefaultSize(camera)); }

 private:
  std::optional<std::string> camera_, eye_, target_, up_, size_;
  std::optional<double> fov_degrees_;

  // From the flags, once checked.
  std::optional<PictureSize> picture_size_;
  std::optional<Camera> own_camera_;
};

}  // namespace lobe
