#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "brdf/frame.h"
#include "brdf/sampling.h"
#include "render/alias_table.h"

namespace lobe {

/// The emitting faces of a scene, to be drawn from: by power, or from one vertex by about what each brings.
///
/// From a vertex *groups* are weighed: single faces if there are few, else those of a surface that look much
/// the same way (a bulb of many triangles is eight groups, most of which look away), else all of a surface.
/// Inside a group faces are drawn by power. Scenes of more groups than kMostGroups keep to power alone.
class Lamps {
 public:
  static constexpr size_t kMostGroups = 32;

  struct Face {
    uint32_t face;
    std::array<Vec3, 3> corners;
    Vec3 normal;    ///< of the front
    bool emits[2];  ///< by side
    float area;
    double power;      ///< mean of channels, of both sides; any unit
    uint32_t surface;  ///< faces of one are one lamp
  };

  Lamps() = default;
  explicit Lamps(std::vector<Face> faces);

  bool empty() const { return faces_.empty(); }
  uint32_t face(uint32_t lamp) const { return faces_[lamp].face; }

  /// Chances of the groups, from one vertex.
  struct Choice {
    uint32_t count = 0;                         ///< of groups; 0: by power
    std::array<float, kMostGroups> upto;        ///< sums of chances, the last one is 1
    std::array<float, kMostGroups> over_power;  ///< chance over share of power
  };
  /// In proportion to about what each group brings to the vertex if nothing is in the way, by reflectance and
  /// distance; no group that may bring anything has a chance of 0. Costs at most four evaluations of the
  /// reflectance a group.
  Choice ChooseFrom(const Vec3& position, const Frame& frame, const Vec3& wo_local,
                    const ReflectanceSampler& sampler) const;

  /// Index of a lamp's face, by `bits` (all 64 uniform) and `choice`; null: by power.
  uint32_t Draw(uint64_t bits, const Choice* choice) const;
  /// Chance of that face over its area, per square metre.
  float PerArea(uint32_t lamp, const Choice* choice) const {
    const float by_power = per_area_[lamp];
    return choice && choice->count > 0 ? by_power * choice->over_power[group_of_[lamp]] : by_power;
  }

 private:
  struct Group {
    std::vector<uint32_t> lamps;
    AliasTable draw;
    float power;               // share
    float least_distance2;     // nearer than its own size a lamp does not get brighter
    std::vector<Vec3> probes;  // middle first, then corners of its hull
    size_t evaluated;          // probes whose reflectance is looked at; the others tell about the horizon
    bool one_sided;            // a single face, or faces that emit on their fronts alone
    Vec3 axis;                 // mean normal
    float spread;              // sine of the widest angle of a normal to it; 1: any
  };

  std::vector<Face> faces_;
  std::vector<float> per_area_;  // by power
  std::vector<uint32_t> group_of_;
  std::vector<Group> groups_;  // empty: too many
  AliasTable by_power_;
};

}  // namespace lobe
