#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lobe {

/// Where the camera is at one moment of a flight.
struct CameraKey {
  double time = 0;            ///< in frames or any other unit
  Vec3 eye, target;           ///< metres
  Vec3 up = Vec3(0, 1, 0);    ///< in the picture
  double fov_y_degrees = 40;  ///< vertical
};

/// A picture of the flight.
struct PathFrame {
  int number;
  double time;
};

/// A camera's flight through keyframes; files in docs/format.md#camera-path.
///
/// Eye, target, up and field of view are cubic Hermite splines in time through the keys, with the derivative
/// of the parabola through a key and its neighbours (Catmull-Rom for even keys; at the ends, of the last
/// three): smooth, no velocity jumps, and even motion stays even. Two equal keys in a row are a halt: the
/// value rests between them and has no velocity there. The field of view stays between its two keys.
class CameraPath {
 public:
  /// At least two keys, times rising. `in_frames`: times are whole numbers of frames. Throws InputError
  /// naming the key.
  CameraPath(std::vector<CameraKey> keys, bool in_frames);

  /// Throws InputError where the camera has no view: eye on target, or up along the view.
  Camera At(double time) const;

  /// `count` pictures, evenly spread from the first key to the last and numbered from 0; without it, every
  /// whole frame of a path in frames, by its number. Throws InputError if there are none or too many.
  std::vector<PathFrame> Frames(std::optional<int> count) const;
  bool in_frames() const { return in_frames_; }

 private:
  std::vector<CameraKey> keys_;
  bool in_frames_;
};

/// Throws InputError naming file, keyframe, what was found and what is expected.
CameraPath ReadCameraPath(const std::string& path);

/// More pictures than this in one go are taken for a slip (chosen: an hour at 25 a second is 90,000).
inline constexpr int kMaxFrames = 100000;

}  // namespace lobe
