#pragma once

#include <string>
#include <vector>

#include "brdf/reflectance.h"

namespace lobe {

/// What `lobe brdf` is asked about: "scene.glb#floor", "ggx:roughness=0.4,f0=0.9" or "paint.binary".
struct NamedReflectance {
  std::string name;
  Reflectance reflectance;
  std::vector<std::string> warnings;  ///< of the scene it is in
};

/// - FILE#MATERIAL: a material of a scene or solution, by name (FILE ends in .glb or .gltf).
/// - A file whose name ends in .binary, .csv or .txt: measured data.
/// - MODEL or MODEL:PARAMETER=VALUE,...; colours are one number or R/G/B.
/// Throws UsageError for what is wrong with the words, InputError for what is wrong with the file.
NamedReflectance ParseBrdfSpec(const std::string& spec);

/// Models, parameters, ranges and defaults, a line each.
std::string BrdfModelsHelp();

}  // namespace lobe
