// Reads solution.glb (docs/format.md). Trusts nothing: every index, count and degree is checked before use.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scene/gltf_nodes.h"
#include "scene/gltf_scene.h"
#include "scene/input_error.h"
#include "scene/sample_points.h"
#include "sh/hemisphere_basis.h"
#include "solver/solution.h"
#include "solver/solution_json.h"

namespace lobe {
namespace {

using nlohmann::json;

constexpr size_t kMaxDegree = HemisphereBasis<float>::kMaxDegree;

std::vector<Vec3> Vectors(const std::vector<float>& values) {
  std::vector<Vec3> out(values.size() / 3);
  for (size_t i = 0; i < out.size(); ++i) out[i] = Vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
  return out;
}

bool AllFinite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

class SolutionReader {
 public:
  explicit SolutionReader(const std::string& path)
      : file_(path), document_(Document(file_)), record_(document_.Extension(kExtensionName)) {}

  Solution Read() {
    if (!document_.Object("extensions").Has(kExtensionName)) {
      throw InputError(file_.path() + " is a scene, not a solution: run `lobe solve` first");
    }
    CheckVersion();
    ReadSolutionRecord(record_, &s_);
    ReadMaterials();
    ReadFaces();
    ReadCamerasExactly();
    ReadPatches();
    ReadLobes();
    return std::move(s_);
  }

 private:
  struct PatchJson {
    GltfJson primitive, own;  ///< the glTF primitive and its extension
  };

  void CheckVersion() {
    const size_t version = record_.RequiredWhole("version");
    if (version != size_t(kFormatVersion)) {
      throw InputError(file_.path() + ": " + kExtensionName + " version " + std::to_string(version) +
                       " found, " + std::to_string(kFormatVersion) + " expected");
    }
    if (record_.Bool("viewing", false)) {
      throw InputError(file_.path() +
                       " was made by `lobe export` for viewing and lacks what rendering needs; use the file "
                       "that `lobe solve` wrote");
    }
    if (record_.String("basis") != kBasisName)
      record_.FailValue("basis", std::string("'") + kBasisName + "'");
    if (record_.String("frame") != kFrameName)
      record_.FailValue("frame", std::string("'") + kFrameName + "'");
  }

  /// The first ones of the file; the fallback's follow.
  void ReadMaterials() {
    std::vector<std::string> warnings;  // were told when the scene was solved
    s_.scene.materials = lobe::ReadMaterials(file_, &warnings);
    const size_t count = s_.material_kinds.size();
    if (count == 0 || count > s_.scene.materials.size()) {
      record_.FailValue("materials", "1 to " + std::to_string(s_.scene.materials.size()) +
                                         " entries, the file's materials");
    }
    s_.scene.materials.resize(count);
  }

  void ReadFaces() {
    Scene& scene = s_.scene;
    scene.path = file_.path();
    for (size_t i = 0; i < record_.Count("surfaceNames"); ++i) {
      const json& name = record_.value()["surfaceNames"][i];
      if (!name.is_string()) record_.FailValue("surfaceNames", "an array of strings");
      scene.surface_names.push_back(name.get<std::string>());
    }
    const GltfJson faces = record_.Object("faces");
    const std::vector<float> positions = Floats(faces, "positions", 3);
    const std::vector<float> normals = Floats(faces, "normals", 3);
    const std::vector<uint32_t> indices = Uints(faces, "indices");
    const std::vector<uint32_t> material = Uints(faces, "material");
    const std::vector<uint32_t> surface = Uints(faces, "surface");
    if (!AllFinite(positions)) faces.FailValue("positions", "finite coordinates");
    if (!AllFinite(normals)) faces.FailValue("normals", "finite coordinates");
    ExpectCount(faces, "normals", normals.size() / 3, positions.size() / 3);
    // A face and a side must fit an index (Mesh::roots).
    if (indices.size() % 3 != 0 || indices.size() / 3 > kNone / 2) {
      faces.FailValue("indices", "an accessor of three indices a face");
    }
    const size_t count = indices.size() / 3;
    ExpectCount(faces, "material", material.size(), count);
    ExpectCount(faces, "surface", surface.size(), count);
    ExpectBelow(faces, "indices", indices, positions.size() / 3);
    ExpectBelow(faces, "material", material, scene.materials.size());
    ExpectBelow(faces, "surface", surface, scene.surface_names.size());
    std::vector<uint32_t> contact(count);
    if (faces.Has("contact")) contact = Uints(faces, "contact");
    ExpectCount(faces, "contact", contact.size(), count);
    ExpectBelow(faces, "contact", contact, 8);
    scene.positions = Vectors(positions);
    scene.normals = Vectors(normals);
    for (size_t f = 0; f < count; ++f) {
      scene.faces.push_back(
          {{indices[3 * f], indices[3 * f + 1], indices[3 * f + 2]}, material[f], surface[f], contact[f]});
    }
  }

  /// ReadCameras normalises the axes, which may move a last bit; as we wrote them, they are normal already.
  void ReadCamerasExactly() {
    s_.scene.cameras = ReadCameras(file_);
    size_t next = 0;
    for (size_t i = 0; i < document_.Count("nodes") && next < s_.scene.cameras.size(); ++i) {
      const GltfJson node = document_.Entry("nodes", i, "node");
      double m[16];
      if (!node.Has("camera") || !node.Numbers("matrix", 16, m)) continue;
      const auto column = [&](int k) {
        return Vec3(float(m[4 * k]), float(m[4 * k + 1]), float(m[4 * k + 2]));
      };
      Camera& camera = s_.scene.cameras[next++];
      Camera exact = camera;
      exact.right = column(0);
      exact.up = column(1);
      exact.back = column(2);
      exact.eye = column(3);
      constexpr float kRounding = 1e-6f;
      const bool same = exact.eye == camera.eye && (exact.right - camera.right).norm() < kRounding &&
                        (exact.up - camera.up).norm() < kRounding &&
                        (exact.back - camera.back).norm() < kRounding;
      if (same) camera = exact;
    }
  }

  /// All primitives that carry the extension, by patch number.
  std::vector<PatchJson> FindPatches() {
    std::vector<PatchJson> found;
    for (size_t m = 0; m < document_.Count("meshes"); ++m) {
      const GltfJson mesh = document_.Entry("meshes", m, "mesh");
      for (size_t i = 0; i < mesh.Count("primitives"); ++i) {
        const GltfJson primitive = mesh.Entry("primitives", i, "primitive");
        if (!primitive.Object("extensions").Has(kExtensionName)) continue;
        found.push_back({primitive, primitive.Extension(kExtensionName)});
      }
    }
    std::vector<PatchJson> patches = found;
    std::vector<bool> seen(found.size(), false);
    for (const PatchJson& patch : found) {
      const size_t p = patch.own.RequiredWhole("patch");
      if (p >= found.size())
        patch.own.FailValue("patch", "less than the " + std::to_string(found.size()) + " patches");
      if (seen[p]) patch.own.FailValue("patch", "a number that no other primitive has");
      seen[p] = true;
      patches[p] = patch;
    }
    return patches;
  }

  void ReadPatches() {
    patches_ = FindPatches();
    s_.mesh.roots.assign(2 * s_.scene.faces.size(), kNone);
    for (uint32_t p = 0; p < patches_.size(); ++p) {
      ReadGeometry(p);
      ReadTrees(p);
      ReadHidden(p);
      ReadReceived(p);
    }
    PlaceSamplePoints(&s_.mesh, s_.options.mesh.border_inset);
  }

  void ReadGeometry(uint32_t p) {
    const auto& [primitive, own] = patches_[p];
    Mesh& mesh = s_.mesh;
    Mesh::Patch patch;
    patch.material = uint32_t(RequiredIndex(own, "material", s_.scene.materials.size()));
    patch.surface = uint32_t(RequiredIndex(own, "surface", s_.scene.surface_names.size()));
    const std::string side = own.String("side");
    if (side != Name(Side::kFront) && side != Name(Side::kBack)) own.FailValue("side", "'front' or 'back'");
    patch.side = side == Name(Side::kFront) ? Side::kFront : Side::kBack;

    const GltfJson attributes = primitive.Object("attributes");
    const std::vector<float> position = Floats(attributes, "POSITION", 3),
                             normal = Floats(attributes, "NORMAL", 3);
    if (!AllFinite(position)) attributes.FailValue("POSITION", "finite coordinates");
    if (!AllFinite(normal)) attributes.FailValue("NORMAL", "finite coordinates");
    const size_t count = position.size() / 3;
    ExpectCount(attributes, "NORMAL", normal.size() / 3, count);
    const std::vector<uint32_t> corners = Uints(primitive, "indices");
    if (corners.size() % 3 != 0) primitive.FailValue("indices", "an accessor of three indices a triangle");
    ExpectBelow(primitive, "indices", corners, count);
    if (mesh.node_count() + count >= kNone || mesh.element_count() + corners.size() / 3 >= kNone) {
      document_.Fail("there are more than 2^32 nodes or elements");
    }

    patch.node_begin = uint32_t(mesh.node_count());
    for (const Vec3& v : Vectors(position)) mesh.node_position.push_back(v);
    for (const Vec3& v : Vectors(normal)) mesh.node_normal.push_back(v);
    patch.node_end = uint32_t(mesh.node_count());
    mesh.node_patch.resize(patch.node_end, p);
    patch.planar = own.Bool("planar", false);

    patch.element_begin = uint32_t(mesh.element_count());
    for (size_t i = 0; i < corners.size(); i += 3) {
      mesh.elements.push_back({patch.node_begin + corners[i], patch.node_begin + corners[i + 1],
                               patch.node_begin + corners[i + 2]});
    }
    patch.element_end = uint32_t(mesh.element_count());
    mesh.element_patch.resize(patch.element_end, p);
    mesh.patches.push_back(patch);
  }

  void ReadTrees(uint32_t p) {
    const GltfJson& own = patches_[p].own;
    const Mesh::Patch& patch = s_.mesh.patches[p];
    const std::vector<uint32_t> faces = Uints(own, "faces"), codes = Uints(own, "bisections");
    ExpectBelow(own, "faces", faces, s_.scene.faces.size());
    std::vector<Mesh::Cell>& cells = s_.mesh.cells;
    if (cells.size() + codes.size() >= kNone) document_.Fail("there are more than 2^32 cells");

    size_t next_code = 0;
    uint32_t next_element = patch.element_begin;
    for (const uint32_t f : faces) {
      const Face& face = s_.scene.faces[f];
      if (face.material != patch.material || face.surface != patch.surface) {
        own.FailValue("faces", "only faces of its own material and surface, but face " + std::to_string(f) +
                                   " has material " + std::to_string(face.material) + " and surface " +
                                   std::to_string(face.surface));
      }
      uint32_t& root = s_.mesh.roots[2 * size_t(f) + size_t(patch.side)];
      if (root != kNone)
        own.FailValue("faces", "each face once, but face " + std::to_string(f) + " comes again");
      root = uint32_t(cells.size());
      cells.emplace_back();
      std::vector<uint32_t> open = {root};
      while (!open.empty()) {
        const uint32_t cell = open.back();
        open.pop_back();
        if (next_code == codes.size())
          own.FailValue("bisections", "a code for every cell, but it ends within a tree");
        const uint32_t code = codes[next_code++];
        if (code == 0) {
          if (next_element == patch.element_end) {
            own.FailValue("bisections", "a leaf for each of its " +
                                            std::to_string(patch.element_end - patch.element_begin) +
                                            " triangles, but there are more");
          }
          cells[cell].element = next_element++;
        } else if (code <= 3) {
          cells[cell].apex = uint8_t(code - 1);
          cells[cell].child = uint32_t(cells.size());
          open.push_back(cells[cell].child + 1);
          open.push_back(cells[cell].child);
          cells.resize(cells.size() + 2);
        } else {
          own.FailValue("bisections", "codes 0 to 3, but code " + std::to_string(next_code - 1) + " is " +
                                          std::to_string(code));
        }
      }
    }
    if (next_code != codes.size()) {
      own.FailValue("bisections", std::to_string(next_code) + " codes for its trees, but there are " +
                                      std::to_string(codes.size()));
    }
    if (next_element != patch.element_end) {
      own.FailValue("bisections",
                    "a leaf for each of its " + std::to_string(patch.element_end - patch.element_begin) +
                        " triangles, but there are " + std::to_string(next_element - patch.element_begin));
    }
  }

  void ReadHidden(uint32_t p) {
    const GltfJson& own = patches_[p].own;
    const Mesh::Patch& patch = s_.mesh.patches[p];
    s_.hidden.resize(patch.node_end, 0);
    if (!own.Has("hidden")) return;
    const std::vector<uint32_t> hidden = Uints(own, "hidden");
    ExpectCount(own, "hidden", hidden.size(), patch.node_end - patch.node_begin);
    for (size_t i = 0; i < hidden.size(); ++i) s_.hidden[patch.node_begin + i] = hidden[i] != 0;
  }

  // All patches have it, or none.
  void ReadReceived(uint32_t p) {
    const GltfJson& own = patches_[p].own;
    const Mesh::Patch& patch = s_.mesh.patches[p];
    if (p > 0 && own.Has("received") == s_.received.empty()) {
      own.FailValue("received", "an accessor in every patch, or in none");
    }
    if (!own.Has("received")) return;
    const std::vector<float> received = Floats(own, "received", 1);
    ExpectCount(own, "received", received.size(), patch.node_end - patch.node_begin);
    s_.received.insert(s_.received.end(), received.begin(), received.end());
  }

  void ReadLobes() {
    std::vector<PartDegrees> degrees;
    for (const auto& [primitive, own] : patches_) {
      PartDegrees d{-1, -1};
      if (own.Has("lMaxBase")) d.base = int(own.RequiredWhole("lMaxBase", kMaxDegree));
      if (own.Has("lMaxGloss")) d.gloss = int(own.RequiredWhole("lMaxGloss", kMaxDegree));
      degrees.push_back(d);
    }
    // All lengths before any memory.
    for (uint32_t p = 0; p < patches_.size(); ++p) {
      for (const char* name : {"base", "directBase", "unshotBase"})
        ExpectPart(p, name, degrees[p].base_count());
      for (const char* name : {"gloss", "directGloss", "unshotGloss"})
        ExpectPart(p, name, degrees[p].gloss_count());
    }
    s_.total = s_.direct = s_.unshot = NodeLobes(s_.mesh, degrees);
    for (uint32_t p = 0; p < patches_.size(); ++p) {
      ReadField(p, "base", "gloss", &s_.total);
      ReadField(p, "directBase", "directGloss", &s_.direct);
      ReadField(p, "unshotBase", "unshotGloss", &s_.unshot);
    }
  }

  static bool MayBeAbsent(const std::string& name) { return name.starts_with("unshot"); }

  void ExpectPart(uint32_t p, const char* name, int count) {
    const GltfJson& own = patches_[p].own;
    if (count == 0) {
      if (own.Has(name)) own.FailValue(name, "nothing, as there is no lMax for it");
      return;
    }
    if (!own.Has(name) && MayBeAbsent(name)) return;
    const Mesh::Patch& patch = s_.mesh.patches[p];
    const size_t wanted = size_t(3) * count * (patch.node_end - patch.node_begin);
    ExpectCount(own, name, size_t(file_.AccessorCount(RequiredAccessor(own, name))), wanted);
  }

  void ReadField(uint32_t p, const char* base_name, const char* gloss_name, NodeLobes* lobes) {
    const GltfJson& own = patches_[p].own;
    const PartDegrees& d = lobes->patch_degrees(p);
    std::vector<float> base, gloss;
    if (own.Has(base_name)) base = Floats(own, base_name, 1);
    if (own.Has(gloss_name)) gloss = Floats(own, gloss_name, 1);
    const size_t base_stride = size_t(3) * d.base_count(), gloss_stride = size_t(3) * d.gloss_count();
    float* to = lobes->patch_values(p).data();
    const Mesh::Patch& patch = s_.mesh.patches[p];
    for (size_t i = 0; i < patch.node_end - patch.node_begin; ++i) {
      if (!base.empty()) std::copy_n(base.data() + i * base_stride, base_stride, to);
      to += base_stride;
      if (!gloss.empty()) std::copy_n(gloss.data() + i * gloss_stride, gloss_stride, to);
      to += gloss_stride;
    }
  }

  int RequiredIndex(const GltfJson& owner, const char* name, size_t count) const {
    const int index = owner.Index(name, count);
    if (index < 0) owner.FailValue(name, "an index");
    return index;
  }
  int RequiredAccessor(const GltfJson& owner, const char* name) const {
    return RequiredIndex(owner, name, document_.Count("accessors"));
  }
  std::vector<float> Floats(const GltfJson& owner, const char* name, int components) const {
    return file_.ReadFloats(RequiredAccessor(owner, name), components, owner.element() + ": " + name);
  }
  std::vector<uint32_t> Uints(const GltfJson& owner, const char* name) const {
    return file_.ReadIndices(RequiredAccessor(owner, name), owner.element() + ": " + name);
  }
  void ExpectCount(const GltfJson& owner, const char* name, size_t found, size_t wanted) const {
    if (found == wanted) return;
    owner.FailValue(
        name, "an accessor of " + std::to_string(wanted) + " elements, but it has " + std::to_string(found));
  }
  void ExpectBelow(const GltfJson& owner, const char* name, const std::vector<uint32_t>& values,
                   size_t limit) const {
    for (size_t i = 0; i < values.size(); ++i) {
      if (values[i] < limit) continue;
      owner.FailValue(name, "indices below " + std::to_string(limit) + ", but element " + std::to_string(i) +
                                " is " + std::to_string(values[i]));
    }
  }

  GltfFile file_;
  GltfJson document_, record_;
  std::vector<PatchJson> patches_;
  Solution s_;
};

}  // namespace

Solution ReadSolution(const std::string& path) { return SolutionReader(path).Read(); }

bool IsSolution(const std::string& path) {
  const GltfFile file(path);
  return Document(file).Object("extensions").Has(kExtensionName);
}

}  // namespace lobe
