#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "scene/body_feet.h"
#include "scene/scene.h"

namespace lobe {

/// Sides of a face, bits.
enum Sides : uint8_t { kNoSide = 0, kFrontSide = 1, kBackSide = 2, kBothSides = 3 };

/// Those that are no black back.
Sides SidesOf(const Material& material);

/// The rule for faces in one plane: which of them is seen, and from where. On each side the emitter is seen,
/// else the later in the file. Glass and translucent sheets are seen from both sides or not at all.
///
/// The back of a body's foot is inside the body. So a foot and a single-sided face that it stands on do not
/// compete, and a double-sided one is seen instead of the foot, whatever the order. Surfaces of solid glass
/// compete only with the same glass that faces the same way.
class PlaneRule {
 public:
  explicit PlaneRule(const Scene& scene);

  /// Sides of a face that may be seen; to begin with those of its material.
  Sides shown(uint32_t face) const { return shown_[face]; }
  void Show(uint32_t face, Sides sides) { shown_[face] = sides; }

  bool Opposite(uint32_t f, uint32_t g) const;
  /// Have they to do with each other: both may be seen from one side, or each from its own?
  bool Meet(uint32_t f, uint32_t g);

  /// What is seen of a face among others.
  struct Choice {
    uint32_t face;
    Sides sides;
    std::vector<uint32_t> under;  ///< faces that are seen in its place; none for a foot, as nothing is amiss
  };
  /// For faces that share one place; what comes first in the rule comes first.
  std::vector<Choice> Choose(const std::vector<uint32_t>& faces);

 private:
  bool IsFoot(uint32_t face);
  bool StandsOnSheet(uint32_t face, const std::vector<uint32_t>& others);
  Sides InQuestion(uint32_t f, uint32_t g);

  const Scene& scene_;
  BodyFeet feet_;
  std::map<uint32_t, bool> is_foot_;
  std::vector<Sides> shown_;
};

}  // namespace lobe
