#include "scene/ray_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include <embree3/rtcore.h>

#include "scene/input_error.h"
#include "scene/repeated_faces.h"
#include "sh/simd.h"

namespace lobe {

namespace {

constexpr uint32_t kAllMasks = 0xffffffffu;

/// Rays that meet an edge meet several faces at one t, or a rounding error apart. Which of them Embree
/// reports depends on the order it comes to them, and that on the other rays of a packet. So the choice is
/// made here: the least t and of equals the first face, by a filter that sees all that could be chosen.
struct Query {
  static constexpr int kMostRays = 16;
  RTCIntersectContext context;  // first, to get from Embree's pointer to ours
  std::array<float, kMostRays> t, t_max;
  std::array<uint32_t, kMostRays> primitive;

  explicit Query(bool coherent, RTCFilterFunctionN filter = nullptr) {
    rtcInitIntersectContext(&context);
    context.filter = filter;
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }

  /// Before each ray; `i` is its id.
  void Reset(int i, float ray_t_max) {
    t[i] = std::numeric_limits<float>::infinity();
    t_max[i] = ray_t_max;
    primitive[i] = kNone;
  }
};

void ChooseHit(const RTCFilterFunctionNArguments* args) {
  auto* query = reinterpret_cast<Query*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    const unsigned ray = RTCRayN_id(args->ray, args->N, i);
    float& end = RTCRayN_tfar(args->ray, args->N, i);
    const float t = end;
    const uint32_t primitive = RTCHitN_primID(args->hit, args->N, i);
    if (t > query->t[ray] || (t == query->t[ray] && primitive >= query->primitive[ray])) {
      args->valid[i] = 0;
      continue;
    }
    query->t[ray] = t;
    query->primitive[ray] = primitive;
    // Embree compares products with the ray's end, with rounding errors of their own; an end some
    // of them further keeps every face in sight that could still win.
    constexpr float kSlack = 8 * std::numeric_limits<float>::epsilon();
    end = std::min(t + std::abs(t) * kSlack, query->t_max[ray]);
  }
}

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
  r.ray.mask = kAllMasks;
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return r;
}

template <typename Lanes>
void PutRay(const Ray& ray, int i, Lanes* lanes) {
  lanes->org_x[i] = ray.origin.x();
  lanes->org_y[i] = ray.origin.y();
  lanes->org_z[i] = ray.origin.z();
  lanes->tnear[i] = ray.t_min;
  lanes->dir_x[i] = ray.direction.x();
  lanes->dir_y[i] = ray.direction.y();
  lanes->dir_z[i] = ray.direction.z();
  lanes->tfar[i] = ray.t_max;
  lanes->time[i] = 0;
  lanes->mask[i] = kAllMasks;
  lanes->id[i] = static_cast<unsigned>(i);
  lanes->flags[i] = 0;
}

LOBE_SIMD_CLONES void FillPacket(const Vec3& origin, const float* x, const float* y, const float* z,
                                 RTCRayHit16* p) {
  const FloatLanes zero = {};
  const UintLanes all_ones = UintLanes{} - 1;
  static_assert(kAllMasks == 0xffffffffu && RTC_INVALID_GEOMETRY_ID == 0xffffffffu);
  AsLanes(p->ray.org_x) = zero + origin.x();
  AsLanes(p->ray.org_y) = zero + origin.y();
  AsLanes(p->ray.org_z) = zero + origin.z();
  AsLanes(p->ray.tnear) = zero;
  AsLanes(p->ray.dir_x) = AsLanes(x);
  AsLanes(p->ray.dir_y) = AsLanes(y);
  AsLanes(p->ray.dir_z) = AsLanes(z);
  AsLanes(p->ray.time) = zero;
  AsLanes(p->ray.tfar) = zero + std::numeric_limits<float>::infinity();
  AsLanes(p->ray.mask) = all_ones;
  AsLanes(p->ray.flags) = UintLanes{};
  AsLanes(p->hit.geomID) = all_ones;
}

// As MakeHit, where no face repeats another.
LOBE_SIMD_CLONES void TakeHits(const RTCRayHit16& p, PacketHits* hits) {
  const FloatLanes cosine = AsLanes(p.hit.Ng_x) * AsLanes(p.ray.dir_x) +
                            AsLanes(p.hit.Ng_y) * AsLanes(p.ray.dir_y) +
                            AsLanes(p.hit.Ng_z) * AsLanes(p.ray.dir_z);
  const UintLanes front = (UintLanes)Negative(cosine);
  // All faces are geometry 0, so its number is zero or, if there was no hit, all ones.
  AsLanes(hits->face_side) = (2 * AsLanes(p.hit.primID) + 1 + front) | AsLanes(p.hit.geomID);
  AsLanes(hits->t) = AsLanes(p.ray.tfar);
  AsLanes(hits->u) = AsLanes(p.hit.u);
  AsLanes(hits->v) = AsLanes(p.hit.v);
}

template <int width>
struct Packet;
template <>
struct Packet<8> {
  using Rays = RTCRay8;
  using Hits = RTCRayHit8;
  static constexpr auto kIntersect = &rtcIntersect8;
  static constexpr auto kOccluded = &rtcOccluded8;
};
template <>
struct Packet<16> {
  using Rays = RTCRay16;
  using Hits = RTCRayHit16;
  static constexpr auto kIntersect = &rtcIntersect16;
  static constexpr auto kOccluded = &rtcOccluded16;
};

}  // namespace

struct RayTracer::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  int packet_width = 1;  // widest the processor is made for
  RepeatedFaces repeated;

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void Build(const Scene& from) {
    repeated = FindRepeatedFaces(from);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    if (!from.faces.empty()) {
      RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
      void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                               3 * sizeof(float), from.positions.size());
      auto* corner = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
          geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), repeated.kept.size()));
      if (vertices && corner) {
        static_assert(sizeof(Vec3) == 3 * sizeof(float));
        std::memcpy(vertices, from.positions.data(), from.positions.size() * sizeof(Vec3));
        for (uint32_t f : repeated.kept) corner = std::copy_n(from.faces[f].vertex.data(), 3, corner);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
      }
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene);
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY) {
      throw InputError(from.path + ": not enough memory to prepare " + std::to_string(from.faces.size()) +
                       " triangles for ray tracing");
    }
    if (error != RTC_ERROR_NONE) {
      throw InputError(from.path + ": Embree cannot prepare its triangles, error " + std::to_string(error));
    }
    if (repeated.twins.empty()) repeated.kept = {};  // Embree's numbers are ours
  }

  RayHit MakeHit(uint32_t primitive, float t, float u, float v, float normal_dot_direction) const {
    RayHit hit;
    hit.face = primitive;
    hit.t = t;
    hit.u = u;
    hit.v = v;
    // Embree's normal is (v1 - v0) x (v2 - v0), the front's: RayTracerTest.SideIsFrontForCounterClockwise.
    hit.side = normal_dot_direction < 0 ? Side::kFront : Side::kBack;
    if (repeated.twins.empty()) return hit;

    hit.face = repeated.kept[primitive];
    const RepeatedFaces::Twin& twin = repeated.twins[hit.face];
    if (hit.side == Side::kBack && twin.face != kNone) {
      const std::array<float, 3> weight = {1 - u - v, u, v};
      hit.face = twin.face;
      hit.side = Side::kFront;
      hit.u = weight[twin.corner[1]];
      hit.v = weight[twin.corner[2]];
    }
    return hit;
  }

  RayHit IntersectOne(const Ray& ray) const {
    Query query(false, &ChooseHit);
    query.Reset(0, ray.t_max);
    RTCRayHit r = MakeRay(ray);
    rtcIntersect1(scene, &query.context, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return MakeHit(r.hit.primID, query.t[0], r.hit.u, r.hit.v,
                   r.hit.Ng_x * r.ray.dir_x + r.hit.Ng_y * r.ray.dir_y + r.hit.Ng_z * r.ray.dir_z);
  }

  // Whether there is any hit does not depend on the order of looking: no filter here.
  bool OccludedOne(const Ray& ray) const {
    Query query(false);
    RTCRay r = MakeRay(ray).ray;
    rtcOccluded1(scene, &query.context, &r);
    return r.tfar < 0;  // Embree's mark
  }

  template <int width>
  void IntersectPackets(std::span<const Ray> rays, std::span<RayHit> hits) const {
    Query query(true, &ChooseHit);
    alignas(4 * width) int valid[width];
    for (size_t begin = 0; begin < rays.size(); begin += width) {
      typename Packet<width>::Hits p;
      const int count = static_cast<int>(std::min<size_t>(width, rays.size() - begin));
      for (int i = 0; i < width; ++i) {
        const Ray& ray = rays[begin + std::min(i, count - 1)];
        valid[i] = i < count ? -1 : 0;
        PutRay(ray, i, &p.ray);
        query.Reset(i, ray.t_max);
        p.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      }
      Packet<width>::kIntersect(valid, scene, &query.context, &p);
      for (int i = 0; i < count; ++i) {
        if (p.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
          hits[begin + i] = {};
          continue;
        }
        hits[begin + i] = MakeHit(
            p.hit.primID[i], query.t[i], p.hit.u[i], p.hit.v[i],
            p.hit.Ng_x[i] * p.ray.dir_x[i] + p.hit.Ng_y[i] * p.ray.dir_y[i] + p.hit.Ng_z[i] * p.ray.dir_z[i]);
      }
    }
  }

  template <int width>
  void IntersectFan(const Vec3& origin, const float* x, const float* y, const float* z,
                    std::span<RayHit> hits) const {
    Query query(true);
    alignas(4 * width) int valid[width];
    typename Packet<width>::Hits p;
    for (int i = 0; i < width; ++i) {
      PutRay({origin, 0.0f, Vec3::UnitZ(), 0.0f}, i, &p.ray);
    }
    for (size_t begin = 0; begin < hits.size(); begin += width) {
      const int count = static_cast<int>(std::min<size_t>(width, hits.size() - begin));
      std::fill(valid, valid + width, 0);
      std::fill(valid, valid + count, -1);
      std::copy_n(x + begin, count, p.ray.dir_x);
      std::copy_n(y + begin, count, p.ray.dir_y);
      std::copy_n(z + begin, count, p.ray.dir_z);
      std::fill(p.ray.tfar, p.ray.tfar + width, std::numeric_limits<float>::infinity());
      std::fill(p.hit.geomID, p.hit.geomID + width, RTC_INVALID_GEOMETRY_ID);
      Packet<width>::kIntersect(valid, scene, &query.context, &p);
      for (int i = 0; i < count; ++i) {
        if (p.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
          hits[begin + i] = {};
          continue;
        }
        hits[begin + i] = MakeHit(
            p.hit.primID[i], p.ray.tfar[i], p.hit.u[i], p.hit.v[i],
            p.hit.Ng_x[i] * p.ray.dir_x[i] + p.hit.Ng_y[i] * p.ray.dir_y[i] + p.hit.Ng_z[i] * p.ray.dir_z[i]);
      }
    }
  }

  template <int width>
  void OccludedPackets(std::span<const Ray> rays, std::span<uint8_t> occluded) const {
    Query query(true);
    alignas(4 * width) int valid[width];
    for (size_t begin = 0; begin < rays.size(); begin += width) {
      typename Packet<width>::Rays p;
      const int count = static_cast<int>(std::min<size_t>(width, rays.size() - begin));
      for (int i = 0; i < width; ++i) {
        valid[i] = i < count ? -1 : 0;
        PutRay(rays[begin + std::min(i, count - 1)], i, &p);
      }
      Packet<width>::kOccluded(valid, scene, &query.context, &p);
      for (int i = 0; i < count; ++i) occluded[begin + i] = p.tfar[i] < 0;
    }
  }
};

RayTracer::RayTracer(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  impl_->device = rtcNewDevice(nullptr);
  if (!impl_->device) {
    throw InputError("this machine cannot run Embree: error " + std::to_string(rtcGetDeviceError(nullptr)));
  }
  impl_->scene = rtcNewScene(impl_->device);
  impl_->Build(scene);
  if (rtcGetDeviceProperty(impl_->device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) {
    impl_->packet_width = 16;
  } else if (rtcGetDeviceProperty(impl_->device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)) {
    impl_->packet_width = 8;
  }

  // A point interpolated on a face, lifted in float, and the distance Embree finds from it to that face each
  // err by about half a unit in the last place of the coordinates. Measured on single triangles at random
  // places, with rays down to 0.006 degrees above the face: hits on the own face end at 1.5 units. Four
  // leave some room.
  float farthest = 0;
  for (const Face& face : scene.faces) {
    for (uint32_t v : face.vertex) farthest = std::max(farthest, scene.positions[v].cwiseAbs().maxCoeff());
  }
  epsilon_ = kRoundings * std::ldexp(farthest, -23);
  for (const Face& face : scene.faces) {
    const auto p = scene.Corners(face);
    Eigen::AlignedBox3f box(p[0]);
    box.extend(p[1]).extend(p[2]);
    face_lift_.push_back(LiftOf(box));
  }
  const auto all = [this](float lift) { return lift == epsilon_; };
  if (std::all_of(face_lift_.begin(), face_lift_.end(), all)) face_lift_ = {};
}

float RayTracer::LiftOf(const Eigen::AlignedBox3f& box) const {
  if (box.isEmpty()) return epsilon_;
  constexpr float kOfSize = 1e-3f;  // chosen: does not show
  const float farthest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  const float size = box.sizes().maxCoeff();
  return std::min(epsilon_, std::max(kRoundings * std::ldexp(farthest, -23), kOfSize * size));
}

std::vector<float> RayTracer::PatchLifts(const Mesh& mesh) const {
  if (face_lift_.empty()) return std::vector<float>(mesh.patches.size(), epsilon_);
  std::vector<float> out;
  for (const Mesh::Patch& patch : mesh.patches) {
    Eigen::AlignedBox3f box;
    for (uint32_t n = patch.node_begin; n < patch.node_end; ++n) box.extend(mesh.node_position[n]);
    out.push_back(LiftOf(box));
  }
  return out;
}

RayTracer::~RayTracer() = default;
RayTracer::RayTracer(RayTracer&&) noexcept = default;

RayHit RayTracer::Intersect(const Ray& ray) const { return impl_->IntersectOne(ray); }

bool RayTracer::Occluded(const Ray& ray) const { return impl_->OccludedOne(ray); }

// Packets are 3 times as fast for rays that go together, and up to 1.5 times slower for others.
void RayTracer::Intersect(std::span<const Ray> rays, std::span<RayHit> hits, bool coherent) const {
  if (coherent && impl_->packet_width == 16) return impl_->IntersectPackets<16>(rays, hits);
  if (coherent && impl_->packet_width == 8) return impl_->IntersectPackets<8>(rays, hits);
  for (size_t i = 0; i < rays.size(); ++i) hits[i] = impl_->IntersectOne(rays[i]);
}

void RayTracer::IntersectFan(const Vec3& origin, const float* x, const float* y, const float* z,
                             std::span<RayHit> hits) const {
  if (impl_->packet_width == 16) return impl_->IntersectFan<16>(origin, x, y, z, hits);
  if (impl_->packet_width == 8) return impl_->IntersectFan<8>(origin, x, y, z, hits);
  for (size_t i = 0; i < hits.size(); ++i) {
    hits[i] = impl_->IntersectOne({origin, 0.0f, {x[i], y[i], z[i]}, std::numeric_limits<float>::infinity()});
  }
}

void RayTracer::IntersectPacket(const Vec3& origin, const float* x, const float* y, const float* z,
                                PacketHits* hits) const {
  if (impl_->packet_width == 16 && impl_->repeated.twins.empty()) {
    Query query(true);
    alignas(64) int valid[kLanes];
    std::fill(valid, valid + kLanes, -1);
    RTCRayHit16 p;
    FillPacket(origin, x, y, z, &p);
    rtcIntersect16(valid, impl_->scene, &query.context, &p);
    TakeHits(p, hits);
    return;
  }
  RayHit each[kLanes];
  IntersectFan(origin, x, y, z, each);
  for (int i = 0; i < kLanes; ++i) {
    hits->face_side[i] = each[i].hit() ? 2 * each[i].face + uint32_t(each[i].side) : kNone;
    hits->t[i] = each[i].t;
    hits->u[i] = each[i].u;
    hits->v[i] = each[i].v;
  }
}

void RayTracer::Occluded(std::span<const Ray> rays, std::span<uint8_t> occluded, bool coherent) const {
  if (coherent && impl_->packet_width == 16) return impl_->OccludedPackets<16>(rays, occluded);
  if (coherent && impl_->packet_width == 8) return impl_->OccludedPackets<8>(rays, occluded);
  for (size_t i = 0; i < rays.size(); ++i) occluded[i] = impl_->OccludedOne(rays[i]);
}

}  // namespace lobe
