#include "scene/contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "scene/contact_lines.h"
#include "scene/edge_table.h"
#include "scene/mesh.h"
#include "scene/scene_cutter.h"

namespace lobe {

namespace {

/// Is the back of one of the faces that repeat each other seen, or a front on either side?
bool ShowsBothSides(const Scene& scene, const std::vector<uint32_t>& sheet) {
  const Vec3 normal = scene.GeometricNormal(scene.faces[sheet[0]]);
  return std::any_of(sheet.begin(), sheet.end(), [&](uint32_t f) {
    const Face& face = scene.faces[f];
    return scene.material(face).double_sided || scene.GeometricNormal(face).dot(normal) < 0;
  });
}

std::vector<std::vector<ContactLine>> FindLines(const SceneCutter& cutter) {
  const auto& sheets = cutter.sheets();
  const ContactFinder finder(cutter.scene(), cutter.edges(), cutter.reach());
  std::vector<std::vector<ContactLine>> lines(sheets.size());
  tbb::parallel_for(size_t{0}, sheets.size(), [&](size_t i) {
    lines[i] = finder.LinesOn(sheets[i][0], ShowsBothSides(cutter.scene(), sheets[i]));
  });
  return lines;
}

/// A contact line of one edge that ends at both its ends separates nothing: the surface hangs together
/// around each. With a vertex in its middle there are two there, one a side.
void SplitLonelyEdges(Scene* cut) {
  Scene& scene = *cut;
  using Key = std::array<float, 6>;
  const auto key = [&](const Face& face, int k) {
    const Vec3 &a = scene.positions[face.vertex[k]], &b = scene.positions[face.vertex[(k + 1) % 3]];
    const std::array<float, 3> p = {a.x() + 0.0f, a.y() + 0.0f, a.z() + 0.0f};
    const std::array<float, 3> q = {b.x() + 0.0f, b.y() + 0.0f, b.z() + 0.0f};
    const auto [low, high] = std::minmax(p, q);
    return Key{low[0], low[1], low[2], high[0], high[1], high[2]};
  };
  const auto end = [](const Key& k, int i) { return std::array{k[3 * i], k[3 * i + 1], k[3 * i + 2]}; };
  std::map<Key, bool> lonely;
  std::map<std::array<float, 3>, int> lines_at;
  for (const Face& face : scene.faces) {
    for (int k = 0; k < 3; ++k) {
      if (face.contact >> k & 1) lonely[key(face, k)] = true;
    }
  }
  for (const auto& [edge, unused] : lonely) ++lines_at[end(edge, 0)], ++lines_at[end(edge, 1)];
  bool any = false;
  for (auto& [edge, is_lonely] : lonely) {
    any |= is_lonely = lines_at[end(edge, 0)] == 1 && lines_at[end(edge, 1)] == 1;
  }
  if (!any) return;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
  std::vector<Face> faces;
  for (const Face& whole : scene.faces) {
    std::vector<Face> parts = {whole};
    for (size_t i = 0; i < parts.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const Face face = parts[i];
        const auto found = lonely.find(key(face, k));
        if (found == lonely.end() || !found->second) continue;
        const uint32_t a = face.vertex[k], b = face.vertex[(k + 1) % 3], c = face.vertex[(k + 2) % 3];
        const auto [middle, is_new] = middles.try_emplace(std::minmax(a, b));
        if (is_new) {
          middle->second = static_cast<uint32_t>(scene.positions.size());
          scene.positions.push_back((scene.positions[a] + scene.positions[b]) * 0.5f);
          scene.normals.push_back((scene.normals[a] + scene.normals[b]).normalized());
        }
        const uint32_t m = middle->second;
        // Bits of the edges a-b, b-c, c-a.
        const uint32_t ab = face.contact >> k & 1, bc = face.contact >> (k + 1) % 3 & 1;
        const uint32_t ca = face.contact >> (k + 2) % 3 & 1;
        parts[i].vertex = {a, m, c};
        parts[i].contact = ab | ca << 2;
        Face second = face;
        second.vertex = {m, b, c};
        second.contact = ab | bc << 1;
        parts.push_back(second);
        k = -1;  // its corners are others now
      }
    }
    faces.insert(faces.end(), parts.begin(), parts.end());
  }
  scene.faces = std::move(faces);
}

/// How many faces are no longer whole, and what has become of them.
void CountPieces(const std::vector<uint32_t>& origins, ContactReport* report) {
  for (size_t begin = 0, end = 0; begin < origins.size(); begin = end) {
    while (end < origins.size() && origins[end] == origins[begin]) ++end;
    if (end - begin == 1) continue;
    ++report->faces_cut;
    report->pieces += end - begin;
  }
}

}  // namespace

Scene CutAlongContacts(Scene scene, const ContactOptions& options, ContactReport* report) {
  ContactReport unused;
  if (!report) report = &unused;
  *report = {};
  if (!(options.distance > 0) || scene.faces.empty()) return scene;
  const ContactReach reach = ReachIn(scene, options.distance);
  SceneCutter cutter(std::move(scene), reach, static_cast<size_t>(std::max(options.max_lines, 0)));
  if (!cutter.Cut(FindLines(cutter))) return cutter.Take();
  cutter.Rebuild();
  report->lines = cutter.lines();
  report->crowded_faces = cutter.crowded();
  CountPieces(cutter.origins(), report);
  Scene cut = cutter.Take();
  SplitLonelyEdges(&cut);
  if (report->crowded_faces > 0) {
    cut.warnings.push_back(std::to_string(report->crowded_faces) +
                           (report->crowded_faces == 1 ? " face is" : " faces are") +
                           " touched by too many others: cut only along the longest " +
                           std::to_string(options.max_lines) + " lines of contact");
  }
  return cut;
}

}  // namespace lobe
