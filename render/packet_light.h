#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/eye_rays.h"
#include "scene/element_locator.h"
#include "solver/solution.h"

namespace lobe {

/// What eye rays see of the light a solution stores, by packets. Three things make it cheap beside tracing:
///
/// - Rays of a packet mostly hit one element: its leaf (ElementLocator::Leaf) tells of all lanes at once
/// which
///   lie inside, and only those outside are looked up, one for all that share its element.
/// - Over an element of diffuse nodes radiance is linear in the face's barycentrics: three factors a channel.
/// - Seen from a pinhole, a glossy node's radiance is a smooth function of the film position. It is read
///   once per tile in n x n directions (FilmGrid) and interpolated: within 1e-3 of the lobe's size. Where no
///   such grid is good enough (high degree on a wide tile), or the tile's directions cross the node's
///   horizon, where directions are bent, the packet's own directions are read: no interpolation there.
///
/// The general way is Renderer's per ray; what is not light stored on a surface (mirrors, for one) is left to
/// it.
///
/// A PacketLight is one thread's: it keeps the last elements and nodes it met, about a quarter of a megabyte
/// whatever the scene; lobes are read where they are stored. Results do not depend on what it met before
/// Start.
class PacketLight {
 public:
  /// `handled[2 * material + side]`: 1 if light of that side of the material is read here; `except[element]`:
  /// 1 if that of the element is not all the same; empty: none such. References are kept.
  PacketLight(const Solution& solution, const ElementLocator& locator, const std::vector<uint8_t>& handled,
              std::span<const uint8_t> except = {});
  ~PacketLight();
  PacketLight(PacketLight&&) noexcept;

  /// Packets that follow pass the film within [x0, x1] x [y0, y1], in pixels.
  void Start(const CameraView::Film& film, float x0, float y0, float x1, float y1);

  /// Radiance towards the eye (emission included, negative lobe values clamped) of those of `lanes` whose
  /// hits are handled; 0 for others. Channel c of lane i goes to radiance[c * kLanes + i], aligned to 64
  /// bytes. Returns the lanes that are not handled.
  uint32_t Read(const EyePacket& rays, const PacketHits& hits, uint32_t lanes, float* radiance);

  /// Sum over channels of what clamping added since the last call.
  double TakeClamped();

  /// Since construction: for benches and tests.
  struct Counts {
    uint64_t lookups = 0, grids = 0, exact_reads = 0;
  };
  const Counts& counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lobe
