#include "solver/memory.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "scene/input_error.h"
#include "solver/links.h"
#include "solver/node_lobes.h"
#include "solver/received.h"

namespace lobe {
namespace {

// Bytes. Those of our own structures are counted, the others measured (docs/validation.md#memory).
constexpr double kProgram = 20e6;  // an almost empty scene
constexpr double kPerFace = 250;   // with Embree's tree, which is the most of it
constexpr double kPerVertex = 24;
constexpr double kPerNode = 52 + 8 + 1 + 4 + 24 + sizeof(Received);  // Mesh; area, hidden, list; of a step
constexpr double kPerElement = 16 + 2 * sizeof(Mesh::Cell);  // a tree has about twice as many cells as leaves
constexpr double kLocatorPerElement = 2 * 20 + 28;           // while links are traced
constexpr double kCuttingPerElement = 200;                   // OpenMesh's halfedges and the queue of edges
constexpr double kFields = 5;              // total, direct, unshot, gained, and shot or gained before
constexpr double kFieldPerNode = 16 + 12;  // LinkField; colours of the file
constexpr double kFilePerNode = 36;
constexpr double kFilePerElement = 14;
constexpr double kFileFields = 3;
// A link that meets a mirror: its hops, and their copy while the blocks are joined.
constexpr double kPerChain = 2 * 2 * sizeof(Links::Hop);
// Glass makes several ways of one: 2.7 hops measured, and one for what it absorbs (GlassLinksTest).
constexpr double kPerGlassChain = 2 * 5 * sizeof(Links::Hop);

double NodeLobeBytes(const MaterialLobes& material) {
  const PartDegrees d{material.base.l_max, material.gloss.l_max};
  return 3.0 * sizeof(float) * d.count();
}

}  // namespace

double MeshCounts::all_nodes() const {
  double sum = 0;
  for (const double n : nodes) sum += n;
  return sum;
}

MeshCounts MeshCounts::Times(double factor) const {
  MeshCounts out = *this;
  for (double& n : out.nodes) n *= factor;
  out.elements *= factor;
  return out;
}

MeshCounts CountsOf(const Mesh& mesh, size_t materials) {
  MeshCounts out;
  out.nodes.assign(materials, 0.0);
  for (const auto& p : mesh.patches) out.nodes[p.material] += p.node_end - p.node_begin;
  out.elements = double(mesh.element_count());
  return out;
}

MeshCounts ExpectCounts(const Scene& scene, const std::vector<bool>& sides, float max_edge) {
  MeshCounts out;
  out.nodes.assign(scene.materials.size(), 0.0);
  for (size_t f = 0; f < scene.faces.size(); ++f) {
    const auto p = scene.Corners(scene.faces[f]);
    double longest = 0;
    for (int i = 0; i < 3; ++i) longest = std::max<double>(longest, (p[i] - p[(i + 1) % 3]).norm());
    // The shape that bisection tends to is a right isosceles triangle; max_edge is its longest side.
    const double area = scene.Area(scene.faces[f]);
    const double elements = std::max({1.0, longest / max_edge, 4 * area / (double(max_edge) * max_edge)});
    const int count = int(sides[2 * f]) + int(sides[2 * f + 1]);
    out.elements += count * elements;
    out.nodes[scene.faces[f].material] += count * elements / 2;
  }
  return out;
}

double MemoryNeed::peak() const {
  const double solving = lobes + links;
  // Cutting a refined mesh happens beside the lobes that emission has filled so far: two of five fields.
  return scene + mesh + std::max(solving + file, cutting + 0.4 * lobes);
}

MemoryNeed EstimateMemory(const Scene& scene, const MeshCounts& counts,
                          const std::vector<MaterialLobes>& materials, const SolveOptions& options) {
  MemoryNeed need;
  const double nodes = counts.all_nodes();
  need.scene = kProgram + kPerFace * double(scene.faces.size()) + kPerVertex * double(scene.positions.size());
  need.mesh = kPerNode * nodes + kPerElement * counts.elements;
  need.cutting = kCuttingPerElement * counts.elements;

  const bool by_links = options.transport != Transport::kShooting;
  double mirror_nodes = 0;
  const int links = by_links ? options.links : Links::kProbes;
  double link_count = 0;
  for (size_t m = 0; m < counts.nodes.size(); ++m) {
    need.lobes += NodeLobeBytes(materials[m]) * counts.nodes[m];
    link_count += Links::PatternOf(materials[m], links).count() * counts.nodes[m];
    if (materials[m].mirror()) mirror_nodes += counts.nodes[m];
  }
  need.file = kFileFields * need.lobes + kFilePerNode * nodes + kFilePerElement * counts.elements;
  need.lobes = kFields * need.lobes + kFieldPerNode * nodes;
  // A link meets mirrors about as often as mirrors have nodes.
  const double chains = by_links && nodes > 0 ? link_count * mirror_nodes / nodes : 0.0;
  need.links = 4 * link_count + kPerChain * chains;
  // Glass has few nodes or none; links meet it as often as its share of the area says.
  if (std::any_of(materials.begin(), materials.end(), [](const MaterialLobes& m) { return m.glass(); })) {
    double glass_area = 0, area = 0;
    for (const Face& face : scene.faces) {
      area += scene.Area(face);
      if (materials[face.material].glass()) glass_area += scene.Area(face);
    }
    if (glass_area > 0) need.links += kPerGlassChain * link_count * glass_area / area;
  }
  // The locator is gone before a file is written.
  need.links += std::max(0.0, kLocatorPerElement * counts.elements - need.file - need.lobes / kFields);
  return need;
}

double NodesThatFit(double bytes, const Scene& scene, const MeshCounts& counts,
                    const std::vector<MaterialLobes>& materials, const SolveOptions& options) {
  constexpr double kMany = 1e6;  // to see what one costs
  const double now = EstimateMemory(scene, counts, materials, options).peak();
  double dearest = 0;
  for (size_t m = 0; m < counts.nodes.size(); ++m) {
    if (counts.nodes[m] == 0) continue;
    MeshCounts more = counts;
    more.nodes[m] += kMany;
    more.elements += 2 * kMany;
    dearest = std::max(dearest, (EstimateMemory(scene, more, materials, options).peak() - now) / kMany);
  }
  return counts.all_nodes() + (dearest > 0 ? std::max(0.0, bytes - now) / dearest : 0.0);
}

void RequireMemory(double bytes, const Scene& scene, const std::vector<bool>& sides, const MeshCounts& counts,
                   const std::vector<MaterialLobes>& materials, const SolveOptions& options) {
  const double need = EstimateMemory(scene, counts, materials, options).peak();
  if (!(bytes > 0) || need <= bytes) return;
  std::ostringstream sentence;
  sentence.precision(2);
  sentence << scene.path << ": edges of at most " << options.mesh.max_edge << " m would make about "
           << counts.elements << " elements, which need about " << MemoryText(need)
           << " of memory, expected at most " << MemoryText(bytes) << "; choose longer edges";
  // The first of a series of edges that fits whichever way bisection goes.
  const float extent = scene.Bounds().diagonal().norm();
  for (double edge = options.mesh.max_edge * 1.05; edge < extent; edge *= 1.05) {
    char rounded[32];
    std::snprintf(rounded, sizeof rounded, "%.2g", edge);
    const double candidate = std::stod(rounded);
    if (candidate < edge) continue;
    const MeshCounts expected = ExpectCounts(scene, sides, float(candidate)).Times(2.1);
    if (EstimateMemory(scene, expected, materials, options).peak() > bytes) continue;
    sentence << ", " << rounded << " m would fit";
    break;
  }
  throw InputError(sentence.str());
}

std::string MemoryText(double bytes) {
  const char* units[] = {"kB", "MB", "GB", "TB"};
  int unit = 0;
  for (bytes /= 1000; bytes >= 1000 && unit < 3; ++unit) bytes /= 1000;
  char text[32];
  std::snprintf(text, sizeof text, bytes < 9.95 ? "%.1f %s" : "%.0f %s", bytes, units[unit]);
  return text;
}

}  // namespace lobe
