#include "solver/viewing_file.h"

#include "scene/gltf_output.h"
#include "solver/half_values.h"
#include "solver/solution_document.h"

namespace lobe {
namespace {

using nlohmann::json;
using Target = GlbWriter::Target;

class ViewingWriter {
 public:
  ViewingWriter(const Solution& solution, ViewingPrecision precision) : s_(solution), precision_(precision) {}

  std::vector<uint8_t> Bytes(const std::string& name) {
    // An upper bound: nodes' position, normal, colour, hidden; elements.
    glb_.Reserve(40 * s_.mesh.node_count() + s_.total.bytes() + 12 * s_.mesh.element_count() +
                 64 * s_.mesh.patches.size());
    const OwnMembers own{[&](uint32_t p, const PatchTrees&, json* extension) {
                           AddPart(p, /*gloss=*/false, "base", extension);
                           AddPart(p, /*gloss=*/true, "gloss", extension);
                         },
                         [&](json* record) {
                           (*record)["viewing"] = true;
                           AddAlbedos(&(*record)["materials"]);
                         }};
    FillSolutionDocument(s_, own, &glb_);
    return glb_.Glb(name);
  }

 private:
  void AddPart(uint32_t patch, bool gloss, const std::string& name, json* extension) {
    const std::vector<float> values = PartValues(s_.total, patch, gloss);
    if (values.empty()) return;
    if (precision_ == ViewingPrecision::kFloat) {
      (*extension)[name] = glb_.AddFloats(values, "SCALAR", Target::kNone);
      return;
    }
    const HalfValues halves = ToHalf(values);
    (*extension)[name] = glb_.AddShorts(halves.bits);
    (*extension)[name + "Scale"] = JsonNumber(halves.scale);
  }

  void AddAlbedos(json* materials) const {
    TableCache cache;
    for (size_t m = 0; m < s_.scene.materials.size(); ++m) {
      const MaterialLobes lobes(s_.scene.materials[m].reflectance, s_.options.lobes, cache);
      const Rgb albedo = lobes.HemisphericalAlbedo();
      (*materials)[m]["albedo"] = {JsonNumber(albedo[0]), JsonNumber(albedo[1]), JsonNumber(albedo[2])};
    }
  }

  const Solution& s_;
  const ViewingPrecision precision_;
  GlbWriter glb_;
};

}  // namespace

std::vector<uint8_t> ViewingFile(const Solution& solution, ViewingPrecision precision,
                                 const std::string& name) {
  return ViewingWriter(solution, precision).Bytes(name);
}

}  // namespace lobe
