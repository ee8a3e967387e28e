#include "solver/options.h"

#include <cmath>
#include <sstream>

namespace lobe {

const char* Name(Transport transport) {
  switch (transport) {
    case Transport::kShooting:
      return "shooting";
    case Transport::kLinks:
      return "links";
    case Transport::kAuto:
      return "auto";
  }
  return "";
}

std::string SolveOptions::Validate() const {
  std::ostringstream out;
  if (!(mesh.max_edge > 0) || !std::isfinite(mesh.max_edge)) {
    out << "longest edge " << mesh.max_edge << " m is out of range: a finite length above 0 is expected";
  } else if (!(mesh.crease_angle >= 0) || !(mesh.crease_angle <= 3.15f)) {
    out << "crease angle " << mesh.crease_angle << " is out of range: 0 to pi radians is expected";
  } else if (!(mesh.border_inset >= 0) || !(mesh.border_inset <= 1)) {
    out << "border inset " << mesh.border_inset << " is out of range: 0 to 1 is expected";
  } else if (!(refine.error >= 0) || !(refine.error <= 10)) {
    out << "refine error " << refine.error * 100 << " % is out of range: 0 to 1000 is expected";
  } else if (!(refine.contact_error >= 0) || !(refine.contact_error <= 10)) {
    out << "contact error " << refine.contact_error * 100 << " % is out of range: 0 to 1000 is expected";
  } else if (refine.rounds < 0 || refine.rounds > 16) {
    out << "refine rounds " << refine.rounds << " is out of range: 0 to 16 is expected";
  } else if (refine.max_nodes < 1) {
    out << "max nodes " << refine.max_nodes << " is out of range: 1 or more is expected";
  } else if (!(contact_distance >= 0) || !std::isfinite(contact_distance)) {
    out << "contact distance " << contact_distance << " m is out of range: 0 or a finite length is expected";
  } else if (lobes.l_max < 0 || lobes.l_max > 32) {
    out << "lmax " << lobes.l_max << " is out of range: 0 to 32 is expected";
  } else if (lobes.force_l_max < -1 || lobes.force_l_max > 32) {
    out << "forced lmax " << lobes.force_l_max << " is out of range: 0 to 32 is expected";
  } else if (!(lobes.error > 0) || !(lobes.error <= 10)) {
    out << "lobe error " << lobes.error * 100 << " % is out of range: above 0 to 1000 is expected";
  } else if (links < 8 || links > 1'000'000) {
    out << "links " << links << " is out of range: 8 to 1000000 is expected";
  } else if (light_samples < 1 || light_samples > 1'000'000) {
    out << "light samples " << light_samples << " is out of range: 1 to 1000000 is expected";
  } else if (delta_areas < 1 || delta_areas > 1'000'000) {
    out << "delta areas " << delta_areas << " is out of range: 1 to 1000000 is expected";
  } else if (!(residual > 0) || !(residual < 1)) {
    out << "residual " << residual << " is out of range: between 0 and 1 is expected";
  } else if (!(step_fraction > 0) || !(step_fraction <= 1)) {
    out << "step fraction " << step_fraction << " is out of range: above 0 to 1 is expected";
  } else if (max_steps < 0) {
    out << "step limit " << max_steps << " is out of range: 0 or more is expected";
  } else if (!(max_seconds >= 0)) {
    out << "time limit " << max_seconds << " s is out of range: 0 or more is expected";
  }
  return out.str();
}

}  // namespace lobe
