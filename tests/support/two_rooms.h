#pragma once

#include "tests/support/scene_builder.h"

namespace lobe::test {

/// Two closed rooms side by side, a small lamp and a thing on the floor in each, and a camera in each that
/// looks past the lamp, "bright" and "dim". Neither sees the other, but all of the bright lamp lies above the
/// horizons of the dim room.
struct TwoRooms {
  Scene scene;
  uint32_t bright_walls, dim_walls, dim_thing;
};

inline TwoRooms MakeTwoRooms(float bright, float dim, bool glossy = false) {
  SceneBuilder b;
  const uint32_t wall = b.AddLambert(Rgb::Constant(0.5f));
  MetallicRoughness metal;
  metal.base_color = Rgb::Constant(0.8f);
  metal.roughness = 0.5f;
  const uint32_t thing = glossy ? b.AddMaterial("metal", metal) : wall;
  const uint32_t bright_lamp = b.AddEmitter(Rgb::Constant(bright)),
                 dim_lamp = b.AddEmitter(Rgb::Constant(dim));
  TwoRooms out;
  for (const bool first : {true, false}) {
    const float x = first ? 0.0f : 5.0f;
    const uint32_t walls = b.AddBox({x, 0, 0}, {x + 4, 3, 4}, wall, /*inward=*/true);
    const uint32_t box = b.AddBox({x + 1, 0.5f, 1}, {x + 2, 1.25f, 2}, thing);
    const float y = 2.75f;
    b.AddQuad({x + 1.5f, y, 1.5f}, {x + 2.5f, y, 1.5f}, {x + 2.5f, y, 2.5f}, {x + 1.5f, y, 2.5f},
              first ? bright_lamp : dim_lamp);
    (first ? out.bright_walls : out.dim_walls) = walls;
    out.dim_thing = box;
    b.AddCamera(first ? "bright" : "dim", {x + 3.5f, 1.5f, 3.5f}, {x + 0.5f, 0.25f, 0.5f});
  }
  out.scene = b.Build();
  return out;
}

}  // namespace lobe::test
