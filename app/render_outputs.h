#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/console.h"
#include "app/render_views.h"
#include "render/exr.h"
#include "render/png.h"

namespace lobe {

/// The files of one view.
struct ViewFiles {
  std::vector<std::string> pictures;
  std::optional<std::string> mask;
};

/// The flags of `lobe render` that say what is written where: -o, --mask and the look of pictures. Names may
/// hold {camera} and {frame}, so that one pattern names the files of many views.
class RenderOutputs {
 public:
  void AddTo(CLI::App* command);

  /// Everything that can be said without opening a file: endings, unknown placeholders, one name for
  /// several views; and, by CheckWritable, folders that are not there. Throws UsageError and InputError.
  void Validate(const RenderViews& views) const;
  /// The files of every view, none of them twice. Throws InputError (cameras of one name, not writable).
  std::vector<ViewFiles> FilesOf(const std::vector<RenderView>& views, const std::string& scene) const;

  bool wants_exr() const;  ///< is any picture an .exr?
  bool wants_mask() const { return mask_.has_value(); }
  /// Writes the pictures of a view and says so.
  void Write(const LayeredImage& image, const ExrAttributes& attributes, const RenderView& view,
             const ViewFiles& files, const Console& console) const;
  void WriteMask(const Mask& mask, const ViewFiles& files, const Console& console) const;

 private:
  std::vector<std::string> pictures_;
  std::optional<std::string> mask_;
  std::string tone_ = "srgb";
  float exposure_ = 0;
  bool half_ = false;
};

}  // namespace lobe
