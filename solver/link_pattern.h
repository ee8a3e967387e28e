#pragma once

#include <cstdint>
#include <vector>

#include "brdf/frame.h"
#include "sh/vector.h"

namespace lobe {

/// Where a node's links start: `rings` circles of polar angle, each with `sectors` directions equally spaced
/// in azimuth. Rings are strata of equal cos-weighted solid angle, so every link counts pi / count.
///
/// One polar angle for a whole ring is what makes glossy receivers cheap: a ring goes into the lobe as one
/// Fourier transform over azimuth (IncidentMoments::AddRing).
struct LinkPattern {
  int rings = 0, sectors = 0;
  int count() const { return rings * sectors; }
  bool operator==(const LinkPattern&) const = default;

  /// A multiple of kThinnest, so that dim steps can use every second, fourth or eighth direction.
  static constexpr int kThinnest = 8;

  /// About `links` directions, and at least `per_coefficient` times the coefficients of a lobe of degree
  /// `l_max` (-1, 0: diffuse), or they alias into blotches. Three sectors for each ring make strata of about
  /// equal sides; orders up to l_max need more than twice as many sectors.
  static LinkPattern For(int links, int l_max, int per_coefficient);
};

/// The directions of one node. Polar angles are jittered ring by ring and azimuths turned at random, each by
/// numbers of its own (node, ring, seed), so neighbours do not share errors; expectations are exact.
class LinkDirections {
 public:
  explicit LinkDirections(const LinkPattern& pattern);
  const LinkPattern& pattern() const { return pattern_; }

  /// Turns to `node`; the calls below mean it.
  void Start(uint32_t node, uint64_t seed);
  float CosTheta(int ring) const { return cos_theta_[ring]; }
  /// Azimuth of the ring's first sector, radians.
  float Phi(int ring) const { return phi_[ring]; }
  /// All of them, ring by ring, in world space: arrays of pattern().count() coordinates.
  void World(const Frame& frame, float* x, float* y, float* z) const;
  /// In the frame of the node's shading normal.
  Vec3 Local(int ring, int sector) const {
    const float c = cos_phi_[ring] * cos_[sector] - sin_phi_[ring] * sin_[sector];
    const float s = sin_phi_[ring] * cos_[sector] + cos_phi_[ring] * sin_[sector];
    return {sin_theta_[ring] * c, sin_theta_[ring] * s, cos_theta_[ring]};
  }

 private:
  LinkPattern pattern_;
  std::vector<float> cos_, sin_;  // of the sectors, the first at 0
  std::vector<float> cos_theta_, sin_theta_, phi_, cos_phi_, sin_phi_;
};

/// The directions of every pattern met, made once. One per thread.
class DirectionsByPattern {
 public:
  /// Good until the next call.
  LinkDirections& Of(const LinkPattern& pattern) {
    for (auto& d : directions_) {
      if (d.pattern() == pattern) return d;
    }
    return directions_.emplace_back(pattern);
  }

 private:
  std::vector<LinkDirections> directions_;
};

}  // namespace lobe
