#include "scene/precision.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

namespace lobe {
namespace {

// Of coordinates: rays are lifted by four of them (scene/ray_tracer.cpp), so that on a triangle eight of them
// high light is gathered half a height above it. (chosen)
constexpr double kSteps = 8;

// A surface's finest triangle and its largest coordinate.
struct Fineness {
  size_t faces = 0, too_fine = 0;
  double finest = std::numeric_limits<double>::infinity();  // edge or height, metres
  double farthest = 0;
};

// Shortest edge or height: a triangle is no higher than its shortest edge is long.
double Height(const std::array<Vec3, 3>& p) {
  const Vec3d a = (p[1].cast<double>() - p[0].cast<double>()),
              b = (p[2].cast<double>() - p[0].cast<double>());
  const double longest = std::max({a.norm(), b.norm(), (a - b).norm()});
  return longest > 0 ? a.cross(b).norm() / longest : 0;
}

double StepOf(double coordinate) { return std::ldexp(coordinate, -23); }

}  // namespace

void WarnOfLostPrecision(Scene* scene, double contact_distance) {
  std::vector<Fineness> surfaces(scene->surface_names.size());
  double farthest = 0;
  for (const Face& face : scene->faces) {
    const auto corners = scene->Corners(face);
    Fineness& surface = surfaces[face.surface];
    double coordinate = 0;
    for (const Vec3& p : corners) coordinate = std::max(coordinate, double(p.cwiseAbs().maxCoeff()));
    const double height = Height(corners);
    ++surface.faces;
    surface.farthest = std::max(surface.farthest, coordinate);
    farthest = std::max(farthest, coordinate);
    if (height >= kSteps * StepOf(coordinate)) continue;
    ++surface.too_fine;
    surface.finest = std::min(surface.finest, height);
  }
  for (size_t s = 0; s < surfaces.size(); ++s) {
    const Fineness& surface = surfaces[s];
    if (surface.too_fine == 0) continue;
    std::ostringstream words;
    words.precision(2);
    words << "surface '" << scene->surface_names[s] << "': " << surface.too_fine << " of " << surface.faces
          << (surface.faces == 1 ? " triangle is" : " triangles are") << " as thin as " << surface.finest
          << " m, but coordinates up to " << surface.farthest << " m from the origin come in steps of "
          << StepOf(surface.farthest)
          << " m; light there is made of rounding: move the scene nearer to the origin, or leave such "
             "triangles "
             "out";
    scene->warnings.push_back(words.str());
  }
  // As in scene/contacts.cpp: faces closer than eight steps cannot be told from faces that touch.
  if (contact_distance > 0 && kSteps * StepOf(farthest) > contact_distance) {
    std::ostringstream words;
    words.precision(2);
    words << "coordinates up to " << farthest << " m from the origin come in steps of " << StepOf(farthest)
          << " m: faces that are up to " << kSteps * StepOf(farthest) << " m apart, instead of "
          << contact_distance << " m, count as touching, and shadows between them are lost";
    scene->warnings.push_back(words.str());
  }
}

}  // namespace lobe
