// Writes solution.glb: docs/format.md says what and why. Reading: solution_reader.cpp.
#include <span>
#include <string>
#include <vector>

#include "scene/glb_writer.h"
#include "solver/solution.h"
#include "solver/solution_document.h"

namespace lobe {
namespace {

using nlohmann::json;
using Target = GlbWriter::Target;

class SolutionWriter {
 public:
  explicit SolutionWriter(const Solution& solution) : s_(solution) {}

  void Write(const std::string& path) {
    // An upper bound: nodes' position, normal, colour and irradiance; elements with their bisections; faces.
    glb_.Reserve(44 * s_.mesh.node_count() + 3 * s_.total.bytes() + 16 * s_.mesh.element_count() +
                 64 * s_.mesh.patches.size() + 28 * s_.scene.faces.size() + 24 * s_.scene.positions.size());
    const OwnMembers own{.add_to_patch = [&](uint32_t p, const PatchTrees& trees,
                                             json* extension) { AddToPatch(p, trees, extension); },
                         .add_to_record = {}};
    FillSolutionDocument(s_, own, &glb_);
    glb_.Write(path);
  }

 private:
  void AddToPatch(uint32_t p, const PatchTrees& trees, json* extension) {
    const Mesh::Patch& patch = s_.mesh.patches[p];
    (*extension)["faces"] = glb_.AddUints(trees.faces, Target::kNone);
    (*extension)["bisections"] = glb_.AddBytes(trees.bisections);
    if (!s_.received.empty()) {
      const auto received =
          std::span(s_.received).subspan(patch.node_begin, patch.node_end - patch.node_begin);
      (*extension)["received"] = glb_.AddFloats(received, "SCALAR", Target::kNone);
    }
    for (const bool gloss : {false, true}) {
      AddPart(s_.total, p, gloss, gloss ? "gloss" : "base", extension);
      AddPart(s_.direct, p, gloss, gloss ? "directGloss" : "directBase", extension);
      AddPart(s_.unshot, p, gloss, gloss ? "unshotGloss" : "unshotBase", extension);
    }
  }

  void AddPart(const NodeLobes& lobes, uint32_t patch, bool gloss, const char* name, json* extension) {
    const std::vector<float> values = PartValues(lobes, patch, gloss);
    if (!values.empty()) (*extension)[name] = glb_.AddFloats(values, "SCALAR", Target::kNone);
  }

  const Solution& s_;
  GlbWriter glb_;
};

}  // namespace

void WriteSolution(const Solution& solution, const std::string& path) {
  SolutionWriter(solution).Write(path);
}

}  // namespace lobe
