#include "scene/edge_table.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include <tbb/parallel_sort.h>

#include "scene/mesh.h"

namespace lobe {

namespace {

struct Record {
  uint32_t low, high;
  EdgeTable::Use use;
  auto key() const { return std::tuple(low, high, use.face, use.k); }
};

}  // namespace

EdgeTable::EdgeTable(const Scene& scene)
    : usable_(scene.faces.size()), place_(scene.positions.size()), edge_(3 * scene.faces.size(), kNone) {
  std::vector<uint32_t> order(scene.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&scene](uint32_t v) {
    const Vec3& p = scene.positions[v];
    return std::tuple(p.x(), p.y(), p.z());  // compares -0 and 0 as equal
  };
  tbb::parallel_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const auto ka = key(a), kb = key(b);
    return ka < kb || (ka == kb && a < b);
  });
  for (const uint32_t v : order) {
    if (position_.empty() || scene.positions[v] != position_.back()) position_.push_back(scene.positions[v]);
    place_[v] = static_cast<uint32_t>(position_.size() - 1);
  }

  std::vector<Record> records;
  records.reserve(3 * scene.faces.size());
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    const Face& face = scene.faces[f];
    usable_[f] = scene.Area(face) > 0 && scene.GeometricNormal(face).allFinite();
    if (!usable_[f]) continue;
    for (uint8_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(place_[face.vertex[k]], place_[face.vertex[(k + 1) % 3]]);
      records.push_back({low, high, {f, k}});
    }
  }
  tbb::parallel_sort(records.begin(), records.end(),
                     [](const Record& a, const Record& b) { return a.key() < b.key(); });
  uses_.reserve(records.size());
  for (const Record& r : records) {
    const std::array<uint32_t, 2> ends = {r.low, r.high};
    if (ends_.empty() || ends_.back() != ends) {
      ends_.push_back(ends);
      first_use_.push_back(uses_.size());
    }
    edge_[3 * size_t{r.use.face} + r.use.k] = static_cast<uint32_t>(ends_.size() - 1);
    uses_.push_back(r.use);
  }
  first_use_.push_back(uses_.size());
}

int EdgeTable::SharedPlaces(const Face& a, const Face& b) const {
  int shared = 0;
  for (const uint32_t v : a.vertex) {
    for (const uint32_t w : b.vertex) shared += place_[v] == place_[w];
  }
  return shared;
}

}  // namespace lobe
