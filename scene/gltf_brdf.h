#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/glb_writer.h"
#include "scene/gltf_file.h"
#include "scene/gltf_json.h"
#include "scene/scene.h"

namespace lobe {

/// Ours: a model that glTF does not have, in place of metallic-roughness (docs/format.md#materials).
inline constexpr const char* kBrdfExtension = "LOBE_materials_brdf";

/// Reads that extension of a file's materials. Materials with the same measured data share it.
class BrdfExtensionReader {
 public:
  /// Both outlive this. Measured data that gains energy is warned of.
  BrdfExtensionReader(const GltfFile& file, std::vector<std::string>* warnings)
      : file_(file), warnings_(warnings) {}
  /// Throws InputError.
  Reflectance Read(const GltfJson& brdf);

 private:
  Measured ReadMeasured(const GltfJson& brdf);
  Measured ReadUri(const GltfJson& brdf);
  Measured ReadAccessors(const GltfJson& brdf);
  void WarnOfGain(const GltfJson& brdf, const MeasuredBrdf& data);

  const GltfFile& file_;
  std::vector<std::string>* warnings_;
  std::map<std::string, Measured> read_;  // by all that they follow from
};

/// Measured data as members of the extension. With a `writer` the data goes into its accessors, once however
/// many materials have it; without, its digest stands for it, which is enough to compare materials by.
nlohmann::json MeasuredJson(const MeasuredBrdf& data, GlbWriter* writer);

}  // namespace lobe
