#pragma once

#include "brdf/reflectance.h"

namespace lobe::test {

/// glTF's metal; an ideal mirror if its roughness is 0.
inline MetallicRoughness Metal(float roughness, const Rgb& colour = Rgb::Constant(1)) {
  MetallicRoughness m;
  m.base_color = colour;
  m.roughness = roughness;
  return m;
}

}  // namespace lobe::test
