#include "tests/support/rooms/generated_room.h"

#include <algorithm>
#include <cmath>

#include "brdf/sampling.h"
#include "render/camera_view.h"
#include "scene/ray_tracer.h"
#include "tests/support/rooms/furniture.h"
#include "tests/support/rooms/room_lamps.h"

namespace lobe::test {
namespace {

using Box3 = Eigen::AlignedBox3f;

constexpr float kSharp = 0.3f;

/// What is drawn before anything is placed.
struct Plan {
  float size;
  Vec3 inside;  // metres, before scaling
  int things, lamps;
  bool steel, bright, indirect;
  float power;  // watts a lamp, for a mean lamp of a room of that size
  RoughnessRange roughness;

  explicit Plan(RandomChoice& random) {
    size = random.Chance(0.5f) ? random.LogBetween(0.05f, 500) : random.Between(2, 20);
    steel = random.Chance(0.08f);  // lift cabins
    inside = steel ? Vec3{random.Between(1.2f, 2.2f), random.Between(2.1f, 2.6f), random.Between(1.2f, 2.2f)}
                   : Vec3{random.Between(2.5f, 8), random.Between(2.3f, 4.5f), random.Between(2.5f, 8)};
    const float floor = inside.x() * inside.z();
    things = steel ? random.Whole(0, 1) : random.Whole(2, std::clamp(static_cast<int>(floor / 3), 3, 8));
    lamps = random.Chance(0.4f) ? 1 : random.Chance(0.6f) ? random.Whole(2, 4) : random.Whole(5, 20);
    bright = random.Chance(0.12f);
    indirect = random.Chance(0.12f);
    power = random.LogBetween(1e-3f, 1e3f);
    // Half of the rooms have nothing sharp, as most real ones.
    if (random.Chance(0.5f)) roughness.least = kSharp;
  }
};

void AddWalls(const Plan& plan, RandomChoice& random, SceneBuilder* scene, std::set<std::string>* features) {
  const Vec3 h = plan.inside / 2;
  const float top = plan.inside.y();
  const auto draw = [&](float glossy) {
    const float albedo = plan.bright ? random.Between(0.88f, 0.95f) : DrawAlbedo(random);
    DrawnReflectance wall = plan.steel              ? DrawMetal(random, {0.1f, 0.5f}, albedo)
                            : random.Chance(glossy) ? DrawReflectance(random, plan.roughness, albedo)
                                                    : DrawMatte(random, albedo);
    features->insert("wall " + wall.model);
    return scene->AddMaterial("wall " + wall.model, wall.reflectance);
  };
  const uint32_t walls = draw(0.15f), floor = plan.steel && random.Chance(0.5f) ? walls : draw(0.35f),
                 ceiling = draw(0.05f);
  const uint32_t end = random.Chance(0.3f) ? draw(0.3f) : walls;
  scene->AddQuad({-h.x(), 0, -h.z()}, {-h.x(), 0, h.z()}, {h.x(), 0, h.z()}, {h.x(), 0, -h.z()}, floor);
  scene->AddQuad({-h.x(), top, -h.z()}, {h.x(), top, -h.z()}, {h.x(), top, h.z()}, {-h.x(), top, h.z()},
                 ceiling);
  scene->AddQuad({-h.x(), 0, -h.z()}, {h.x(), 0, -h.z()}, {h.x(), top, -h.z()}, {-h.x(), top, -h.z()}, end);
  scene->AddQuad({h.x(), 0, h.z()}, {-h.x(), 0, h.z()}, {-h.x(), top, h.z()}, {h.x(), top, h.z()}, walls);
  scene->AddQuad({-h.x(), 0, h.z()}, {-h.x(), 0, -h.z()}, {-h.x(), top, -h.z()}, {-h.x(), top, h.z()}, walls);
  scene->AddQuad({h.x(), 0, -h.z()}, {h.x(), 0, h.z()}, {h.x(), top, h.z()}, {h.x(), top, -h.z()}, walls);
}

/// How much of the room a camera sees; negative where nobody would put one.
float Worth(const Scene& scene, const RayTracer& tracer, const Camera& camera, float size) {
  constexpr int kAcross = 20;
  const CameraView view(camera, kAcross, kAcross);
  std::set<uint32_t> surfaces;
  int lamps = 0, near = 0;
  float depth = 0;
  for (int y = 0; y < kAcross; ++y) {
    for (int x = 0; x < kAcross; ++x) {
      const RayHit hit = tracer.Intersect(view.EyeRay(float(x) + 0.5f, float(y) + 0.5f));
      if (hit.face == kNone) return -1;
      const Face& face = scene.faces[hit.face];
      if (hit.side == Side::kBack && !scene.material(face).double_sided) return -1;
      surfaces.insert(face.surface);
      lamps += scene.material(face).emits();
      near += hit.t < 0.1f * size;
      depth += std::min(hit.t / size, 1.0f);
    }
  }
  constexpr float kRays = kAcross * kAcross;
  if (float(lamps) > 0.2f * kRays || float(near) > 0.1f * kRays) return -1;
  return depth / kRays * std::sqrt(static_cast<float>(surfaces.size()));
}

Camera FindCamera(const Scene& scene, const Furniture& furniture, const Vec3& inside, RandomChoice& random) {
  const RayTracer tracer(scene);
  Camera best;
  float most = 0;
  for (int found = 0, tried = 0; found < 12 && (tried < 400 || found == 0); ++tried) {
    const auto at = [&](float margin, float low, float high) {
      const Vec3 h = inside / 2 - Vec3::Constant(margin);
      return Vec3{random.Between(-h.x(), h.x()), inside.y() * random.Between(low, high),
                  random.Between(-h.z(), h.z())};
    };
    const Vec3 eye = at(0.15f, 0.3f, 0.75f), target = at(inside.x() / 4, 0.1f, 0.6f);
    const Vec3 clear = Vec3::Constant(0.15f);
    if ((eye - target).norm() < 0.3f * inside.norm() / 2 || !furniture.IsFree({eye - clear, eye + clear}))
      continue;
    Camera camera = LookAt(eye, target, Vec3::UnitY(), random.Between(0.8f, 1.2f));
    const float worth = Worth(scene, tracer, camera, inside.norm());
    if (worth > 0) ++found;
    if (worth <= most) continue;
    most = worth;
    best = camera;
  }
  best.name = "view";
  return best;
}

double SharpArea(const Scene& scene) {
  double all = 0, sharp = 0;
  for (const Face& face : scene.faces) {
    const Material& material = scene.material(face);
    if (material.emits()) continue;
    const double area = double(scene.Area(face)) * (material.double_sided ? 2 : 1);
    all += area;
    if (RoughnessOf(material.reflectance) < kSharp) sharp += area;
  }
  return sharp / all;
}

void Scale(float factor, Scene* scene) {
  for (Vec3& p : scene->positions) p *= factor;
  for (Camera& camera : scene->cameras) camera.eye *= factor;
}

}  // namespace

GeneratedRoom::GeneratedRoom(uint64_t seed_in) : seed(seed_in) {
  RandomChoice random(seed);
  const Plan plan(random);
  size = plan.size;
  SceneBuilder builder;
  AddWalls(plan, random, &builder, &features);
  const Box3 inside(Vec3(-plan.inside.x() / 2, 0, -plan.inside.z() / 2),
                    Vec3(plan.inside.x() / 2, plan.inside.y(), plan.inside.z() / 2));
  Furniture furniture(inside, &random, &builder);
  // Lamps first: the room must be lit.
  RoomLamps lamps(inside, &random, &builder, &furniture);
  lamps.Hang(plan.lamps, plan.power, plan.indirect);
  lamps_seen_directly = lamps.all_seen_directly();
  for (int i = 0; i < plan.things; ++i) furniture.AddThing(plan.roughness);
  if (random.Chance(0.1f)) furniture.AddMirror();
  if (!plan.steel && random.Chance(0.1f)) furniture.AddPane();
  if (random.Chance(0.06f)) furniture.AddGlassBody();

  features.insert(lamps.features().begin(), lamps.features().end());
  features.insert(furniture.features().begin(), furniture.features().end());
  if (plan.steel) features.insert("steel cabin");
  if (plan.bright) features.insert("bright walls");
  if (lamps.hung() > 4) features.insert("5+ lamps");
  if (!lamps_seen_directly) features.insert("indirect");
  if (size < 0.5f) features.insert("size < 0.5 m");
  if (size > 50) features.insert("size > 50 m");
  solid_glass = features.contains("glass");

  scene = builder.Build();
  scene.path = "room " + std::to_string(seed);
  scene.cameras = {FindCamera(scene, furniture, plan.inside, random)};
  sharp_area = SharpArea(scene);
  Scale(size / plan.inside.maxCoeff(), &scene);
}

}  // namespace lobe::test
