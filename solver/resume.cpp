#include "solver/resume.h"

#include <cstring>

#include "scene/gltf_output.h"
#include "scene/input_error.h"
#include "solver/memory.h"

namespace lobe {
namespace {

std::string Text(const PartDegrees& d) { return std::to_string(d.base) + " and " + std::to_string(d.gloss); }

template <typename T>
bool SameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

std::string Counts(const std::string& what, size_t scene, size_t solved) {
  return "the scene has " + std::to_string(scene) + " " + what + ", the solution " + std::to_string(solved);
}

// As a file tells a material, its name aside: whatever is written there matters.
nlohmann::json Told(const Material& material) {
  nlohmann::json json = GltfMaterial(material);
  json.erase("name");
  return json;
}

}  // namespace

void CheckResumable(const Solution& state, const std::vector<PartDegrees>& degrees) {
  const auto fail = [&](const std::string& why) {
    throw InputError(state.scene.path + ": cannot be resumed: " + why);
  };
  const size_t nodes = state.mesh.node_count();
  if (state.options.transport == Transport::kShooting && state.received.size() != nodes) {
    fail("'received' is missing, which shooting needs to go on; solve the scene anew");
  }
  for (uint32_t p = 0; p < degrees.size(); ++p) {
    if (state.total.patch_degrees(p) == degrees[p]) continue;
    fail("patch " + std::to_string(p) + " has lobes of degree " + Text(state.total.patch_degrees(p)) +
         " (base and gloss, -1 for none), expected " + Text(degrees[p]) +
         " from its material; was it solved by another version of Lobe?");
  }
}

void RequireMemoryToContinue(double bytes, const Solution& state,
                             const std::vector<MaterialLobes>& materials) {
  const MeshCounts counts = CountsOf(state.mesh, materials.size());
  const double need = EstimateMemory(state.scene, counts, materials, state.options).peak();
  if (!(bytes > 0) || need <= bytes) return;
  throw InputError(state.scene.path + ": going on needs about " + MemoryText(need) +
                   " of memory, expected at most " + MemoryText(bytes));
}

std::string DifferenceOfScenes(const Scene& scene, const Scene& solved) {
  if (scene.faces.size() != solved.faces.size()) {
    return Counts("triangles", scene.faces.size(), solved.faces.size());
  }
  if (scene.materials.size() != solved.materials.size()) {
    return Counts("materials", scene.materials.size(), solved.materials.size());
  }
  for (size_t m = 0; m < scene.materials.size(); ++m) {
    if (Told(scene.materials[m]) != Told(solved.materials[m])) {
      return "material " + std::to_string(m) + " ('" + scene.materials[m].name + "') is another";
    }
  }
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    const Face &a = scene.faces[f], &b = solved.faces[f];
    if (a.material != b.material || a.surface != b.surface) {
      return "triangle " + std::to_string(f) + " has another material or belongs to another surface";
    }
    for (int k = 0; k < 3; ++k) {
      if (scene.positions[a.vertex[k]] != solved.positions[b.vertex[k]] ||
          scene.normals[a.vertex[k]] != solved.normals[b.vertex[k]]) {
        return "corner " + std::to_string(k) + " of triangle " + std::to_string(f) + " lies elsewhere";
      }
    }
  }
  if (!SameBits(scene.faces, solved.faces)) return "the triangles share their corners otherwise";
  return {};
}

}  // namespace lobe
