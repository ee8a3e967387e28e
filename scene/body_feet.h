#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace lobe {

/// Tells the feet of bodies: faces of a closed surface that lies wholly behind them, as the underside of a
/// box does. Nobody looks at the back of such a face: it is inside the body.
class BodyFeet {
 public:
  /// Nothing is looked for before it is asked for. `scene` must outlive this.
  explicit BodyFeet(const Scene& scene) : scene_(scene) {}

  /// O(n log n) in the faces of its node when one of them is asked for first, then in the body's.
  bool IsFoot(uint32_t face);

 private:
  struct Body {
    bool closed = true;
    std::vector<uint32_t> vertices;
  };
  void FindBodies(uint32_t node);

  const Scene& scene_;
  std::vector<uint32_t> node_;                // by surface: surfaces of one node in a row
  std::vector<std::vector<uint32_t>> faces_;  // by node
  std::vector<uint32_t> body_;                // by face
  std::vector<Body> bodies_;
};

}  // namespace lobe
