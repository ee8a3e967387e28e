// Writes solution.glb: docs/format.md says what and why. Reading: solution_reader.cpp.
#include <algorithm>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene/glb_writer.h"
#include "scene/gltf_output.h"
#include "solver/baked_colours.h"
#include "solver/solution.h"
#include "solver/solution_json.h"

namespace lobe {
namespace {

using nlohmann::json;
using Target = GlbWriter::Target;

std::span<const float> Floats(std::span<const Vec3> v) {
  static_assert(sizeof(Vec3) == 3 * sizeof(float));
  return {v.empty() ? nullptr : v.front().data(), 3 * v.size()};
}

/// The bisection trees of one patch as the file tells them.
struct PatchTrees {
  std::vector<uint32_t> faces;      ///< the roots'
  std::vector<uint8_t> bisections;  ///< preorder: 0 leaf, 1 + apex split
  std::vector<uint32_t> triangles;  ///< leaves in that order, corners counted from the patch's first node
};

uint32_t FirstElement(const Mesh& mesh, uint32_t cell) {
  while (mesh.cells[cell].child != kNone) cell = mesh.cells[cell].child;
  return mesh.cells[cell].element;
}

void AppendTree(const Mesh& mesh, uint32_t root, uint32_t node_begin, PatchTrees* trees) {
  std::vector<uint32_t> open = {root};
  while (!open.empty()) {
    const Mesh::Cell& cell = mesh.cells[open.back()];
    open.pop_back();
    if (cell.child == kNone) {
      trees->bisections.push_back(0);
      for (const uint32_t node : mesh.elements[cell.element]) trees->triangles.push_back(node - node_begin);
    } else {
      trees->bisections.push_back(uint8_t(1 + cell.apex));
      open.push_back(cell.child + 1);
      open.push_back(cell.child);
    }
  }
}

std::vector<PatchTrees> TreesByPatch(const Mesh& mesh) {
  struct Root {
    uint32_t face, cell, element;
  };
  std::vector<std::vector<Root>> roots(mesh.patches.size());
  for (size_t i = 0; i < mesh.roots.size(); ++i) {
    if (mesh.roots[i] == kNone) continue;
    const uint32_t element = FirstElement(mesh, mesh.roots[i]);
    roots[mesh.element_patch[element]].push_back({uint32_t(i / 2), mesh.roots[i], element});
  }
  std::vector<PatchTrees> out(mesh.patches.size());
  for (size_t p = 0; p < mesh.patches.size(); ++p) {
    // In the elements' own order, so that reading numbers them as they were.
    std::sort(roots[p].begin(), roots[p].end(),
              [](const Root& a, const Root& b) { return a.element < b.element; });
    const Mesh::Patch& patch = mesh.patches[p];
    for (const Root& root : roots[p]) {
      out[p].faces.push_back(root.face);
      AppendTree(mesh, root.cell, patch.node_begin, &out[p]);
    }
    if (out[p].triangles.size() != 3 * size_t(patch.element_end - patch.element_begin)) {
      throw std::logic_error("the bisection trees of a patch do not cover its elements");
    }
  }
  return out;
}

/// One part (base or gloss) of a patch's lobes: node after node, each channel after channel.
std::vector<float> PartValues(const NodeLobes& lobes, uint32_t patch, bool gloss) {
  const PartDegrees& degrees = lobes.patch_degrees(patch);
  const std::span<const float> all = lobes.patch_values(patch);
  const size_t stride = size_t(3) * degrees.count();
  const size_t begin = gloss ? size_t(3) * degrees.base_count() : 0;
  const size_t length = size_t(3) * (gloss ? degrees.gloss_count() : degrees.base_count());
  std::vector<float> out;
  if (length == 0) return out;
  out.reserve(all.size() / stride * length);
  for (size_t at = begin; at < all.size(); at += stride) {
    out.insert(out.end(), all.begin() + at, all.begin() + at + length);
  }
  return out;
}

class SolutionWriter {
 public:
  explicit SolutionWriter(const Solution& solution) : s_(solution), colours_(BakeColours(solution)) {}

  void Write(const std::string& path) {
    // An upper bound: nodes' position, normal, colour and irradiance; elements with their bisections; faces.
    glb_.Reserve(44 * s_.mesh.node_count() + 3 * s_.total.bytes() + 16 * s_.mesh.element_count() +
                 64 * s_.mesh.patches.size() + 28 * s_.scene.faces.size() + 24 * s_.scene.positions.size());
    WriteMaterials();
    json scene_nodes = json::array();
    WriteMeshes(&scene_nodes);
    WriteCameras(&scene_nodes);
    json scene = json::object();
    if (!scene_nodes.empty()) scene["nodes"] = scene_nodes;  // glTF has no empty lists
    Document()["scenes"] = json::array({scene});
    Document()["scene"] = 0;
    Document()["extensions"][kExtensionName] = Record();
    Document()["extensionsUsed"] = ExtensionsUsed(Document());
    glb_.Write(path);
  }

 private:
  json& Document() { return glb_.document; }
  uint32_t FallbackMaterial() const { return uint32_t(s_.scene.materials.size()); }

  void WriteMaterials() {
    json& materials = Document()["materials"] = json::array();
    for (const Material& material : s_.scene.materials) materials.push_back(GltfMaterial(material, &glb_));
    materials.push_back({{"name", "baked light"},
                         {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}},
                         {"extensions", {{"KHR_materials_unlit", json::object()}}}});
  }

  /// A mesh and a node for every surface, a primitive for every patch.
  void WriteMeshes(json* scene_nodes) {
    const std::vector<PatchTrees> trees = TreesByPatch(s_.mesh);
    std::map<uint32_t, size_t> mesh_of_surface;
    for (uint32_t p = 0; p < s_.mesh.patches.size(); ++p) {
      const uint32_t surface = s_.mesh.patches[p].surface;
      const auto [found, added] = mesh_of_surface.try_emplace(surface, mesh_of_surface.size());
      if (added) {
        const std::string& name = s_.scene.surface_names[surface];
        scene_nodes->push_back(Document()["nodes"].size());
        Document()["nodes"].push_back({{"name", name}, {"mesh", found->second}});
        Document()["meshes"].push_back({{"name", name}, {"primitives", json::array()}});
      }
      Document()["meshes"][found->second]["primitives"].push_back(Primitive(p, trees[p]));
    }
  }

  json Primitive(uint32_t p, const PatchTrees& trees) {
    const Mesh::Patch& patch = s_.mesh.patches[p];
    const size_t count = patch.node_end - patch.node_begin;
    const auto vectors = [&](const std::vector<Vec3>& v) {
      return Floats(std::span(v).subspan(patch.node_begin, count));
    };
    const auto colours = std::span(colours_.rgb).subspan(3 * size_t(patch.node_begin), 3 * count);
    json primitive;
    primitive["attributes"]["POSITION"] =
        glb_.AddFloats(vectors(s_.mesh.node_position), "VEC3", Target::kVertices, /*bounds=*/true);
    primitive["attributes"]["NORMAL"] =
        glb_.AddFloats(vectors(s_.mesh.node_normal), "VEC3", Target::kVertices);
    primitive["attributes"]["COLOR_0"] = glb_.AddFloats(colours, "VEC3", Target::kVertices);
    primitive["indices"] = glb_.AddUints(trees.triangles, Target::kIndices);
    primitive["material"] = FallbackMaterial();

    json& own = primitive["extensions"][kExtensionName];
    own["patch"] = p;
    own["material"] = patch.material;
    own["surface"] = patch.surface;
    own["side"] = Name(patch.side);
    if (patch.planar) own["planar"] = true;
    own["faces"] = glb_.AddUints(trees.faces, Target::kNone);
    own["bisections"] = glb_.AddBytes(trees.bisections);
    const std::span<const uint8_t> hidden = std::span(s_.hidden).subspan(patch.node_begin, count);
    if (std::find_if(hidden.begin(), hidden.end(), [](uint8_t h) { return h != 0; }) != hidden.end()) {
      own["hidden"] = glb_.AddBytes(hidden);
    }
    if (!s_.received.empty()) {
      own["received"] =
          glb_.AddFloats(std::span(s_.received).subspan(patch.node_begin, count), "SCALAR", Target::kNone);
    }
    const PartDegrees& degrees = s_.total.patch_degrees(p);
    if (degrees.base >= 0) own["lMaxBase"] = degrees.base;
    if (degrees.gloss >= 0) own["lMaxGloss"] = degrees.gloss;
    for (const bool gloss : {false, true}) {
      AddPart(s_.total, p, gloss, gloss ? "gloss" : "base", &own);
      AddPart(s_.direct, p, gloss, gloss ? "directGloss" : "directBase", &own);
      AddPart(s_.unshot, p, gloss, gloss ? "unshotGloss" : "unshotBase", &own);
    }
    return primitive;
  }

  void AddPart(const NodeLobes& lobes, uint32_t patch, bool gloss, const char* name, json* extension) {
    const std::vector<float> values = PartValues(lobes, patch, gloss);
    if (!values.empty()) (*extension)[name] = glb_.AddFloats(values, "SCALAR", Target::kNone);
  }

  void WriteCameras(json* scene_nodes) {
    const Eigen::AlignedBox3f bounds = s_.scene.Bounds();
    const float size = bounds.isEmpty() ? 1.0f : bounds.diagonal().norm();
    for (const Camera& camera : s_.scene.cameras) {
      const int index = int(Document()["cameras"].size());
      // A thousandth of the scene: near enough to hide nothing, far enough for a depth buffer.
      Document()["cameras"].push_back(GltfCamera(camera, size > 0 ? 1e-3f * size : 1e-3f));
      scene_nodes->push_back(Document()["nodes"].size());
      Document()["nodes"].push_back(GltfCameraNode(camera, index));
    }
  }

  /// The extension on the document: input geometry, and everything without geometry.
  json Record() {
    json record = SolutionRecord(s_);
    record["version"] = kFormatVersion;
    record["basis"] = kBasisName;
    record["frame"] = kFrameName;
    record["exposureScale"] = JsonNumber(colours_.exposure_scale);
    record["surfaceNames"] = s_.scene.surface_names;
    std::vector<uint32_t> indices, material, surface;
    std::vector<uint8_t> contact;
    for (const Face& face : s_.scene.faces) {
      indices.insert(indices.end(), face.vertex.begin(), face.vertex.end());
      material.push_back(face.material);
      surface.push_back(face.surface);
      contact.push_back(static_cast<uint8_t>(face.contact));
    }
    record["faces"] = {{"positions", glb_.AddFloats(Floats(s_.scene.positions), "VEC3", Target::kNone)},
                       {"normals", glb_.AddFloats(Floats(s_.scene.normals), "VEC3", Target::kNone)},
                       {"indices", glb_.AddUints(indices, Target::kNone)},
                       {"material", glb_.AddUints(material, Target::kNone)},
                       {"surface", glb_.AddUints(surface, Target::kNone)}};
    if (std::any_of(contact.begin(), contact.end(), [](uint8_t bits) { return bits != 0; })) {
      record["faces"]["contact"] = glb_.AddBytes(contact);
    }
    return record;
  }

  const Solution& s_;
  const BakedColours colours_;
  GlbWriter glb_;
};

}  // namespace

void WriteSolution(const Solution& solution, const std::string& path) {
  SolutionWriter(solution).Write(path);
}

}  // namespace lobe
