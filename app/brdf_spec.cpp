#include "app/brdf_spec.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <functional>

#include "app/commands.h"
#include "app/values.h"
#include "scene/gltf_scene.h"
#include "scene/input_error.h"
#include "scene/measured_file.h"
#include "solver/solution.h"

namespace lobe {
namespace {

/// Numbers have one value in all three channels.
struct Parameter {
  const char* name;
  bool colour;
  float min, max;
  Rgb value;  ///< the default, then what was given
};

Parameter Number(const char* name, float min, float max, float missing) {
  return {name, false, min, max, Rgb::Constant(missing)};
}
Parameter Colour(const char* name, float missing) { return {name, true, 0, 1, Rgb::Constant(missing)}; }

/// Values in the order of the model's parameters.
struct Values {
  const std::vector<Parameter>& parameters;
  Rgb colour(size_t i) const { return parameters[i].value; }
  float number(size_t i) const { return parameters[i].value[0]; }
};

struct Model {
  const char* name;
  std::vector<Parameter> parameters;
  std::function<Reflectance(const Values&)> make;
};

// Ranges as of LOBE_materials_brdf (docs/format.md#materials).
const std::vector<Model>& Models() {
  static const std::vector<Model> models = {
      {"ggx",
       {Number("roughness", kMirrorRoughness, 1, 0.4f), Colour("f0", 1)},
       [](const Values& v) {
         MetallicRoughness m;
         m.roughness = v.number(0);
         m.base_color = v.colour(1);
         return m;
       }},
      {"gltf",
       {Colour("base", 0.5f), Number("metallic", 0, 1, 0), Number("roughness", 0, 1, 0.4f),
        Number("ior", 1, 4, 1.5f)},
       [](const Values& v) {
         MetallicRoughness m;
         m.base_color = v.colour(0);
         m.metallic = v.number(1);
         m.roughness = v.number(2);
         m.ior = v.number(3);
         return m;
       }},
      {"lambert", {Colour("albedo", 0.5f)}, [](const Values& v) { return Lambert{v.colour(0)}; }},
      {"phong",
       {Colour("albedo", 0.5f), Number("exponent", 0, 1e6f, 20)},
       [](const Values& v) {
         return Phong{v.colour(0), v.number(1)};
       }},
      {"blinn-phong",
       {Colour("albedo", 0.5f), Number("exponent", 0, 1e6f, 20)},
       [](const Values& v) {
         return BlinnPhong{v.colour(0), v.number(1)};
       }},
      {"ward",
       {Colour("albedo", 0.5f), Number("alpha", 1e-3f, 1, 0.2f)},
       [](const Values& v) {
         return Ward{v.colour(0), v.number(1)};
       }},
      {"cook-torrance",
       {Colour("f0", 0.5f), Number("alpha", 1e-3f, 1, 0.2f)},
       [](const Values& v) {
         return CookTorrance{v.colour(0), v.number(1)};
       }},
      {"oren-nayar",
       {Colour("albedo", 0.5f), Number("sigma", 0, 1.5707964f, 0.35f)},
       [](const Values& v) {
         return OrenNayar{v.colour(0), v.number(1)};
       }},
      {"ashikhmin-shirley",
       {Colour("diffuse", 0.5f), Colour("specular", 0.05f), Number("exponent", 0, 1e6f, 100)},
       [](const Values& v) {
         return AshikhminShirley{v.colour(0), v.colour(1), v.number(2)};
       }},
      {"plastic",
       {Colour("albedo", 0.5f), Number("ior", 1, 4, 1.5f), Number("roughness", kMirrorRoughness, 1, 0.3f)},
       [](const Values& v) { return Plastic(v.colour(0), v.number(1), v.number(2)); }},
  };
  return models;
}

std::string Shown(float value) {
  char buffer[32];
  return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

/// "a, b and c".
std::string Listed(const std::vector<std::string>& words) {
  std::string text;
  for (size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  }
  return text;
}

[[noreturn]] void Refuse(const std::string& spec, const std::string& sentence) {
  throw UsageError("SPEC '" + spec + "': " + sentence);
}

/// Parts of `text` between separators, empty ones too.
std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

void SetValue(const std::string& spec, const std::string& text, Parameter* parameter) {
  const auto refuse = [&] {
    const std::string range = " from " + Shown(parameter->min) + " to " + Shown(parameter->max);
    Refuse(spec, std::string(parameter->name) + " '" + text + "' is not " +
                     (parameter->colour ? "a colour: one number" + range + ", or three as R/G/B"
                                        : "a number" + range));
  };
  const auto numbers = Split(text, '/');
  if (numbers.size() != 1 && (numbers.size() != 3 || !parameter->colour)) refuse();
  for (int c = 0; c < 3; ++c) {
    const std::string& number = numbers[numbers.size() == 1 ? 0 : size_t(c)];
    float value = 0;
    const char* end = number.data() + number.size();
    const auto [next, error] = std::from_chars(number.data(), end, value);
    if (error != std::errc() || next != end || !(value >= parameter->min) || !(value <= parameter->max)) {
      refuse();
    }
    parameter->value[c] = value;
  }
}

NamedReflectance OfModel(const std::string& spec) {
  const size_t colon = spec.find(':');
  const std::string name = spec.substr(0, colon);
  const auto& models = Models();
  const auto model =
      std::find_if(models.begin(), models.end(), [&](const Model& m) { return name == m.name; });
  if (model == models.end()) {
    std::vector<std::string> names;
    for (const Model& m : models) names.push_back(m.name);
    Refuse(spec, "'" + name + "' is no model; " + Listed(names) +
                     " are (or a material as FILE.glb#NAME, or measured data in a .binary or .csv file)");
  }
  std::vector<Parameter> parameters = model->parameters;
  if (colon != std::string::npos) {
    for (const std::string& assignment : Split(spec.substr(colon + 1), ',')) {
      const size_t equals = assignment.find('=');
      const std::string key = assignment.substr(0, equals);
      const auto parameter = std::find_if(parameters.begin(), parameters.end(),
                                          [&](const Parameter& p) { return key == p.name; });
      if (parameter == parameters.end()) {
        std::vector<std::string> names;
        for (const Parameter& p : parameters) names.push_back(p.name);
        Refuse(spec, std::string(model->name) + " has no parameter '" + key + "'; it has " + Listed(names));
      }
      if (equals == std::string::npos)
        Refuse(spec, "'" + key + "' has no value; " + key + "=VALUE is expected");
      SetValue(spec, assignment.substr(equals + 1), &*parameter);
    }
  }
  return {spec, model->make(Values{parameters}), {}};
}

NamedReflectance OfScene(const std::string& spec, const std::string& path, const std::string* name) {
  const Scene scene = IsSolution(path) ? ReadSolution(path).scene : ReadGltfScene(path);
  std::vector<std::string> names;
  for (const Material& m : scene.materials) {
    if (name && m.name == *name) return {spec, m.reflectance, scene.warnings};
    names.push_back("'" + m.name + "'");
  }
  const std::string has = names.empty() ? "it has none" : "it has " + Listed(names);
  if (!name) Refuse(spec, "which material? FILE#MATERIAL is expected; " + has);
  throw InputError(path + ": no material is named '" + *name + "'; " + has);
}

bool IsScene(const std::string& path) { return Extension(path) == ".glb" || Extension(path) == ".gltf"; }

}  // namespace

NamedReflectance ParseBrdfSpec(const std::string& spec) {
  if (IsScene(spec)) return OfScene(spec, spec, nullptr);
  // File names may hold a '#' too: the first one that ends a scene's name counts.
  for (size_t hash = spec.find('#'); hash != std::string::npos; hash = spec.find('#', hash + 1)) {
    const std::string path = spec.substr(0, hash), name = spec.substr(hash + 1);
    if (IsScene(path)) return OfScene(spec, path, &name);
  }
  const std::string extension = Extension(spec);
  if (extension == ".binary" || extension == ".csv" || extension == ".txt") {
    return {spec, ReadMeasuredFile(spec), {}};
  }
  return OfModel(spec);
}

std::string BrdfModelsHelp() {
  std::string text;
  for (const Model& model : Models()) {
    std::string line = "  " + std::string(model.name);
    line.resize(std::max<size_t>(line.size() + 1, 21), ' ');
    for (size_t i = 0; i < model.parameters.size(); ++i) {
      const Parameter& p = model.parameters[i];
      line += (i > 0 ? ", " : "") + std::string(p.name) + " " + Shown(p.min) + ".." + Shown(p.max) + " [" +
              Shown(p.value[0]) + "]";
    }
    text += line + "\n";
  }
  return text;
}

}  // namespace lobe
