#include "scene/body_feet.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "scene/mesh.h"

namespace lobe {

bool BodyFeet::IsFoot(uint32_t f) {
  const Face& face = scene_.faces[f];
  if (node_.empty()) {
    uint32_t node = 0;
    for (size_t s = 0; s < scene_.surface_names.size(); ++s) {
      node += s > 0 && scene_.surface_names[s] != scene_.surface_names[s - 1];
      node_.push_back(node);
    }
    faces_.resize(size_t{node} + 1);
    for (uint32_t i = 0; i < scene_.faces.size(); ++i) faces_[node_[scene_.faces[i].surface]].push_back(i);
    body_.assign(scene_.faces.size(), kNone);
  }
  if (body_[f] == kNone) FindBodies(node_[face.surface]);
  const Body& body = bodies_[body_[f]];
  if (!body.closed) return false;

  const Vec3d corner = scene_.positions[face.vertex[0]].cast<double>();
  const Vec3d normal = scene_.GeometricNormal(face).cast<double>();
  double deepest = 0;
  for (const uint32_t v : body.vertices) {
    const Vec3& p = scene_.positions[v];
    const double height = normal.dot(p.cast<double>() - corner);
    const double rounding = 4 * std::ldexp(double(p.cwiseAbs().maxCoeff()), -23);
    if (height > rounding) return false;
    deepest = std::max(deepest, -height - 2 * rounding);
  }
  return deepest > 0;
}

/// Bodies hang together over edges that two faces share; one is closed if no edge is of one face only.
void BodyFeet::FindBodies(uint32_t node) {
  const std::vector<uint32_t>& faces = faces_[node];
  using Place = std::array<float, 3>;
  struct Edge {
    Place low, high;
    uint32_t face;  // place in `faces`
    auto ends() const { return std::tie(low, high); }
  };
  std::vector<Edge> edges;
  for (uint32_t i = 0; i < faces.size(); ++i) {
    const auto p = scene_.Corners(scene_.faces[faces[i]]);
    std::array<Place, 3> place;
    for (int k = 0; k < 3; ++k) place[k] = {p[k].x() + 0.0f, p[k].y() + 0.0f, p[k].z() + 0.0f};  // -0 is 0
    for (int k = 0; k < 3; ++k) {
      const auto& [low, high] = std::minmax(place[k], place[(k + 1) % 3]);
      edges.push_back({low, high, i});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.ends() < b.ends(); });

  std::vector<uint32_t> parent(faces.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find = [&parent](uint32_t f) {
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
  };
  std::vector<uint32_t> open;  // faces with an edge of their own
  for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].ends() == edges[begin].ends()) ++end;
    if (end - begin == 1) open.push_back(edges[begin].face);
    // Where more meet, bodies touch.
    if (end - begin == 2) parent[find(edges[begin].face)] = find(edges[begin + 1].face);
  }
  std::vector<uint32_t> number(faces.size(), kNone);  // of the body, by root
  for (uint32_t i = 0; i < faces.size(); ++i) {
    uint32_t& body = number[find(i)];
    if (body == kNone) {
      body = static_cast<uint32_t>(bodies_.size());
      bodies_.emplace_back();
    }
    body_[faces[i]] = body;
    const auto& vertices = scene_.faces[faces[i]].vertex;
    bodies_[body].vertices.insert(bodies_[body].vertices.end(), vertices.begin(), vertices.end());
  }
  for (const uint32_t i : open) bodies_[body_[faces[i]]].closed = false;
}

}  // namespace lobe
