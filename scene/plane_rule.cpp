#include "scene/plane_rule.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace lobe {

namespace {

Sides Turned(Sides sides) { return Sides((sides & kFrontSide) << 1 | sides >> 1); }

/// Of a pane or a translucent sheet: light that goes in on one side comes out of the other.
bool IsWholeOnly(const Material& material) { return material.transmits() || material.glass(); }

}  // namespace

Sides SidesOf(const Material& material) {
  return material.double_sided || material.glass() ? kBothSides : kFrontSide;
}

PlaneRule::PlaneRule(const Scene& scene) : scene_(scene), feet_(scene) {
  shown_.reserve(scene.faces.size());
  for (const Face& face : scene.faces) shown_.push_back(SidesOf(scene.material(face)));
}

bool PlaneRule::IsFoot(uint32_t face) {
  const auto [known, is_new] = is_foot_.try_emplace(face);
  if (is_new) known->second = feet_.IsFoot(face);
  return known->second;
}

bool PlaneRule::Opposite(uint32_t f, uint32_t g) const {
  return scene_.GeometricNormal(scene_.faces[f]).dot(scene_.GeometricNormal(scene_.faces[g])) < 0;
}

/// Sides of `f` where `g` may be seen, too.
Sides PlaneRule::InQuestion(uint32_t f, uint32_t g) {
  const Face &a = scene_.faces[f], &b = scene_.faces[g];
  const bool opposite = Opposite(f, g);
  if (scene_.material(a).body() || scene_.material(b).body()) {
    return !opposite && a.material == b.material ? Sides(shown_[f] & shown_[g]) : kNoSide;
  }
  if (!opposite) return Sides(shown_[f] & shown_[g]);
  Sides both = Sides(shown_[f] & Turned(shown_[g]));
  if (both & kBackSide && IsFoot(f)) both = Sides(both & kFrontSide);
  if (both & kFrontSide && IsFoot(g)) both = Sides(both & kBackSide);
  return both;
}

bool PlaneRule::Meet(uint32_t f, uint32_t g) {
  if (InQuestion(f, g)) return true;
  const auto is_body = [&](uint32_t i) { return scene_.material(scene_.faces[i]).body(); };
  return !is_body(f) && !is_body(g) && !IsFoot(f) && !IsFoot(g);
}

/// Is `face` the foot of a body on a sheet seen from both sides?
bool PlaneRule::StandsOnSheet(uint32_t face, const std::vector<uint32_t>& others) {
  if (!IsFoot(face)) return false;
  return std::any_of(others.begin(), others.end(), [&](uint32_t g) {
    return shown_[g] == kBothSides && Opposite(face, g) && InQuestion(face, g) && !IsFoot(g);
  });
}

std::vector<PlaneRule::Choice> PlaneRule::Choose(const std::vector<uint32_t>& faces) {
  struct Rank {
    bool stands, emits;
    uint32_t face;
    auto key() const { return std::tuple(!stands, emits, face); }
  };
  std::vector<Rank> ranks;
  for (const uint32_t f : faces) {
    ranks.push_back({StandsOnSheet(f, faces), scene_.material(scene_.faces[f]).emits(), f});
  }
  std::sort(ranks.begin(), ranks.end(), [](const Rank& a, const Rank& b) { return a.key() > b.key(); });
  std::vector<Choice> choices;
  std::vector<size_t> seen;  // of them
  for (const auto& [stands, emits, f] : ranks) {
    Choice choice = {f, shown_[f], {}};
    for (const size_t i : seen) {
      const auto& [other, sides, unused] = choices[i];
      if (!InQuestion(f, other)) continue;
      const Sides covered = Sides(shown_[f] & (Opposite(f, other) ? Turned(sides) : sides));
      if (!covered) continue;
      choice.sides = IsWholeOnly(scene_.material(scene_.faces[f])) ? kNoSide : Sides(choice.sides & ~covered);
      if (!stands) choice.under.push_back(other);
    }
    if (choice.sides) seen.push_back(choices.size());
    choices.push_back(std::move(choice));
  }
  return choices;
}

}  // namespace lobe
