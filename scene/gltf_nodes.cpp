#include "scene/gltf_nodes.h"

namespace lobe {

namespace {

Eigen::Affine3d LocalTransform(const GltfJson& node) {
  Eigen::Affine3d local = Eigen::Affine3d::Identity();
  Eigen::Matrix4d matrix;  // column-major, as in glTF
  if (node.Numbers("matrix", 16, matrix.data())) {
    if (!matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1))) {
      node.FailValue("matrix", "0, 0, 0, 1 as its last row");
    }
    local.matrix() = matrix;
    return local;
  }
  Vec3d translation = Vec3d::Zero(), scale = Vec3d::Ones();
  Eigen::Vector4d rotation(0, 0, 0, 1);
  node.Numbers("translation", 3, translation.data());
  node.Numbers("scale", 3, scale.data());
  if (node.Numbers("rotation", 4, rotation.data()) && !(rotation.norm() > 1e-6)) {
    node.FailValue("rotation", "a unit quaternion");
  }
  local.translate(translation);
  local.rotate(Eigen::Quaterniond(rotation).normalized());  // coefficients x, y, z, w in both
  local.scale(scale);
  return local;
}

std::vector<int> Roots(const GltfJson& document, std::vector<std::string>* warnings) {
  const size_t node_count = document.Count("nodes");
  const size_t scene_count = document.Count("scenes");
  const int named = document.Index("scene", scene_count);
  if (scene_count > 1) {
    warnings->push_back("the file holds " + std::to_string(scene_count) + " scenes; only scene " +
                        std::to_string(std::max(named, 0)) + " is read");
  }
  if (scene_count > 0) {
    return document.Entry("scenes", std::max(named, 0), "scene").Indices("nodes", node_count);
  }
  std::vector<bool> is_child(node_count);
  for (size_t i = 0; i < node_count; ++i) {
    for (int child : document.Entry("nodes", i, "node").Indices("children", node_count))
      is_child[child] = true;
  }
  std::vector<int> roots;
  for (size_t i = 0; i < node_count; ++i) {
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

}  // namespace

std::vector<GltfNode> ReadNodes(const GltfFile& file, std::vector<std::string>* warnings) {
  const GltfJson document = Document(file);
  const size_t node_count = document.Count("nodes");
  const size_t mesh_count = document.Count("meshes");
  const size_t camera_count = document.Count("cameras");

  struct Pending {
    int node;
    Eigen::Affine3d parent;
  };
  std::vector<Pending> stack;  // depths of files from outside are not for the call stack
  const auto push = [&stack](const std::vector<int>& nodes, const Eigen::Affine3d& parent) {
    for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) stack.push_back({*i, parent});
  };
  push(Roots(document, warnings), Eigen::Affine3d::Identity());

  std::vector<GltfNode> nodes;
  std::vector<bool> reached(node_count);
  while (!stack.empty()) {
    const Pending pending = stack.back();
    stack.pop_back();
    const GltfJson json = document.Entry("nodes", pending.node, "node");
    if (reached[pending.node]) json.Fail("it is reached twice; nodes must form a tree");
    reached[pending.node] = true;

    GltfNode node;
    node.name = json.String("name");
    if (node.name.empty()) node.name = "node " + std::to_string(pending.node);
    node.to_world = pending.parent * LocalTransform(json);
    if (!node.to_world.matrix().cast<float>().allFinite()) json.Fail("its place in the world is not finite");
    node.mesh = json.Index("mesh", mesh_count);
    node.camera = json.Index("camera", camera_count);
    if (json.Has("skin")) {
      warnings->push_back(json.element() + ": its skin is not read; the mesh is shown undeformed");
    }
    if (json.Object("extensions").Has("EXT_mesh_gpu_instancing")) {
      warnings->push_back(json.element() + ": EXT_mesh_gpu_instancing is not read; one instance is shown");
    }
    push(json.Indices("children", node_count), node.to_world);
    nodes.push_back(std::move(node));
  }
  return nodes;
}

}  // namespace lobe
