#include "scene/gltf_brdf.h"

#include <filesystem>
#include <memory>
#include <sstream>

#include "scene/gltf_nodes.h"
#include "scene/measured_file.h"
#include "scene/uri.h"

namespace lobe {
namespace {

using nlohmann::json;

constexpr const char* kHalfDifference = "half-difference";
constexpr const char* kIncidentOutgoing = "incident-outgoing";

// Beyond a million, or below a slope of a thousandth, the peak exceeds 1e5 / sr, and no quadrature of ours
// finds it.
constexpr double kMostExponent = 1e6, kLeastAlpha = 1e-3;

float Parameter(const GltfJson& brdf, const char* key, double missing, double min, double max) {
  return static_cast<float>(brdf.Number(key, missing, min, max));
}

}  // namespace

Reflectance BrdfExtensionReader::Read(const GltfJson& brdf) {
  const std::string model = brdf.String("model");
  const auto colour = [&](const char* key, const Rgb& missing) { return brdf.Color(key, missing, 0, 1); };
  const Rgb albedo = colour("albedo", Rgb::Constant(0.5f));
  if (model == "lambert") return Lambert{albedo};
  if (model == "phong") {
    return Phong{albedo, static_cast<float>(brdf.Number("exponent", Phong{}.exponent, 0))};
  }
  if (model == "ward") return Ward{albedo, Parameter(brdf, "alpha", Ward{}.alpha, kLeastAlpha, 1)};
  if (model == "blinn-phong") {
    return BlinnPhong{albedo, Parameter(brdf, "exponent", BlinnPhong{}.exponent, 0, kMostExponent)};
  }
  if (model == "cook-torrance") {
    return CookTorrance{colour("f0", CookTorrance{}.f0),
                        Parameter(brdf, "alpha", CookTorrance{}.alpha, kLeastAlpha, 1)};
  }
  if (model == "oren-nayar") {
    return OrenNayar{albedo, Parameter(brdf, "sigma", OrenNayar{}.sigma, 0, 1.5707964)};
  }
  if (model == "ashikhmin-shirley") {
    const AshikhminShirley missing;
    return AshikhminShirley{colour("diffuse", missing.diffuse), colour("specular", missing.specular),
                            Parameter(brdf, "exponent", missing.exponent, 0, kMostExponent)};
  }
  if (model == "plastic") {
    // Smoother ones would be mirrors, which only metallic-roughness has; beyond 4 Schlick's curve is none.
    const float ior = Parameter(brdf, "ior", 1.5, 1, 4);
    return Plastic(albedo, ior, Parameter(brdf, "roughness", 0.3, 0.01, 1));
  }
  if (model == "measured") return ReadMeasured(brdf);
  brdf.FailValue("model",
                 "\"lambert\", \"phong\", \"ward\", \"blinn-phong\", \"cook-torrance\", \"oren-nayar\", "
                 "\"ashikhmin-shirley\", \"plastic\" or \"measured\"");
}

Measured BrdfExtensionReader::ReadMeasured(const GltfJson& brdf) {
  if (brdf.Has("uri") == brdf.Has("values")) {
    brdf.Fail(std::string(kBrdfExtension) +
              (brdf.Has("uri") ? " has both uri and values"
                               : " has neither uri nor "
                                 "values") +
              ", expected one of them for measured data");
  }
  const bool by_uri = brdf.Has("uri");
  // All that the data follow from.
  json source;
  for (const char* member : {"uri", "name", "coordinates", "axes", "values"}) {
    source.push_back(brdf.Has(member) ? brdf.value().at(member) : json());
  }
  const std::string key = source.dump(-1, ' ', true, json::error_handler_t::replace);
  auto found = read_.find(key);
  if (found == read_.end()) {
    found = read_.emplace(key, by_uri ? ReadUri(brdf) : ReadAccessors(brdf)).first;
    if (by_uri) WarnOfGain(brdf, *found->second.data);
  }
  return found->second;
}

Measured BrdfExtensionReader::ReadUri(const GltfJson& brdf) {
  const std::string uri = brdf.String("uri");
  if (uri.empty() || uri.starts_with("data:") || uri.find("://") != std::string::npos) {
    brdf.FailValue("uri", "a file beside the scene");
  }
  const std::string path = FileOfUri(file_.path(), uri);
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    brdf.Fail(std::string(kBrdfExtension) + ".uri: its file " + Shown(json(uri)) + " is missing");
  }
  return ReadMeasuredFile(path);
}

Measured BrdfExtensionReader::ReadAccessors(const GltfJson& brdf) {
  const size_t count = Document(file_).Count("accessors");
  const std::string coordinates = brdf.String("coordinates");
  if (coordinates != kHalfDifference && coordinates != kIncidentOutgoing) {
    brdf.FailValue("coordinates", "\"half-difference\" or \"incident-outgoing\"");
  }
  const auto kind = coordinates == kHalfDifference ? MeasuredBrdf::Coordinates::kHalfDifference
                                                   : MeasuredBrdf::Coordinates::kIncidentOutgoing;
  const std::string what = brdf.element() + ": " + kBrdfExtension;
  const std::vector<int> axis_accessors = brdf.Indices("axes", count);
  if (axis_accessors.size() != 3) brdf.FailValue("axes", "three accessors");
  MeasuredBrdf::Axes axes;
  for (int a = 0; a < 3; ++a) axes[a] = file_.ReadFloats(axis_accessors[a], 1, what);
  std::vector<float> values = file_.ReadFloats(brdf.Index("values", count), 1, what);
  const std::string problem = MeasuredBrdf::Problem(kind, axes, values);
  if (!problem.empty()) brdf.Fail(std::string(kBrdfExtension) + ": " + problem);
  return {std::make_shared<const MeasuredBrdf>(brdf.String("name", "data"), kind, std::move(axes),
                                               std::move(values))};
}

// Data often rises at grazing angles, where instruments see little: the solver may then not converge.
void BrdfExtensionReader::WarnOfGain(const GltfJson& brdf, const MeasuredBrdf& data) {
  double worst = 0, worst_cosine = 0;
  for (const double cosine : {1.0, 0.7, 0.5, 0.35, 0.25, 0.15, 0.08}) {
    const double albedo = data.Albedo(cosine).maxCoeff();
    if (albedo > worst) worst = albedo, worst_cosine = cosine;
  }
  if (worst <= 1.005) return;  // as much as the sampling of a white surface may be off
  std::ostringstream sentence;
  sentence.precision(3);
  sentence << brdf.element() << ": its measured data reflects " << worst
           << " of the light that arrives at cosine " << worst_cosine << "; it is taken as it is";
  warnings_->push_back(sentence.str());
}

json MeasuredJson(const MeasuredBrdf& data, GlbWriter* writer) {
  const bool half = data.coordinates() == MeasuredBrdf::Coordinates::kHalfDifference;
  json out = {{"model", "measured"},
              {"name", data.name()},
              {"coordinates", half ? kHalfDifference : kIncidentOutgoing},
              {"digest", data.digest()}};
  if (!writer) return out;
  // A material written before may have brought the data.
  for (const json& material : writer->document.value("materials", json::array())) {
    const json::json_pointer place("/extensions/" + std::string(kBrdfExtension));
    if (!material.contains(place)) continue;
    const json& before = material.at(place);
    if (before.value("digest", "") != data.digest()) continue;
    out["axes"] = before.at("axes");
    out["values"] = before.at("values");
    return out;
  }
  out["axes"] = json::array();
  for (const auto& axis : data.axes()) {
    out["axes"].push_back(writer->AddFloats(axis, "SCALAR", GlbWriter::Target::kNone));
  }
  out["values"] = writer->AddFloats(data.values(), "SCALAR", GlbWriter::Target::kNone);
  return out;
}

}  // namespace lobe
