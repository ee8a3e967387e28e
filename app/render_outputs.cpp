#include "app/render_outputs.h"

#include <algorithm>

#include <cstdio>
#include <filesystem>
#include <map>

#include "app/commands.h"
#include "app/values.h"
#include "render/png.h"
#include "scene/glb_writer.h"
#include "scene/input_error.h"

namespace lobe {
namespace {

constexpr const char *kCamera = "{camera}", *kFrame = "{frame}";

/// Calls `found(begin, end)` for every {word} in a name.
template <typename Found>
void ForEachPlaceholder(const std::string& name, const Found& found) {
  for (size_t begin = name.find('{'); begin != std::string::npos; begin = name.find('{', begin + 1)) {
    const size_t end = name.find('}', begin);
    if (end != std::string::npos) found(begin, end + 1);
  }
}

bool Has(const std::string& name, const char* placeholder) {
  return name.find(placeholder) != std::string::npos;
}

void CheckPattern(const std::string& flag, const std::string& name, const RenderViews& views) {
  ForEachPlaceholder(name, [&](size_t begin, size_t end) {
    const std::string word = name.substr(begin, end - begin);
    if (word != kCamera && word != kFrame) {
      throw UsageError(flag + ": '" + word + "' in '" + name +
                       "' is unknown; {camera} and {frame} are expected");
    }
  });
  if (views.along_path()) {
    if (!Has(name, kFrame)) {
      throw UsageError(flag + ": '" + name + "' is one name for several frames; {frame} is expected in it");
    }
    if (Has(name, kCamera)) {
      throw UsageError(flag + ": '" + name +
                       "' holds {camera}, which a --camera-path has not; {frame} is expected");
    }
    return;
  }
  if (Has(name, kFrame)) {
    throw UsageError(flag + ": '" + name +
                     "' holds {frame}, which belongs to --camera-path; that is missing");
  }
  if (views.all_cameras() && !Has(name, kCamera)) {
    throw UsageError(flag + ": '" + name + "' is one name for several cameras; {camera} is expected in it");
  }
}

/// A camera's name as part of a file's: it must not lead to another folder, or hide the file.
std::string AsFileName(std::string name) {
  for (char& c : name) {
    if (c == '/' || c == '\\' || static_cast<unsigned char>(c) < 0x20) c = '_';
  }
  if (name.empty()) return "camera";
  if (name[0] == '.') name[0] = '_';
  return name;
}

std::string Replaced(std::string name, const std::string& placeholder, const std::string& by) {
  for (size_t at = name.find(placeholder); at != std::string::npos;
       at = name.find(placeholder, at + by.size())) {
    name.replace(at, placeholder.size(), by);
  }
  return name;
}

std::string Expand(const std::string& pattern, const RenderView& view) {
  if (!view.frame) return Replaced(pattern, kCamera, AsFileName(view.camera.name));
  char number[16];
  std::snprintf(number, sizeof number, "%04d", *view.frame);
  return Replaced(pattern, kFrame, number);
}

}  // namespace

void RenderOutputs::AddTo(CLI::App* command) {
  command
      ->add_option(
          "-o,--output", pictures_,
          "Picture to write, .exr (scene-linear) or .png (sRGB); may be repeated. {camera} and {frame} "
          "stand for the camera's name and the frame's number in four digits")
      ->type_name("FILE")
      ->required()
      ->allow_extra_args(false);
  command
      ->add_option("--mask", mask_,
                   "PNG to write: white where an emitter is seen directly or within two pixels, for `lobe "
                   "compare --mask`")
      ->type_name("FILE");
  command->add_option("--exposure", exposure_, "Of PNG pictures, in stops: values times 2^EV")
      ->type_name("EV")
      ->capture_default_str();
  command
      ->add_option("--tone", tone_,
                   "Of PNG pictures: srgb (cut at 1), reinhard (white at 4) or filmic (Hable, white at 5.6)")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_flag("--half", half_, "Colours of OpenEXR pictures as 16-bit half, at most 65504 [float]");
}

void RenderOutputs::Validate(const RenderViews& views) const {
  RequireExposure("--exposure", exposure_);
  ParseTone("--tone", tone_);
  for (const std::string& name : pictures_) {
    RequireExtension("-o", name, {".exr", ".png"});
    CheckPattern("-o", name, views);
  }
  if (mask_) {
    RequireExtension("--mask", *mask_, {".png"});
    CheckPattern("--mask", *mask_, views);
  }
  std::vector<std::string> all = pictures_;
  if (mask_) all.push_back(*mask_);
  std::map<std::string, int> uses;
  for (const std::string& name : all) {
    if (++uses[std::filesystem::path(name).lexically_normal().string()] > 1) {
      throw UsageError(name + " is asked for twice; every output needs a name of its own");
    }
    if (!Has(std::filesystem::path(name).parent_path().string(), kCamera) &&
        !Has(std::filesystem::path(name).parent_path().string(), kFrame)) {
      CheckWritable(name);
    }
  }
}

std::vector<ViewFiles> RenderOutputs::FilesOf(const std::vector<RenderView>& views,
                                              const std::string& scene) const {
  std::vector<ViewFiles> files;
  std::map<std::string, std::string> owner;
  for (const RenderView& view : views) {
    const auto named = [&](const std::string& pattern) {
      const std::string name = Expand(pattern, view);
      const auto [at, is_new] =
          owner.emplace(std::filesystem::path(name).lexically_normal().string(), view.words);
      if (!is_new) {
        throw InputError(scene + ": " + at->second + " and " + view.words + " would both be written to " +
                         name + "; different names are expected");
      }
      CheckWritable(name);
      return name;
    };
    ViewFiles of_view;
    for (const std::string& pattern : pictures_) of_view.pictures.push_back(named(pattern));
    if (mask_) of_view.mask = named(*mask_);
    files.push_back(of_view);
  }
  return files;
}

bool RenderOutputs::wants_exr() const {
  return std::any_of(pictures_.begin(), pictures_.end(),
                     [](const std::string& picture) { return Extension(picture) == ".exr"; });
}

void RenderOutputs::Write(const LayeredImage& image, const ExrAttributes& attributes, const RenderView& view,
                          const ViewFiles& files, const Console& console) const {
  for (const std::string& name : files.pictures) {
    if (Extension(name) == ".exr") {
      const ExrReport report = WriteExr(image, attributes,
                                        {.half_colours = half_,
                                         .full_width = view.size.width,
                                         .full_height = view.size.height,
                                         .left = view.crop.x0,
                                         .top = view.crop.y0},
                                        name);
      if (report.clamped > 0) {
        console.Warn(name + ": " + Count(report.clamped, "value") + " beyond " + Format("%.0f", kHalfMax) +
                     ", the largest half, cut to it; float, without --half, keeps them");
      }
    } else {
      WritePng(image.color, exposure_, name, ParseTone("--tone", tone_));
    }
    console.Say("wrote " + name);
  }
}

void RenderOutputs::WriteMask(const Mask& mask, const ViewFiles& files, const Console& console) const {
  WritePngMask(mask, *files.mask);
  console.Say("wrote " + *files.mask);
}

}  // namespace lobe
