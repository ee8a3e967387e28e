#include "solver/link_resolution.h"

#include <algorithm>
#include <cmath>

#include "sh/hemisphere_basis.h"
#include "solver/links.h"

namespace lobe {
namespace {

// Loops of all but the brightest metals decay with so many; more would blur them for nothing
// (docs/validation.md#link-resolution).
constexpr double kMostLinksPerCoefficient = 40;

constexpr double kMostAlbedo = 0.999;

}  // namespace

int ResolvedDegree(const MaterialLobes& material, int links) {
  const double a = std::clamp(double(material.HemisphericalAlbedo().maxCoeff()), 0.0, kMostAlbedo);
  const double links_per_coefficient = std::min(kMostLinksPerCoefficient, std::pow(2 * a / (1 - a), 2));
  int degree = 0;
  while (degree < material.max_degree() &&
         CoefficientCount(degree + 1) * links_per_coefficient <= Links::PatternOf(material, links).count()) {
    ++degree;
  }
  return degree;
}

std::vector<int> SentDegrees(const Mesh& mesh, const std::vector<MaterialLobes>& materials, int links,
                             int step, int cap) {
  std::vector<int> of_material;
  for (const MaterialLobes& m : materials) {
    const int most = m.diffuse() ? 0 : step > 1 ? ResolvedDegree(m, links) : m.max_degree();
    of_material.push_back(std::min(cap, most));
  }
  std::vector<int> degrees;
  for (const auto& patch : mesh.patches) degrees.push_back(of_material[patch.material]);
  return degrees;
}

}  // namespace lobe
