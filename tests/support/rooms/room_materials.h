#pragma once

#include <string>

#include "brdf/reflectance.h"
#include "tests/support/rooms/random_choice.h"

namespace lobe::test {

/// A reflectance drawn at random, with what it is called in tables.
struct DrawnReflectance {
  Reflectance reflectance;
  std::string model;
};

/// Bounds of roughness in glTF's sense, alpha = roughness^2, whatever the model calls it.
struct RoughnessRange {
  float least = 0.02f, most = 1;
};

/// A colour whose largest channel is `brightest`, more often pale than not.
Rgb DrawColour(RandomChoice& random, float brightest);
/// Albedo to 0.95, low ones as often as high ones.
float DrawAlbedo(RandomChoice& random);

/// Any opaque model: of all alternatives of Reflectance but measured data, as often each.
DrawnReflectance DrawReflectance(RandomChoice& random, const RoughnessRange& roughness, float albedo);
/// One without gloss, or with a rough coat.
DrawnReflectance DrawMatte(RandomChoice& random, float albedo);
/// Polished: glTF's metal.
DrawnReflectance DrawMetal(RandomChoice& random, const RoughnessRange& roughness, float albedo);
/// A sheet that lets light through, scattered.
DrawnReflectance DrawTranslucent(RandomChoice& random, float albedo);
/// Clear glass: a body, or a pane.
DrawnReflectance DrawGlass(RandomChoice& random, bool body);

/// Of the gloss, in glTF's sense; 1 without gloss, 0 for mirrors and glass.
float RoughnessOf(const Reflectance& reflectance);

}  // namespace lobe::test
