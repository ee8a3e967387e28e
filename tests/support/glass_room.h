#pragma once

#include "scene/scene.h"
#include "tests/support/glass.h"
#include "tests/support/scene_builder.h"

namespace lobe::test {

/// The scene of tests/scenes/glass_room.glb: a small room with a lamp, a clear ball, a block of green bottle
/// glass, and a tinted pane before a picture on the back wall. GlassRoomTest writes the file anew if
/// LOBE_WRITE_SCENES names a folder, and holds the one that is there against this.
inline Scene GlassRoom() {
  SceneBuilder b;
  const uint32_t white = b.AddMaterial("white", Lambert{Rgb(0.7f, 0.7f, 0.68f)});
  const uint32_t red = b.AddMaterial("red", Lambert{Rgb(0.6f, 0.1f, 0.08f)});
  const uint32_t blue = b.AddMaterial("blue", Lambert{Rgb(0.1f, 0.2f, 0.6f)});
  const uint32_t lamp = b.AddMaterial("lamp", Lambert{Rgb::Zero()}, Rgb(14, 13, 11));
  const uint32_t clear = b.AddMaterial("clear glass", ClearGlass(1.5f));
  MetallicRoughness bottle = ClearGlass(1.52f);
  bottle.attenuation_color = Rgb(0.25f, 0.8f, 0.35f);
  bottle.attenuation_distance = 0.3f;
  const uint32_t green = b.AddMaterial("bottle glass", bottle);
  const uint32_t pane = b.AddMaterial("pane", Pane(1.5f, Rgb(0.9f, 0.8f, 0.6f)), Rgb::Zero(), true);

  b.AddQuad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, white);
  b.AddQuad({-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}, white);
  b.AddQuad({-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1}, white);
  b.AddQuad({-1, 0, 1}, {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1}, red);
  b.AddQuad({1, 0, -1}, {1, 0, 1}, {1, 2, 1}, {1, 2, -1}, blue);
  b.AddQuad({-0.3f, 1.98f, -0.3f}, {0.3f, 1.98f, -0.3f}, {0.3f, 1.98f, 0.3f}, {-0.3f, 1.98f, 0.3f}, lamp);
  b.AddSphere({-0.45f, 0.45f, 0.1f}, 0.35f, clear, 16);
  b.AddBox({0.2f, 0.02f, -0.3f}, {0.7f, 0.75f, 0.1f}, green);
  b.AddQuad({-0.7f, 0.9f, -0.96f}, {0.3f, 0.9f, -0.96f}, {0.3f, 1.6f, -0.96f}, {-0.7f, 1.6f, -0.96f}, blue);
  b.AddQuad({-0.75f, 0.8f, -0.7f}, {0.5f, 0.8f, -0.7f}, {0.5f, 1.7f, -0.7f}, {-0.75f, 1.7f, -0.7f}, pane);
  b.AddCamera("view0", {0.1f, 1.1f, 3.4f}, {0, 0.85f, 0}, Vec3::UnitY(), 0.65f);
  return b.Build();
}

}  // namespace lobe::test
