#include "scene/ray_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <embree3/rtcore.h>

#include "scene/input_error.h"

namespace lobe {

namespace {

RTCRayHit MakeRay(const Ray& ray) {
  RTCRayHit r{};
  r.ray.org_x = ray.origin.x();
  r.ray.org_y = ray.origin.y();
  r.ray.org_z = ray.origin.z();
  r.ray.tnear = ray.t_min;
  r.ray.dir_x = ray.direction.x();
  r.ray.dir_y = ray.direction.y();
  r.ray.dir_z = ray.direction.z();
  r.ray.tfar = ray.t_max;
  r.ray.mask = 0xffffffffu;
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return r;
}

/// `face`: Embree's number of it.
RayHit MakeHit(const RTCRayHit& r) {
  RayHit hit;
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.face = r.hit.primID;
  hit.t = r.ray.tfar;
  hit.u = r.hit.u;
  hit.v = r.hit.v;
  // Ng is (v1 - v0) x (v2 - v0), the front's normal (RayTracerTest.FrontIsCounterClockwise).
  const float cosine = r.hit.Ng_x * r.ray.dir_x + r.hit.Ng_y * r.ray.dir_y + r.hit.Ng_z * r.ray.dir_z;
  hit.side = cosine < 0 ? Side::kFront : Side::kBack;
  return hit;
}

RTCIntersectContext MakeContext(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}


/// Rays side by side, as Embree's packets hold them.
template <typename PacketRay>
void PutRay(const Ray& ray, int lane, PacketRay* packet) {
  packet->org_x[lane] = ray.origin.x();
  packet->org_y[lane] = ray.origin.y();
  packet->org_z[lane] = ray.origin.z();
  packet->tnear[lane] = ray.t_min;
  packet->dir_x[lane] = ray.direction.x();
  packet->dir_y[lane] = ray.direction.y();
  packet->dir_z[lane] = ray.direction.z();
  packet->tfar[lane] = ray.t_max;
  packet->time[lane] = 0;
  packet->mask[lane] = 0xffffffffu;
  packet->id[lane] = 0;
  packet->flags[lane] = 0;
}

RTCRayHit TakeRay(const auto& packet, int lane) {
  RTCRayHit r{};
  r.ray.dir_x = packet.ray.dir_x[lane];
  r.ray.dir_y = packet.ray.dir_y[lane];
  r.ray.dir_z = packet.ray.dir_z[lane];
  r.ray.tfar = packet.ray.tfar[lane];
  r.hit.Ng_x = packet.hit.Ng_x[lane];
  r.hit.Ng_y = packet.hit.Ng_y[lane];
  r.hit.Ng_z = packet.hit.Ng_z[lane];
  r.hit.u = packet.hit.u[lane];
  r.hit.v = packet.hit.v[lane];
  r.hit.primID = packet.hit.primID[lane];
  r.hit.geomID = packet.hit.geomID[lane];
  return r;
}

/// Embree tests one triangle the same way in packets of any width, but of two that share an edge and are
/// met there at one t, the one it comes to last wins, and the order depends on the packet. Both can be met
/// only if the barycentrics of the larger are within a rounding error (2^-23) of the edge, and those of the
/// smaller within that times the ratio of their areas; a thousandth covers ratios up to 8000.
bool IsNearEdge(const RayHit& hit) { return std::min({hit.u, hit.v, 1 - hit.u - hit.v}) < 1e-3f; }

using Triangle = std::array<uint32_t, 3>;

/// Faces with the same three corners: which stand for all, and who is whose other side.
struct Repeats {
  std::vector<uint32_t> kept;    ///< faces to trace; empty if that is all of them
  /// By face: one that has its corners in the opposite order, or kNone. Empty if there are none.
  std::vector<uint32_t> twin;
};

Repeats FindRepeats(const Scene& scene) {
  // Corners by position, the smallest first, and whether getting there took an odd permutation.
  struct Entry {
    std::array<std::array<float, 3>, 3> corner;
    bool odd;
    uint32_t face;
  };
  std::vector<Entry> entries(scene.faces.size());
  for (uint32_t f = 0; f < entries.size(); ++f) {
    Entry& e = entries[f];
    const std::array<Vec3, 3> p = scene.Corners(scene.faces[f]);
    // Adding zero turns -0 into 0.
    for (int k = 0; k < 3; ++k) e.corner[k] = {p[k].x() + 0.0f, p[k].y() + 0.0f, p[k].z() + 0.0f};
    e.odd = false;
    e.face = f;
    for (const auto [i, j] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 1)}) {
      if (e.corner[j] < e.corner[i]) {
        std::swap(e.corner[i], e.corner[j]);
        e.odd = !e.odd;
      }
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.corner != b.corner ? a.corner < b.corner : a.face < b.face;
  });
  Repeats repeats;
  std::vector<uint32_t> dropped;
  for (size_t i = 0; i < entries.size();) {
    size_t j = i + 1;
    for (; j < entries.size() && entries[j].corner == entries[i].corner; ++j) {
      dropped.push_back(entries[j].face);
      if (entries[j].odd != entries[i].odd) {
        repeats.twin.resize(scene.faces.size(), kNone);
        uint32_t& twin = repeats.twin[entries[i].face];
        if (twin == kNone) twin = entries[j].face;
      }
    }
    i = j;
  }
  if (dropped.empty()) return repeats;
  std::sort(dropped.begin(), dropped.end());
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    if (!std::binary_search(dropped.begin(), dropped.end(), f)) repeats.kept.push_back(f);
  }
  return repeats;
}

}  // namespace

struct RayTracer::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  int packet_width = 1;           ///< widest this processor has
  const Face* faces = nullptr;
  std::vector<Triangle> corners;  ///< of faces with a twin and their twins, see Repeats
  Repeats repeats;

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};
