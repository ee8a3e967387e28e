#pragma once

#include <initializer_list>
#include <string>

#include "render/tone.h"
#include "scene/scene.h"
#include "scene/uri.h"

namespace lobe {

/// Values of flags that are more than one number. All throw UsageError naming the flag and what was given.

struct PictureSize {
  int width = 0, height = 0;
};
/// "640x480".
PictureSize ParseSize(const std::string& flag, const std::string& text);
/// 512 pixels high, as wide as the camera's aspect asks for.
PictureSize DefaultSize(const Camera& camera);

/// "1,2.5,-3", finite.
Vec3 ParseVector(const std::string& flag, const std::string& text);

struct PixelPosition {
  int x = 0, y = 0;
};
/// "17,3", from the top left, 0,0.
PixelPosition ParsePixel(const std::string& flag, const std::string& text);

/// "10,20,30,40": pixels 10..29 and 20..39, not empty and not negative.
PixelRect ParseRect(const std::string& flag, const std::string& text);

/// "srgb", "reinhard", "filmic".
ToneCurve ParseTone(const std::string& flag, const std::string& text);
/// Stops, within +-100: beyond, every picture is black or white.
void RequireExposure(const std::string& flag, float stops);
/// Output files must end in one of `endings`: what is written follows from it.
void RequireExtension(const std::string& flag, const std::string& path,
                      std::initializer_list<const char*> endings);
/// An output that is also the input (by another name, too) would destroy it. `what`: "the scene".
void RequireOtherFile(const std::string& flag, const std::string& path, const std::string& input,
                      const std::string& what);

}  // namespace lobe
