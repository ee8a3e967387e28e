#pragma once

#include "brdf/reflectance.h"

namespace lobe::test {

/// A solid body of glass: closed surfaces, fronts outside.
inline MetallicRoughness ClearGlass(float ior, const Rgb& colour = Rgb::Constant(1)) {
  MetallicRoughness m;
  m.base_color = colour;
  m.metallic = 0;
  m.roughness = 0;
  m.ior = ior;
  m.transmission = 1;
  m.thickness = 1;
  return m;
}

/// The same, coloured within: what is white is left with `colour` after `distance` metres.
inline MetallicRoughness ColouredGlass(const Rgb& colour, float distance) {
  MetallicRoughness m = ClearGlass(1.5f);
  m.attenuation_color = colour;
  m.attenuation_distance = distance;
  return m;
}

/// A thin pane; its material must be double-sided, as readers make it.
inline MetallicRoughness Pane(float ior, const Rgb& colour = Rgb::Constant(1)) {
  MetallicRoughness m = ClearGlass(ior, colour);
  m.thickness = 0;
  return m;
}

}  // namespace lobe::test
