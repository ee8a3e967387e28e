#include "scene/gltf_output.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>

#include "scene/gltf_brdf.h"

namespace lobe {
namespace {

using nlohmann::json;

json JsonColour(const Rgb& c) { return {JsonNumber(c[0]), JsonNumber(c[1]), JsonNumber(c[2])}; }

json BaseColour(const Rgb& c) {
  json out = JsonColour(c);
  out.push_back(1.0);
  return out;
}

// Other programs show the extension's models as rough or shiny plain material; reading back, the extension
// decides.
struct WriteReflectance {
  json* material;
  GlbWriter* writer;

  json& Pbr() const { return (*material)["pbrMetallicRoughness"]; }
  json& Extension(const char* name) const { return (*material)["extensions"][name]; }

  void operator()(const Lambert& m) const {
    Matte(m.albedo);
    Extension(kBrdfExtension) = {{"model", "lambert"}, {"albedo", JsonColour(m.albedo)}};
  }
  void operator()(const Phong& m) const {
    Metal(m.albedo, RoughnessOfPower(m.exponent));
    Extension(kBrdfExtension) = {
        {"model", "phong"}, {"albedo", JsonColour(m.albedo)}, {"exponent", JsonNumber(m.exponent)}};
  }
  void operator()(const Ward& m) const {
    Metal(m.albedo, std::sqrt(std::min(m.alpha, 1.0f)));
    Extension(kBrdfExtension) = {
        {"model", "ward"}, {"albedo", JsonColour(m.albedo)}, {"alpha", JsonNumber(m.alpha)}};
  }
  void operator()(const BlinnPhong& m) const {
    Metal(m.albedo, RoughnessOfPower(m.exponent));
    Extension(kBrdfExtension) = {
        {"model", "blinn-phong"}, {"albedo", JsonColour(m.albedo)}, {"exponent", JsonNumber(m.exponent)}};
  }
  void operator()(const CookTorrance& m) const {
    Metal(m.f0, std::sqrt(m.alpha));
    Extension(kBrdfExtension) = {
        {"model", "cook-torrance"}, {"f0", JsonColour(m.f0)}, {"alpha", JsonNumber(m.alpha)}};
  }
  void operator()(const OrenNayar& m) const {
    Matte(m.albedo);
    Extension(kBrdfExtension) = {
        {"model", "oren-nayar"}, {"albedo", JsonColour(m.albedo)}, {"sigma", JsonNumber(m.sigma)}};
  }
  void operator()(const AshikhminShirley& m) const {
    Coated(m.diffuse, RoughnessOfPower(m.exponent));
    Extension(kBrdfExtension) = {{"model", "ashikhmin-shirley"},
                                 {"diffuse", JsonColour(m.diffuse)},
                                 {"specular", JsonColour(m.specular)},
                                 {"exponent", JsonNumber(m.exponent)}};
  }
  void operator()(const Plastic& m) const {
    Coated(m.albedo(), m.roughness());
    if (m.ior() != 1.5f) Extension("KHR_materials_ior") = {{"ior", JsonNumber(m.ior())}};
    Extension(kBrdfExtension) = {{"model", "plastic"},
                                 {"albedo", JsonColour(m.albedo())},
                                 {"ior", JsonNumber(m.ior())},
                                 {"roughness", JsonNumber(m.roughness())}};
  }
  void operator()(const Measured& m) const {
    const Rgb colour = m.data->NormalAlbedo().min(1.0f);
    // Wider than this its peak is hardly one.
    if (m.data->Width() > 0.7) {
      Matte(colour);
    } else {
      Metal(colour, float(std::sqrt(m.data->Width())));
    }
    Extension(kBrdfExtension) = MeasuredJson(*m.data, writer);
  }
  void operator()(const MetallicRoughness& m) const {
    Pbr() = {{"baseColorFactor", BaseColour(m.base_color)},
             {"metallicFactor", JsonNumber(m.metallic)},
             {"roughnessFactor", JsonNumber(m.roughness)}};
    if (m.ior != 1.5f) Extension("KHR_materials_ior") = {{"ior", JsonNumber(m.ior)}};
    if (m.has_specular) {
      Extension("KHR_materials_specular") = {{"specularFactor", JsonNumber(m.specular)},
                                             {"specularColorFactor", JsonColour(m.specular_color)}};
    }
    if (m.diffuse_transmission != 0 || (m.diffuse_transmission_color != 1).any()) {
      Extension("KHR_materials_diffuse_transmission") = {
          {"diffuseTransmissionFactor", JsonNumber(m.diffuse_transmission)},
          {"diffuseTransmissionColorFactor", JsonColour(m.diffuse_transmission_color)}};
    }
    if (m.transmission != 0) {
      Extension("KHR_materials_transmission") = {{"transmissionFactor", JsonNumber(m.transmission)}};
    }
    if (m.thickness != 0 || (m.attenuation_color != 1).any() || std::isfinite(m.attenuation_distance)) {
      json& volume = Extension("KHR_materials_volume");
      volume = {{"thicknessFactor", JsonNumber(m.thickness)},
                {"attenuationColor", JsonColour(m.attenuation_color)}};
      // Without the entry it is infinite, which JSON cannot say.
      if (std::isfinite(m.attenuation_distance)) {
        volume["attenuationDistance"] = JsonNumber(m.attenuation_distance);
      }
    }
  }

 private:
  void Metal(const Rgb& colour, float roughness) const {
    Pbr() = {{"baseColorFactor", BaseColour(colour)},
             {"metallicFactor", 1.0},
             {"roughnessFactor", JsonNumber(roughness)}};
  }
  void Coated(const Rgb& colour, float roughness) const {
    Metal(colour, roughness);
    Pbr()["metallicFactor"] = 0.0;
  }
  void Matte(const Rgb& colour) const {
    Coated(colour, 1);
    Extension("KHR_materials_specular") = {{"specularFactor", 0.0}};
  }
  // Blinn's rule of thumb alpha^2 = 2 / (n + 2), and roughness = sqrt(alpha).
  static float RoughnessOfPower(float exponent) { return std::pow(2.0f / (exponent + 2.0f), 0.25f); }
};

void CollectExtensions(const json& value, std::set<std::string>* names) {
  if (value.is_object()) {
    const auto found = value.find("extensions");
    if (found != value.end() && found->is_object()) {
      for (const auto& [name, unused] : found->items()) names->insert(name);
    }
  }
  if (value.is_structured()) {
    for (const json& child : value) CollectExtensions(child, names);
  }
}

}  // namespace

json JsonNumber(float value) {
  if (!std::isfinite(value)) return nullptr;
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits - 1, value).ptr;
  *end = 0;
  // Read as a double and then rounded to float, as JSON readers do: twice rounded, so better looked at.
  const double number = std::strtod(digits, nullptr);
  return static_cast<float>(number) == value ? number : double(value);
}

json GltfMaterial(const Material& material, GlbWriter* writer) {
  json out = json::object();
  if (!material.name.empty()) out["name"] = material.name;
  std::visit(WriteReflectance{&out, writer}, material.reflectance);
  if (material.emits()) {
    // emissiveFactor ends at 1. A power of two as the strength keeps the product exact.
    int exponent = 0;
    const float peak = material.emission.maxCoeff();
    if (peak > 1) {
      const float fraction = std::frexp(peak, &exponent);
      if (fraction == 0.5f) --exponent;
    }
    const float strength = std::ldexp(1.0f, exponent);
    out["emissiveFactor"] = JsonColour(material.emission / strength);
    if (exponent > 0) {
      out["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", JsonNumber(strength)}};
    }
  }
  if (material.double_sided) out["doubleSided"] = true;
  return out;
}

json GltfCamera(const Camera& camera, float near_plane) {
  json out = {{"type", "perspective"},
              {"perspective",
               {{"yfov", JsonNumber(camera.fov_y)},
                {"aspectRatio", JsonNumber(camera.aspect)},
                {"znear", JsonNumber(near_plane)}}}};
  if (!camera.name.empty()) out["name"] = camera.name;
  return out;
}

json GltfCameraNode(const Camera& camera, int index) {
  json out = {{"camera", index}};
  if (!camera.name.empty()) out["name"] = camera.name;
  json matrix = json::array();
  for (const Vec3* column : {&camera.right, &camera.up, &camera.back, &camera.eye}) {
    for (int i = 0; i < 3; ++i) matrix.push_back(JsonNumber((*column)[i]));
    matrix.push_back(column == &camera.eye ? 1.0 : 0.0);
  }
  out["matrix"] = matrix;
  return out;
}

json ExtensionsUsed(const json& document) {
  std::set<std::string> names;
  CollectExtensions(document, &names);
  return names;
}

}  // namespace lobe
