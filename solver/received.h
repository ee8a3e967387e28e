#pragma once

#include <cstdint>

#include "brdf/rgb.h"

namespace lobe {

/// What a receiver got of one step, for the ledger (W m^-2) and for counting work.
struct Received {
  Rgb delivered = Rgb::Zero(), absorbed = Rgb::Zero(), mirrored = Rgb::Zero();
  Rgb reflected = Rgb::Zero();  ///< by albedo, angle by angle; the lobes' flux should equal it
  Rgb through = Rgb::Zero();    ///< leaves the other side of a translucent sheet
  uint64_t rays = 0;
  uint64_t lobe_reads = 0, lobe_writes = 0;  ///< directional evaluations and accumulations

  Received& operator+=(const Received& other);
};

inline Received& Received::operator+=(const Received& other) {
  delivered += other.delivered;
  absorbed += other.absorbed;
  mirrored += other.mirrored;
  reflected += other.reflected;
  through += other.through;
  rays += other.rays;
  lobe_reads += other.lobe_reads;
  lobe_writes += other.lobe_writes;
  return *this;
}

}  // namespace lobe
