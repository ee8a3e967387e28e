#include "solver/lamp_aim.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "brdf/frame.h"
#include "solver/hash.h"
#include "solver/random_points.h"

namespace lobe {
namespace {

// A lamp that sends one ray in a hundred to what it should light passes for one that is meant so. (chosen)
constexpr int kRays = 256, kMaxBounces = 8;
// Of the rays from its backs, to find something: a lamp on a wall looks at the wall alone from there.
// (chosen)
constexpr int kLeastSeen = kRays / 4;

/// The single-sided emitting faces of one surface.
struct Lamp {
  std::vector<uint32_t> faces;
  std::vector<double> upto;  // sums of areas
};

std::map<uint32_t, Lamp> FindLamps(const Scene& scene) {
  std::map<uint32_t, Lamp> lamps;
  for (uint32_t f = 0; f < scene.faces.size(); ++f) {
    const Face& face = scene.faces[f];
    const Material& material = scene.material(face);
    if (!material.emits() || material.emits_behind() || material.body()) continue;
    Lamp& lamp = lamps[face.surface];
    lamp.upto.push_back((lamp.upto.empty() ? 0 : lamp.upto.back()) + scene.Area(face));
    lamp.faces.push_back(f);
  }
  return lamps;
}

class Walker {
 public:
  Walker(const Scene& scene, const RayTracer& tracer, uint64_t seed)
      : scene_(scene), tracer_(tracer), random_(seed) {}

  /// Starts anywhere on a lamp.
  void Start(const Lamp& lamp, Side side) {
    const double at = lamp.upto.back() * random_.Next();
    const size_t i = std::upper_bound(lamp.upto.begin(), lamp.upto.end(), at) - lamp.upto.begin();
    face_ = lamp.faces[std::min(i, lamp.faces.size() - 1)];
    side_ = side;
    position_ = PointOnTriangle(scene_.Corners(scene_.faces[face_]), random_.Next(), random_.Next());
    left_scene_ = false;
  }

  /// To a side that is seen, or through what lets light pass; false: the light ends.
  bool Step() {
    Vec3 normal = scene_.GeometricNormal(scene_.faces[face_]);
    if (side_ == Side::kBack) normal = -normal;
    const Vec3 w = Frame(normal).ToWorld(CosineDirection(random_.Next(), random_.Next()));
    const RayHit hit = tracer_.Intersect(tracer_.Leaving(face_, position_, normal, w));
    left_scene_ = !hit.hit();
    if (left_scene_) return false;
    face_ = hit.face;
    const auto p = scene_.Corners(scene_.faces[face_]);
    position_ = p[0] * (1 - hit.u - hit.v) + p[1] * hit.u + p[2] * hit.v;
    side_ = hit.side;
    const Material& material = scene_.material(scene_.faces[face_]);
    if (side_ == Side::kBack && !material.double_sided && !material.glass()) return false;
    if ((material.transmits() || material.glass()) && random_.Next() < 0.5f) {
      side_ = side_ == Side::kFront ? Side::kBack : Side::kFront;
    }
    return true;
  }

  uint32_t surface() const { return scene_.faces[face_].surface; }
  bool left_scene() const { return left_scene_; }

 private:
  const Scene& scene_;
  const RayTracer& tracer_;
  RandomStream random_;
  uint32_t face_ = kNone;
  Side side_ = Side::kFront;
  Vec3 position_ = Vec3::Zero();
  bool left_scene_ = false;
};

}  // namespace

void WarnOfLampsInsideOut(Scene* scene, const RayTracer& tracer, uint64_t seed) {
  const bool any_two_sided = std::any_of(scene->materials.begin(), scene->materials.end(),
                                         [](const Material& m) { return m.emits_behind() || m.body(); });
  bool all_leaves = !any_two_sided, any_inside_out = false;
  for (const auto& [surface, lamp] : FindLamps(*scene)) {
    Walker walker(*scene, tracer, Mix(Mix(seed, 0x1a3b), surface));
    std::map<uint32_t, int> behind;  // rays by surface
    int seen = 0;
    for (int i = 0; i < kRays; ++i) {
      walker.Start(lamp, Side::kBack);
      if (!walker.Step() || walker.surface() == surface) continue;
      ++seen;
      ++behind[walker.surface()];
    }
    bool reaches = false;
    for (int i = 0; i < kRays && !(reaches && !all_leaves); ++i) {
      walker.Start(lamp, Side::kFront);
      bool goes_on = walker.Step();
      all_leaves &= walker.left_scene();
      for (int bounce = 0; goes_on && bounce < kMaxBounces && !reaches; ++bounce) {
        reaches = behind.contains(walker.surface());
        goes_on = walker.Step();
      }
    }
    if (reaches || seen < kLeastSeen) continue;
    any_inside_out = true;
    const auto most = std::max_element(behind.begin(), behind.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    scene->warnings.push_back("lamp '" + scene->surface_names[surface] +
                              "' is inside out: none of its light reaches what lies behind it, as '" +
                              scene->surface_names[most->first] +
                              "' does; turn its triangles, or make its material double-sided");
  }
  if (all_leaves && !any_inside_out) {
    scene->warnings.push_back("the lamps light nothing: all their light leaves the scene");
  }
}

}  // namespace lobe
