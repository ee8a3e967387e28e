#include "scene/repeated_faces.h"

#include <algorithm>
#include <utility>

namespace lobe {

namespace {

struct Entry {
  std::array<std::array<float, 3>, 3> position;  // sorted
  std::array<uint8_t, 3> corner;                 // of the face, in that order
  bool odd;                                      // as a permutation
  uint32_t face;
};

Entry MakeEntry(const Scene& scene, uint32_t face) {
  Entry e{{}, {0, 1, 2}, false, face};
  const std::array<Vec3, 3> p = scene.Corners(scene.faces[face]);
  // Adding zero turns -0 into 0.
  for (int k = 0; k < 3; ++k) e.position[k] = {p[k].x() + 0.0f, p[k].y() + 0.0f, p[k].z() + 0.0f};
  for (const int k : {0, 1, 0}) {
    if (e.position[k + 1] < e.position[k]) {
      std::swap(e.position[k], e.position[k + 1]);
      std::swap(e.corner[k], e.corner[k + 1]);
      e.odd = !e.odd;
    }
  }
  return e;
}

}  // namespace

RepeatedFaces FindRepeatedFaces(const Scene& scene) {
  const uint32_t count = static_cast<uint32_t>(scene.faces.size());
  std::vector<Entry> entries;
  entries.reserve(count);
  for (uint32_t f = 0; f < count; ++f) entries.push_back(MakeEntry(scene, f));
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.position != b.position ? a.position < b.position : a.face < b.face;
  });
  RepeatedFaces repeated;
  std::vector<bool> dropped(count);
  size_t first = 0;
  for (size_t i = 1; i < entries.size(); ++i) {
    if (entries[i].position != entries[first].position) {
      first = i;
      continue;
    }
    dropped[entries[i].face] = true;
    repeated.twins.resize(count);
    RepeatedFaces::Twin& twin = repeated.twins[entries[first].face];
    if (entries[i].odd == entries[first].odd || twin.face != kNone) continue;
    const auto transmits = [&](const Entry& e) {
      const Material& material = scene.material(scene.faces[e.face]);
      return material.transmits() || material.pane();
    };
    if (transmits(entries[first]) && transmits(entries[i])) continue;
    twin.face = entries[i].face;
    for (int k = 0; k < 3; ++k) twin.corner[entries[i].corner[k]] = entries[first].corner[k];
  }
  for (uint32_t f = 0; f < count; ++f) {
    if (!dropped[f]) repeated.kept.push_back(f);
  }
  return repeated;
}

}  // namespace lobe
