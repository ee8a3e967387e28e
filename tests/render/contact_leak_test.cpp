#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/path_tracer.h"
#include "render/renderer.h"
#include "solver/solver.h"
#include "tests/support/scene_builder.h"

namespace lobe {
namespace {

using test::SceneBuilder;

// Radiance beside contacts of solved scenes against path tracing the same point: nothing may leak, neither
// light out of what is lit nor darkness out of what is covered. LOBE_CONTACT_LINKS=2048 and
// LOBE_CONTACT_EDGE=0.1 tell noise of links and width of elements apart from leaks.
constexpr double kBound = 0.03, kStandardErrors = 2;
constexpr double kDistances[] = {0.001, 0.005, 0.02, 0.1};
// Places along a contact, as fractions of its length; not where a bisected mesh has its nodes.
constexpr double kPlaces[] = {0.09, 0.17, 0.36, 0.44, 0.59, 0.68, 0.87, 0.95};

// One of the two surfaces that meet along the line a-b: `away` lies in it, leads away from the line, and is
// of unit length like `normal`, which points to where it is seen from.
struct Shore {
  std::string name;
  Vec3 a, b, away, normal;
  float width = 1;  // where it ends
};

struct Worst {
  double difference = 0;  // relative, signed
  double standard_error = 0;
  std::string where;
};

double FromEnvironment(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atof(text) : otherwise;
}

// Mean and relative standard error of what leaves the surface at the end of `ray`; about half a percent.
std::pair<double, double> PathTraced(const PathTracer& tracer, const Ray& ray, uint64_t seed) {
  const RayHit hit = tracer.tracer().Intersect(ray);
  if (!hit.hit()) return {0, 0};
  const SurfacePoint at{hit.face, hit.side, hit.u, hit.v};
  constexpr int kPilot = 4096;
  const Estimate pilot = tracer.ExitantRadiance(at, -ray.direction, kPilot, 2 * seed);
  const double wanted = kPilot * std::pow(pilot.standard_error[1] / (0.0045 * pilot.mean[1]), 2);
  const Estimate e =
      tracer.ExitantRadiance(at, -ray.direction, int(std::clamp(wanted, 4096.0, 4e5)), 2 * seed + 1);
  return {e.mean[1], e.standard_error[1] / e.mean[1]};
}

// Everything along `shores` agrees with the path tracer at every distance.
void ExpectNoLeaks(const Scene& scene, const std::vector<Shore>& shores) {
  SolveOptions options;
  options.refine.contact_error = 0.04;
  options.mesh.max_edge = float(FromEnvironment("LOBE_CONTACT_EDGE", 0.3));
  options.links = int(FromEnvironment("LOBE_CONTACT_LINKS", options.links));
  options.light_samples = int(FromEnvironment("LOBE_CONTACT_LIGHT_SAMPLES", options.light_samples));
  const Solution solution = Solve(scene, options);
  const Renderer renderer(solution);
  const PathTracer path_tracer(scene);
  Worst worst[std::size(kDistances)];
  uint64_t seed = 1;
  for (const Shore& shore : shores) {
    for (const double place : kPlaces) {
      for (size_t i = 0; i < std::size(kDistances); ++i) {
        if (kDistances[i] >= shore.width) continue;
        const Vec3 p = shore.a + (shore.b - shore.a) * float(place) + shore.away * float(kDistances[i]);
        const Ray ray{p + shore.normal * 0.01f, 0, -shore.normal, 0.02f};
        const double solved = renderer.Radiance(ray)[1];
        const auto [truth, error] = PathTraced(path_tracer, ray, seed++);
        char where[200];
        std::snprintf(where, sizeof where, "%s, %g along, %g m off", shore.name.c_str(), place,
                      kDistances[i]);
        ASSERT_GT(truth, 0) << where;
        EXPECT_LT(error, 0.0055) << where << ": too few paths";
        const double difference = solved / truth - 1;
        EXPECT_LE(std::abs(difference), kBound + kStandardErrors * error)
            << where << ": " << solved << " for " << truth;
        if (std::abs(difference) > std::abs(worst[i].difference)) worst[i] = {difference, error, where};
      }
    }
  }
  std::printf("%zu nodes, %.2f s\n", solution.mesh.node_count(), solution.solve_seconds);
  for (const Worst& w : worst) {
    std::printf("%+.2f %% (+- %.2f %%) %s\n", 100 * w.difference, 100 * w.standard_error, w.where.c_str());
  }
}

// A closed room, 4 x 3 x 4 m, of walls that reflect half, and a lamp of 1 m^2 aside of its middle.
class Room : public SceneBuilder {
 public:
  explicit Room(bool with_floor = true) : white(AddLambert(Rgb::Constant(0.5f))) {
    if (with_floor) {
      AddBox({-2, 0, -2}, {2, 3, 2}, white, /*inward=*/true);
    } else {
      AddQuad({-2, 0, 2}, {-2, 3, 2}, {2, 3, 2}, {2, 0, 2}, white);
      AddQuad({-2, 0, -2}, {2, 0, -2}, {2, 3, -2}, {-2, 3, -2}, white);
      AddQuad({-2, 0, -2}, {-2, 3, -2}, {-2, 3, 2}, {-2, 0, 2}, white);
      AddQuad({2, 0, -2}, {2, 0, 2}, {2, 3, 2}, {2, 3, -2}, white);
      AddQuad({-2, 3, -2}, {2, 3, -2}, {2, 3, 2}, {-2, 3, 2}, white);
    }
  }
  void AddLamp(const Vec3& centre, float radiance) {
    const Vec3 x(0.5f, 0, 0), z(0, 0, 0.5f);
    AddQuad(centre - x - z, centre + x - z, centre + x + z, centre - x + z,
            AddEmitter(Rgb::Constant(radiance)));
  }
  const uint32_t white;
};

// About the upright axis through the origin.
Vec3 Turned(const Vec3& v, float angle) { return Eigen::AngleAxisf(angle, Vec3::UnitY()) * v; }

void Turn(Scene* scene, uint32_t surface, float angle) {
  std::vector<bool> done(scene->positions.size(), false);
  for (const Face& face : scene->faces) {
    if (face.surface != surface) continue;
    for (const uint32_t v : face.vertex) {
      if (done[v]) continue;
      done[v] = true;
      scene->positions[v] = Turned(scene->positions[v], angle);
      scene->normals[v] = Turned(scene->normals[v], angle);
    }
  }
}

// Floor and sides along the foot, at y = 0, of a box turned about the upright axis.
std::vector<Shore> FootOf(float half_x, float half_z, float angle) {
  std::vector<Shore> shores;
  for (int side = 0; side < 4; ++side) {
    const Vec3 out = side == 0   ? Vec3(1, 0, 0)
                     : side == 1 ? Vec3(0, 0, 1)
                     : side == 2 ? Vec3(-1, 0, 0)
                                 : Vec3(0, 0, -1);
    const Vec3 along(out.z(), 0, out.x());
    const Vec3 extent(half_x, 0, half_z);
    const Vec3 middle = out.cwiseProduct(extent), half = along.cwiseProduct(extent);
    const Vec3 a = Turned(middle - half, angle), b = Turned(middle + half, angle), n = Turned(out, angle);
    const std::string name = std::to_string(side);
    shores.push_back({"floor at side " + name, a, b, n, Vec3::UnitY()});
    shores.push_back({"side " + name, a, b, Vec3::UnitY(), n});
  }
  return shores;
}

void ExpectNoLeaksAtABox(float bottom) {
  Room room;
  room.AddLamp({0.7f, 2.9f, 0.3f}, 10);
  const uint32_t box = room.AddBox({-0.4f, bottom, -0.3f}, {0.4f, 0.6f, 0.3f}, room.white);
  Scene scene = room.Build();
  Turn(&scene, box, 0.4f);
  ExpectNoLeaks(scene, FootOf(0.4f, 0.3f, 0.4f));
}

TEST(SlowContactLeakTest, BoxStandingOnAFloorKeepsItsContactDark) { ExpectNoLeaksAtABox(0); }

TEST(SlowContactLeakTest, BoxSunkACentimetreIntoAFloorKeepsItsContactDark) { ExpectNoLeaksAtABox(-0.01f); }

void ExpectNoLeaksAtAbuttingBoxes(const std::vector<Shore>& shores) {
  Room room;
  room.AddLamp({0.7f, 2.9f, 0.3f}, 10);
  room.AddBox({-0.6f, 0, -0.4f}, {0, 1.1f, 0.4f}, room.white);
  room.AddBox({0, 0, -0.25f}, {0.5f, 0.5f, 0.2f}, room.white);
  ExpectNoLeaks(room.Build(), shores);
}

TEST(SlowContactLeakTest, AbuttingBoxesDoNotLeakWhereTheLowerOneEnds) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), p(0, 0.5f, -0.25f), q(0, 0.5f, 0.2f);
  ExpectNoLeaksAtAbuttingBoxes(
      {{"top of the low box", p, q, x, y}, {"side of the high box above", p, q, y, x}});
}

// Fails in one place of 64: 7.6 % too dark 5 mm off, 2.5 cm below the top of the low box, in a penumbra
// that is a few millimetres wide.
TEST(SlowContactLeakTest, DISABLED_AbuttingBoxesDoNotLeakWhereTheNarrowerOneEnds) {
  const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ(), foot(0, 0, 0.2f), q(0, 0.5f, 0.2f);
  ExpectNoLeaksAtAbuttingBoxes(
      {{"front of the low box", foot, q, x, z}, {"side of the high box before", foot, q, z, x}});
}

// Fails: 8.1 % too dark 1 mm beside the frame, 6.2 % at 5 mm. Light on
// the wall varies within millimetres there, probably as the gap shows under the frame; elements are
// centimetres wide.
TEST(SlowContactLeakTest, DISABLED_FrameAMillimetreOffAWallKeepsItsShadowBehindIt) {
  Room room;
  room.AddLamp({0.7f, 2.9f, 0.3f}, 10);
  const float back = -2 + 0.001f;
  room.AddBox({-0.4f, 1.2f, back}, {0.4f, 1.8f, back + 0.03f}, room.white);
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  // On the wall; the frame's sides begin a millimetre before it.
  const Vec3 gap(0, 0, 0.001f);
  const Vec3 a(-0.4f, 1.2f, -2), b(0.4f, 1.2f, -2), c(0.4f, 1.8f, -2), d(-0.4f, 1.8f, -2);
  ExpectNoLeaks(room.Build(), {{"wall below", a, b, -y, z},
                               {"wall to the right", b, c, x, z},
                               {"wall above", c, d, y, z},
                               {"wall to the left", d, a, -x, z},
                               {"underside of the frame", a + gap, b + gap, z, -y, 0.03f},
                               {"right side of the frame", b + gap, c + gap, z, x, 0.03f},
                               {"top of the frame", c + gap, d + gap, z, y, 0.03f}});
}

// Two closed rooms, one ten times as bright as the other, with one double-sided quad between them.
TEST(SlowContactLeakTest, WallOneTriangleThinKeepsTwoRoomsApart) {
  Room room;
  room.AddLamp({1.2f, 2.9f, 0.3f}, 10);
  room.AddLamp({-1.2f, 2.9f, -0.3f}, 1);
  const uint32_t sheet =
      room.AddMaterial("sheet", Lambert{Rgb::Constant(0.5f)}, Rgb::Zero(), /*double_sided=*/true);
  room.AddQuad({0.1f, 0, -2}, {0.1f, 3, -2}, {0.1f, 3, 2}, {0.1f, 0, 2}, sheet);
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const Vec3 a(0.1f, 0, -2), b(0.1f, 0, 2), c(0.1f, 3, -2);
  ExpectNoLeaks(room.Build(), {{"floor of the bright room", a, b, x, y},
                               {"floor of the dim room", a, b, -x, y},
                               {"sheet over the bright floor", a, b, y, x},
                               {"sheet over the dim floor", a, b, y, -x},
                               {"wall of the bright room", a, c, x, z},
                               {"wall of the dim room", a, c, -x, z}});
}

// Floors side by side, cut differently, and a half-high wall across both.
TEST(SlowContactLeakTest, MeshesThatMeetWithoutSharingVerticesHaveNoSeam) {
  Room room(/*with_floor=*/false);
  room.AddLamp({0.7f, 2.9f, 0.3f}, 10);
  room.AddQuad({-2, 0, -2}, {-2, 0, 2}, {0.1f, 0, 2}, {0.1f, 0, -2}, room.white);
  room.AddQuad({0.1f, 0, -2}, {0.1f, 0, 0.3f}, {2, 0, 0.3f}, {2, 0, -2}, room.white);
  room.AddQuad({0.1f, 0, 0.3f}, {0.1f, 0, 2}, {2, 0, 2}, {2, 0, 0.3f}, room.white);
  const uint32_t sheet =
      room.AddMaterial("sheet", Lambert{Rgb::Constant(0.5f)}, Rgb::Zero(), /*double_sided=*/true);
  room.AddQuad({-0.7f, 0, -0.5f}, {0.8f, 0, -0.5f}, {0.8f, 1, -0.5f}, {-0.7f, 1, -0.5f}, sheet);
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const Vec3 a(0.1f, 0, -0.4f), b(0.1f, 0, 2), c(-0.7f, 0, -0.5f), d(0.8f, 0, -0.5f);
  ExpectNoLeaks(room.Build(), {{"left floor", a, b, -x, y},
                               {"right floor", a, b, x, y},
                               {"floor before the wall", c, d, z, y},
                               {"floor behind the wall", c, d, -z, y},
                               {"wall's front", c, d, y, z},
                               {"wall's back", c, d, y, -z}});
}

}  // namespace
}  // namespace lobe
