#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "solver/solver.h"
#include "tests/support/scene_builder.h"

namespace lobe::test {

/// A convex glossy block in a black room whose walls emit 1: by reciprocity each node's lobe is the block's
/// directional albedo a(wo).
struct GlossFurnace {
  double stated = 0;  ///< flux-weighted error of the material's lobe table
  double worst = 0;   ///< of the nodes: cos-weighted relative L2 difference of lobe and albedo

  explicit GlossFurnace(const Reflectance& reflectance) {
    SceneBuilder b;
    b.AddBox({-2, -2, -2}, {2, 2, 2}, b.AddEmitter(Rgb::Constant(1)), true);
    const uint32_t block = b.AddMaterial("block", reflectance);
    b.AddBox({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, block);
    SolveOptions o;
    o.mesh.max_edge = 0.8f;
    o.light_samples = 512;
    const Solution s = Solve(b.Build(), o);
    TableCache cache;
    const MaterialLobes material(reflectance, o.lobes, cache);
    stated = std::max(material.gloss.error.total, material.base.error.total);
    std::vector<float> basis(kMaxBasisSize);
    for (uint32_t n = 0; n < s.mesh.node_count(); ++n) {
      if (s.mesh.patches[s.mesh.node_patch[n]].material != block) continue;
      double error2 = 0, norm2 = 0;
      for (int i = 0; i < 32; ++i) {
        for (int j = 0; j < 8; ++j) {
          // Equal areas of the projected disc: cosine-weighted.
          const double rho = std::sqrt((i + 0.5) / 32), phi = 2 * std::numbers::pi * (j + 0.5) / 8;
          const Vec3 wo(float(rho * std::cos(phi)), float(rho * std::sin(phi)),
                        float(std::sqrt(1 - rho * rho)));
          const double a = material.Albedo(wo.z())[0], off = s.total.Radiance(n, wo, basis.data())[0] - a;
          error2 += off * off;
          norm2 += a * a;
        }
      }
      worst = std::max(worst, std::sqrt(error2 / norm2));
    }
  }
};

}  // namespace lobe::test
