#include "scene/gltf_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "scene/coincident_faces.h"
#include "scene/contacts.h"
#include "scene/gltf_nodes.h"
#include "scene/input_error.h"
#include "scene/precision.h"

namespace lobe {

namespace {

constexpr int kTriangles = 4, kStrip = 5, kFan = 6;  // glTF 2.0 section 5.24.4, mesh.primitive.mode

using Triangle = std::array<uint32_t, 3>;

/// A mesh primitive as in the file, in its own space.
struct Primitive {
  std::vector<float> positions;  // x, y, z
  std::vector<float> normals;    // empty: flat
  std::vector<Triangle> triangles;
  int material = -1;
};

std::vector<Triangle> Assemble(const std::vector<uint32_t>& v, int mode) {
  std::vector<Triangle> triangles;
  if (mode == kTriangles) {
    for (size_t i = 0; i + 3 <= v.size(); i += 3) triangles.push_back({v[i], v[i + 1], v[i + 2]});
  } else {
    // Section 3.7.2.1: p_i = (v_i, v_i+1+i%2, v_i+2-i%2) of strips and (v_i+1, v_i+2, v_0) of fans.
    for (size_t i = 0; i + 3 <= v.size(); ++i) {
      const size_t odd = i % 2;
      triangles.push_back(mode == kStrip ? Triangle{v[i], v[i + 1 + odd], v[i + 2 - odd]}
                                         : Triangle{v[i + 1], v[i + 2], v[0]});
    }
  }
  return triangles;
}

class SceneReader {
 public:
  explicit SceneReader(const GltfFile& file) : file_(file), document_(Document(file)) {
    scene_.path = file.path();
  }

  Scene Read() {
    CheckExtensions();
    scene_.materials = ReadMaterials(file_, &scene_.warnings);
    material_count_ = scene_.materials.size();
    for (const GltfNode& node : ReadNodes(file_, &scene_.warnings)) {
      if (node.mesh >= 0) AddMesh(node);
      if (node.camera >= 0) WarnOfCamera(node.camera);
    }
    scene_.cameras = ReadCameras(file_);
    if (scene_.faces.empty()) document_.Fail("the scene has no triangles");
    for (const auto& [mesh, counts] : dropped_) WarnOfDropped(mesh, counts);
    ResolveCoincidentFaces(&scene_);
    WarnOfLostPrecision(&scene_, ContactOptions{}.distance);
    return std::move(scene_);
  }

 private:
  struct Dropped {
    size_t zero_area = 0, bad_normals = 0;
    size_t corners = 0, turned_normals = 0;  // of the mesh, however often it is placed
  };

  void Warn(const std::string& sentence) { scene_.warnings.push_back(sentence); }

  void CheckExtensions() {
    static const std::set<std::string> kRead = {
        "KHR_materials_emissive_strength", "KHR_materials_specular", "KHR_materials_ior",
        "KHR_mesh_quantization",           "LOBE_materials_brdf",    "LOBE_directional_radiance"};
    static const std::set<std::string> kChangeGeometry = {
        "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression",
        "EXT_mesh_gpu_instancing"};
    for (size_t i = 0; i < document_.Count("extensionsRequired"); ++i) {
      const nlohmann::json& entry = document_.value()["extensionsRequired"][i];
      const std::string name = entry.is_string() ? entry.get<std::string>() : Shown(entry);
      if (kRead.contains(name)) continue;
      if (kChangeGeometry.contains(name)) {
        document_.Fail("it requires the extension " + name + ", which is not read; export it without");
      }
      Warn("the file requires the extension " + name + ", which is not read");
    }
    if (const size_t n = document_.Extension("KHR_lights_punctual").Count("lights")) {
      Warn("KHR_lights_punctual is not read; " + std::to_string(n) + (n == 1 ? " light is" : " lights are") +
           " left out, and only emissive surfaces give light");
    }
    if (const size_t n = document_.Count("animations")) {
      Warn(std::to_string(n) + (n == 1 ? " animation is" : " animations are") +
           " not read; the pose at rest is used");
    }
  }

  void WarnOfCamera(int index) {
    const GltfJson camera = document_.Entry("cameras", index, "camera");
    const std::string type = camera.String("type");
    if (type != "perspective")
      Warn(camera.element() + ": type " + type + " is not read; the camera is left out");
  }

  void WarnOfDropped(int mesh, const Dropped& counts) {
    const std::string name = document_.Entry("meshes", mesh, "mesh").element();
    if (counts.zero_area > 0) {
      Warn(name + ": " + std::to_string(counts.zero_area) + " triangles of no area are left out");
    }
    if (counts.bad_normals > 0) {
      Warn(name + ": " + std::to_string(counts.bad_normals) +
           " corners have a normal that is zero or not finite; the triangle's own is used");
    }
    if (counts.turned_normals > 0) {
      Warn(name + ": the normals of " + std::to_string(counts.turned_normals) + " of " +
           std::to_string(counts.corners) +
           " corners point behind their triangle, against its winding; they are turned to its front: "
           "recalculate them, or turn the triangles");
    }
  }

  /// Reads a primitive; false if it is of a kind that is not read.
  bool ReadPrimitive(const GltfJson& json, Primitive* primitive) {
    const int mode = static_cast<int>(json.Whole("mode", kTriangles, 6));
    if (mode < kTriangles) {
      Warn(json.element() + ": mode " + std::to_string(mode) +
           " (points or lines) is not read; it is left out");
      return false;
    }
    const GltfJson attributes = json.Object("attributes");
    const size_t accessor_count = document_.Count("accessors");
    const int position = attributes.Index("POSITION", accessor_count);
    if (position < 0) {
      Warn(json.element() + ": it has no POSITION; it is left out");
      return false;
    }
    primitive->positions = file_.ReadFloats(position, 3, json.element() + ": POSITION");
    const size_t vertex_count = primitive->positions.size() / 3;
    for (size_t i = 0; i < primitive->positions.size(); ++i) {
      if (!std::isfinite(primitive->positions[i])) {
        json.Fail("POSITION (accessor " + std::to_string(position) + "): vertex " + std::to_string(i / 3) +
                  " is not finite");
      }
    }
    const int normal = attributes.Index("NORMAL", accessor_count);
    if (normal >= 0) {
      primitive->normals = file_.ReadFloats(normal, 3, json.element() + ": NORMAL");
      if (primitive->normals.size() != primitive->positions.size()) {
        json.Fail("NORMAL (accessor " + std::to_string(normal) + ") has " +
                  std::to_string(primitive->normals.size() / 3) + " elements, expected " +
                  std::to_string(vertex_count) + " as POSITION has");
      }
    }
    std::vector<uint32_t> indices;
    const int accessor = json.Index("indices", accessor_count);
    if (accessor >= 0) {
      indices = file_.ReadIndices(accessor, json.element() + ": indices");
      for (size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] >= vertex_count) {
          json.Fail("indices (accessor " + std::to_string(accessor) + "): index " + std::to_string(i) +
                    " is " + std::to_string(indices[i]) + ", expected below the " +
                    std::to_string(vertex_count) + " vertices");
        }
      }
    } else {
      indices.resize(vertex_count);
      for (size_t i = 0; i < vertex_count; ++i) indices[i] = static_cast<uint32_t>(i);
    }
    if (mode == kTriangles && indices.size() % 3 != 0) {
      Warn(json.element() + ": " + std::to_string(indices.size()) +
           " corners are not a multiple of 3; the last ones are left out");
    }
    primitive->triangles = Assemble(indices, mode);
    primitive->material = json.Index("material", material_count_);
    if (json.Count("targets") > 0)
      Warn(json.element() + ": morph targets are not read; the base shape is used");
    if (attributes.Has("COLOR_0"))
      Warn(json.element() + ": COLOR_0 is not read; the material's colour is used");
    return true;
  }

  /// As Scene::CornerNormal will turn them.
  void CountTurnedNormals(const Primitive& primitive, int mesh) {
    if (primitive.normals.empty()) return;
    const auto at = [](const std::vector<float>& xyz, uint32_t i) {
      return Eigen::Map<const Vec3>(&xyz[3 * i]);
    };
    size_t turned = 0;
    for (const Triangle& t : primitive.triangles) {
      const Vec3 p = at(primitive.positions, t[0]);
      const Vec3 front = (at(primitive.positions, t[1]) - p).cross(at(primitive.positions, t[2]) - p);
      for (const uint32_t v : t) {
        const auto normal = at(primitive.normals, v);
        turned += normal.dot(front) < -Scene::kGrazing * normal.norm() * front.norm();
      }
    }
    dropped_[mesh].turned_normals += turned;
    dropped_[mesh].corners += 3 * primitive.triangles.size();
  }

  /// Reads each mesh once, however often it is placed.
  const std::vector<Primitive>& ReadMesh(int mesh) {
    const auto [found, is_new] = meshes_.try_emplace(mesh);
    if (is_new) {
      const GltfJson json = document_.Entry("meshes", mesh, "mesh");
      for (size_t i = 0; i < json.Count("primitives"); ++i) {
        Primitive primitive;
        if (ReadPrimitive(json.Entry("primitives", i, "primitive"), &primitive)) {
          CountTurnedNormals(primitive, mesh);
          found->second.push_back(std::move(primitive));
        }
      }
    }
    return found->second;
  }

  void AddMesh(const GltfNode& node) {
    for (const Primitive& primitive : ReadMesh(node.mesh)) {
      const uint32_t surface = static_cast<uint32_t>(scene_.surface_names.size());
      scene_.surface_names.push_back(node.name);
      AddPrimitive(node, primitive, surface);
    }
  }

  void AddPrimitive(const GltfNode& node, const Primitive& primitive, uint32_t surface) {
    const size_t vertex_count = primitive.positions.size() / 3;
    // An index must fit 32 bits for vertices, and one more for both sides of faces.
    constexpr size_t kMost = size_t{1} << 31;
    if (scene_.positions.size() + vertex_count + 3 * primitive.triangles.size() > kMost ||
        scene_.faces.size() + primitive.triangles.size() > kMost / 2) {
      document_.Fail("with '" + node.name + "' the scene has more than 2^30 triangles");
    }
    const Eigen::Matrix3d linear = node.to_world.linear();
    const bool mirrors = linear.determinant() < 0;
    // Normals go by the inverse transpose: the matrix of cofactors, but for a factor of the determinant's
    // sign.
    Eigen::Matrix3d cofactors;
    for (int i = 0; i < 3; ++i) {
      cofactors.col(i) = linear.col((i + 1) % 3).cross(linear.col((i + 2) % 3)) * (mirrors ? -1 : 1);
    }
    const auto place = [&](const std::vector<float>& xyz, size_t i) {
      return Eigen::Map<const Vec3>(&xyz[3 * i]).cast<double>().eval();
    };
    const uint32_t material = primitive.material >= 0 ? primitive.material : DefaultMaterial();
    const bool flat = primitive.normals.empty();
    Dropped dropped;

    const uint32_t first = static_cast<uint32_t>(scene_.positions.size());
    std::vector<Vec3> world(vertex_count);
    for (size_t i = 0; i < vertex_count; ++i) {
      world[i] = (node.to_world * place(primitive.positions, i)).cast<float>();
      if (!world[i].allFinite()) {
        document_.Fail("node '" + node.name + "' moves vertex " + std::to_string(i) + " out of range");
      }
    }
    std::vector<bool> good_normal(vertex_count);
    if (!flat) {
      for (size_t i = 0; i < vertex_count; ++i) {
        const Vec3d n = cofactors * place(primitive.normals, i);
        good_normal[i] = n.allFinite() && n.norm() > 0;
        scene_.positions.push_back(world[i]);
        scene_.normals.push_back(good_normal[i] ? n.normalized().cast<float>().eval() : Vec3(Vec3::UnitY()));
      }
    }
    for (Triangle t : primitive.triangles) {
      if (mirrors) std::swap(t[1], t[2]);
      const Vec3d cross = CrossOrZero({world[t[0]], world[t[1]], world[t[2]]});
      if (cross.isZero(0)) {
        ++dropped.zero_area;
        continue;
      }
      Face face{{first + t[0], first + t[1], first + t[2]}, material, surface};
      for (int k = 0; k < 3; ++k) {
        if (!flat && good_normal[t[k]]) continue;
        // A vertex of this face alone, with its normal.
        face.vertex[k] = static_cast<uint32_t>(scene_.positions.size());
        scene_.positions.push_back(world[t[k]]);
        scene_.normals.push_back(cross.normalized().cast<float>());
        dropped.bad_normals += !flat;
      }
      scene_.faces.push_back(face);
    }
    if (dropped.zero_area + dropped.bad_normals > 0) {
      dropped_[node.mesh].zero_area += dropped.zero_area;
      dropped_[node.mesh].bad_normals += dropped.bad_normals;
    }
  }

  /// Twice the area times the normal; zero if the triangle is so thin that its normal would be made of the
  /// rounding of its coordinates: height below one unit in the last place.
  static Vec3d CrossOrZero(const std::array<Vec3, 3>& p) {
    const Vec3d a = (p[1] - p[0]).cast<double>(), b = (p[2] - p[0]).cast<double>();
    const Vec3d cross = a.cross(b);
    const double longest = std::max({a.norm(), b.norm(), (a - b).norm()});
    float largest = 0;
    for (const Vec3& q : p) largest = std::max(largest, q.cwiseAbs().maxCoeff());
    const double ulp = largest * std::ldexp(1.0, -23);
    return cross.norm() > ulp * longest ? cross : Vec3d::Zero();
  }

  uint32_t DefaultMaterial() {
    if (scene_.materials.size() == material_count_) {
      Material material;  // glTF 2.0 section 3.7.2.1: as an empty material
      material.name = "default";
      scene_.materials.push_back(material);
    }
    return static_cast<uint32_t>(material_count_);
  }

  const GltfFile& file_;
  GltfJson document_;
  Scene scene_;
  size_t material_count_ = 0;  // of the file, without ours
  std::map<int, std::vector<Primitive>> meshes_;
  std::map<int, Dropped> dropped_;
};

}  // namespace

std::vector<Camera> ReadCameras(const GltfFile& file) {
  const GltfJson document = Document(file);
  std::vector<std::string> said_elsewhere;
  std::vector<Camera> cameras;
  std::set<std::string> names;
  for (const GltfNode& node : ReadNodes(file, &said_elsewhere)) {
    if (node.camera < 0) continue;
    const GltfJson json = document.Entry("cameras", node.camera, "camera");
    if (json.String("type") != "perspective") continue;
    const GltfJson perspective = json.Object("perspective");
    if (!perspective.Has("yfov")) perspective.FailValue("yfov", "an angle in radians");
    Camera camera;
    camera.fov_y = static_cast<float>(perspective.Number("yfov", 0));
    if (!(camera.fov_y > 0 && camera.fov_y < static_cast<float>(M_PI))) {
      perspective.FailValue("yfov", "more than 0 and less than pi radians");
    }
    camera.aspect = static_cast<float>(perspective.Number("aspectRatio", 1));
    if (!(camera.aspect > 0)) perspective.FailValue("aspectRatio", "more than 0");

    // Looks along -z of its node, +y up; scale has no meaning for it.
    const Vec3d back = node.to_world.linear().col(2);
    const Vec3d right = Vec3d(node.to_world.linear().col(1)).cross(back);
    if (!(right.norm() > 0)) json.Fail("node '" + node.name + "' scales its axes to nothing");
    camera.eye = node.to_world.translation().cast<float>();
    camera.back = back.normalized().cast<float>();
    camera.right = right.normalized().cast<float>();
    camera.up = back.cross(right).normalized().cast<float>();

    const std::string own_name = json.String("name");
    const std::string name = own_name.empty() ? node.name : own_name;
    camera.name = name;
    for (int copy = 2; !names.insert(camera.name).second; ++copy)
      camera.name = name + "-" + std::to_string(copy);
    cameras.push_back(camera);
  }
  return cameras;
}

Scene ReadGltfScene(const GltfFile& file) { return SceneReader(file).Read(); }

Scene ReadGltfScene(const std::string& path) { return ReadGltfScene(GltfFile(path)); }

}  // namespace lobe
