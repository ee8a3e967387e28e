#include <sstream>

#include "scene/gltf_brdf.h"
#include "scene/gltf_nodes.h"
#include "scene/gltf_scene.h"

namespace lobe {

namespace {

constexpr const char* kTransmissionExtension = "KHR_materials_diffuse_transmission";
constexpr const char* kGlassExtension = "KHR_materials_transmission";
constexpr const char* kVolumeExtension = "KHR_materials_volume";

void WarnOfTextures(const GltfJson& place, const GltfJson& material, std::vector<std::string>* warnings) {
  for (const auto& [key, value] : place.value().items()) {
    if (!key.ends_with("Texture")) continue;
    const bool has_factor = key != "normalTexture" && key != "occlusionTexture";
    warnings->push_back(material.element() + ": " + key + " is not read; " +
                        (has_factor ? "its factor is used" : "the surface is taken without it"));
  }
}

// Needs the rest of the material, which decides whether any light goes through.
void ReadGlass(const GltfJson& material, MetallicRoughness* m, std::vector<std::string>* warnings) {
  const GltfJson glass = material.Extension(kGlassExtension);
  m->transmission = static_cast<float>(glass.Number("transmissionFactor", 0, 0, 1));
  WarnOfTextures(glass, material, warnings);
  MetallicRoughness smooth = *m;
  smooth.roughness = 0;
  if (m->transmission == 0 || !IsGlass(smooth)) return;

  if (m->roughness >= kMirrorRoughness) {
    std::ostringstream sentence;
    sentence << material.element() << ": it transmits light with roughness " << m->roughness
             << ", but only ideal glass is read; it is taken as roughness 0";
    warnings->push_back(sentence.str());
    m->roughness = 0;
  }
  const GltfJson volume = material.Extension(kVolumeExtension);
  m->thickness = static_cast<float>(volume.Number("thicknessFactor", 0, 0));
  if (volume.Has("attenuationDistance")) {
    m->attenuation_distance = static_cast<float>(volume.Number("attenuationDistance", 0));
    if (!(m->attenuation_distance > 0)) volume.FailValue("attenuationDistance", "more than 0");
  }
  // Above 1 light would grow on its way.
  m->attenuation_color = volume.Color("attenuationColor", Rgb::Constant(1), 0, 1);
  WarnOfTextures(volume, material, warnings);
  if (m->thickness > 0 && m->diffuse_transmission > 0) {
    m->diffuse_transmission = 0;
    warnings->push_back(material.element() + ": " + kTransmissionExtension +
                        " is read for thin sheets only; " + "this solid body is taken without it");
  }
}

MetallicRoughness ReadMetallicRoughness(const GltfJson& material, std::vector<std::string>* warnings) {
  MetallicRoughness m;
  const GltfJson pbr = material.Object("pbrMetallicRoughness");
  double base[4] = {1, 1, 1, 1};
  pbr.Numbers("baseColorFactor", 4, base, 0, 1);
  m.base_color = Eigen::Array3d(base[0], base[1], base[2]).cast<float>();
  m.metallic = static_cast<float>(pbr.Number("metallicFactor", 1, 0, 1));
  m.roughness = static_cast<float>(pbr.Number("roughnessFactor", 1, 0, 1));
  WarnOfTextures(pbr, material, warnings);

  // An ior of 0 stands for infinity: Fresnel reflection is complete at every angle. The formula
  // f0 = ((ior - 1) / (ior + 1))^2 gives just that, so 0 is kept.
  const GltfJson ior = material.Extension("KHR_materials_ior");
  m.ior = static_cast<float>(ior.Number("ior", 1.5, 0));
  if (m.ior != 0 && m.ior < 1) ior.FailValue("ior", "0 or at least 1");

  m.has_specular = material.Object("extensions").Has("KHR_materials_specular");
  const GltfJson specular = material.Extension("KHR_materials_specular");
  m.specular = static_cast<float>(specular.Number("specularFactor", 1, 0, 1));
  m.specular_color = specular.Color("specularColorFactor", Rgb::Constant(1));
  WarnOfTextures(specular, material, warnings);

  const GltfJson transmission = material.Extension(kTransmissionExtension);
  m.diffuse_transmission = static_cast<float>(transmission.Number("diffuseTransmissionFactor", 0, 0, 1));
  // Above 1 the sheet would gain energy.
  m.diffuse_transmission_color = transmission.Color("diffuseTransmissionColorFactor", Rgb::Constant(1), 0, 1);
  WarnOfTextures(transmission, material, warnings);
  ReadGlass(material, &m, warnings);
  return m;
}

void WarnOfTheRest(const GltfJson& material, const Material& read, std::vector<std::string>* warnings) {
  WarnOfTextures(material, material, warnings);
  const std::string alpha = material.String("alphaMode", "OPAQUE");
  if (alpha != "OPAQUE") {
    warnings->push_back(material.element() + ": alphaMode " + alpha + " is not read; the surface is opaque");
  }
  const GltfJson extensions = material.Object("extensions");
  for (const auto& [name, value] : extensions.value().items()) {
    if (name == "KHR_materials_ior" || name == "KHR_materials_specular" ||
        name == "KHR_materials_emissive_strength" || name == kBrdfExtension) {
      continue;
    }
    // Our own models have no transmission.
    const bool transmission = name == kTransmissionExtension || name == kGlassExtension;
    if (transmission && std::holds_alternative<MetallicRoughness>(read.reflectance)) continue;
    if (name == kVolumeExtension && read.glass()) continue;
    const bool opaque = !read.transmits() && transmission;
    warnings->push_back(material.element() + ": " + name + " is not read; " +
                        (opaque ? "the surface is opaque" : "the material is taken without it"));
  }
}

}  // namespace

std::vector<Material> ReadMaterials(const GltfFile& file, std::vector<std::string>* warnings) {
  const GltfJson document = Document(file);
  std::vector<Material> materials;
  BrdfExtensionReader brdfs(file, warnings);
  for (size_t i = 0; i < document.Count("materials"); ++i) {
    const GltfJson json = document.Entry("materials", i, "material");
    Material material;
    material.name = json.String("name");
    if (material.name.empty()) material.name = "material " + std::to_string(i);
    material.double_sided = json.Bool("doubleSided", false);
    const Rgb factor = json.Color("emissiveFactor", Rgb::Zero());
    const GltfJson strength = json.Extension("KHR_materials_emissive_strength");
    material.emission = factor * static_cast<float>(strength.Number("emissiveStrength", 1, 0));
    // Channels are summed in many places.
    if (!std::isfinite(material.emission.sum()))
      json.Fail("emissiveFactor times emissiveStrength is not finite");
    if (json.Object("extensions").Has(kBrdfExtension)) {
      material.reflectance = brdfs.Read(json.Extension(kBrdfExtension));
    } else {
      material.reflectance = ReadMetallicRoughness(json, warnings);
    }
    if ((material.transmits() || material.pane()) && !material.double_sided) {
      material.double_sided = true;
      warnings->push_back(json.element() + ": it lets light through by " +
                          (material.pane() ? kGlassExtension : kTransmissionExtension) +
                          " but is not doubleSided; it is taken as double-sided");
    }
    WarnOfTheRest(json, material, warnings);
    materials.push_back(std::move(material));
  }
  return materials;
}

}  // namespace lobe
