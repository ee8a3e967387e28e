#pragma once

#include <algorithm>
#include <type_traits>
#include <vector>

#include <embree3/rtcore.h>

#include "bench/timing.h"
#include "scene/ray_tracer.h"
#include "scene/scene.h"

namespace lobe {

/// Embree with nothing around it, the limit to compare with: no filter, no choice among equal hits, rays
/// ready in packets of 16.
class BareEmbree {
 public:
  explicit BareEmbree(const Scene& scene) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, scene.positions.size()));
    for (const Vec3& p : scene.positions) vertex = std::copy_n(p.data(), 3, vertex);
    auto* corner = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                                  RTC_FORMAT_UINT3, 12, scene.faces.size()));
    for (const Face& f : scene.faces) corner = std::copy_n(f.vertex.data(), 3, corner);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~BareEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  static void Put(const Ray& ray, int lane, RTCRay16* p) {
    p->org_x[lane] = ray.origin.x();
    p->org_y[lane] = ray.origin.y();
    p->org_z[lane] = ray.origin.z();
    p->dir_x[lane] = ray.direction.x();
    p->dir_y[lane] = ray.direction.y();
    p->dir_z[lane] = ray.direction.z();
    p->tnear[lane] = ray.t_min;
    p->tfar[lane] = ray.t_max;
    p->time[lane] = 0;
    p->mask[lane] = 0xffffffffu;
    p->id[lane] = p->flags[lane] = 0;
  }

  /// CPU seconds to trace the packets: nearest hits, or occlusion. Fills them anew each time.
  double Nearest(const std::vector<Ray>& rays) { return Trace<RTCRayHit16>(rays); }
  double Occlusion(const std::vector<Ray>& rays) { return Trace<RTCRay16>(rays); }

 private:
  template <typename Packet>
  double Trace(const std::vector<Ray>& rays) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) int valid[16];
    std::fill(valid, valid + 16, -1);
    constexpr size_t kPackets = 1024;
    std::vector<Packet> packets(kPackets);
    double seconds = 0;
    for (size_t begin = 0; begin + 16 <= rays.size(); begin += 16 * kPackets) {
      const size_t count = std::min(kPackets, (rays.size() - begin) / 16);
      for (size_t k = 0; k < count; ++k) {
        for (int i = 0; i < 16; ++i) {
          const Ray& ray = rays[begin + 16 * k + i];
          if constexpr (std::is_same_v<Packet, RTCRay16>) {
            Put(ray, i, &packets[k]);
          } else {
            Put(ray, i, &packets[k].ray);
            packets[k].hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
          }
        }
      }
      const double start = CpuSeconds();
      for (size_t k = 0; k < count; ++k) {
        if constexpr (std::is_same_v<Packet, RTCRay16>) {
          rtcOccluded16(valid, scene_, &context, &packets[k]);
        } else {
          rtcIntersect16(valid, scene_, &context, &packets[k]);
        }
      }
      seconds += CpuSeconds() - start;
    }
    return seconds;
  }

  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace lobe
