// docs/format.md says what and why.
#include "solver/solution_document.h"

#include <algorithm>
#include <map>
#include <span>
#include <string>

#include "scene/gltf_output.h"
#include "solver/baked_colours.h"
#include "solver/solution_json.h"

namespace lobe {
namespace {

using nlohmann::json;
using Target = GlbWriter::Target;

class DocumentFiller {
 public:
  DocumentFiller(const Solution& solution, const OwnMembers& own, GlbWriter* glb)
      : s_(solution), own_(own), colours_(BakeColours(solution)), glb_(*glb) {}

  void Fill() {
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

    json& extension = primitive["extensions"][kExtensionName];
    extension["patch"] = p;
    extension["material"] = patch.material;
    extension["surface"] = patch.surface;
    extension["side"] = Name(patch.side);
    if (patch.planar) extension["planar"] = true;
    const std::span<const uint8_t> hidden = std::span(s_.hidden).subspan(patch.node_begin, count);
    if (std::find_if(hidden.begin(), hidden.end(), [](uint8_t h) { return h != 0; }) != hidden.end()) {
      extension["hidden"] = glb_.AddBytes(hidden);
    }
    const PartDegrees& degrees = s_.total.patch_degrees(p);
    if (degrees.base >= 0) extension["lMaxBase"] = degrees.base;
    if (degrees.gloss >= 0) extension["lMaxGloss"] = degrees.gloss;
    own_.add_to_patch(p, trees, &extension);
    return primitive;
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

  json Record() {
    json record = SolutionRecord(s_);
    record["version"] = kFormatVersion;
    record["basis"] = kBasisName;
    record["frame"] = kFrameName;
    record["exposureScale"] = JsonNumber(colours_.exposure_scale);
    record["surfaceNames"] = s_.scene.surface_names;
    record["faces"] = Faces();
    if (own_.add_to_record) own_.add_to_record(&record);
    return record;
  }

  /// The input geometry: what rays hit, and all there is of glass.
  json Faces() {
    std::vector<uint32_t> indices, material, surface;
    std::vector<uint8_t> contact;
    for (const Face& face : s_.scene.faces) {
      indices.insert(indices.end(), face.vertex.begin(), face.vertex.end());
      material.push_back(face.material);
      surface.push_back(face.surface);
      contact.push_back(static_cast<uint8_t>(face.contact));
    }
    json faces = {{"positions", glb_.AddFloats(Floats(s_.scene.positions), "VEC3", Target::kNone)},
                  {"normals", glb_.AddFloats(Floats(s_.scene.normals), "VEC3", Target::kNone)},
                  {"indices", glb_.AddUints(indices, Target::kNone)},
                  {"material", glb_.AddUints(material, Target::kNone)},
                  {"surface", glb_.AddUints(surface, Target::kNone)}};
    if (std::any_of(contact.begin(), contact.end(), [](uint8_t bits) { return bits != 0; })) {
      faces["contact"] = glb_.AddBytes(contact);
    }
    return faces;
  }

  const Solution& s_;
  const OwnMembers& own_;
  const BakedColours colours_;
  GlbWriter& glb_;
};

}  // namespace

void FillSolutionDocument(const Solution& solution, const OwnMembers& own, GlbWriter* glb) {
  DocumentFiller(solution, own, glb).Fill();
}

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

std::span<const float> Floats(std::span<const Vec3> v) {
  static_assert(sizeof(Vec3) == 3 * sizeof(float));
  return {v.empty() ? nullptr : v.front().data(), 3 * v.size()};
}

}  // namespace lobe
