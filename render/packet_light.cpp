#include "render/packet_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "brdf/frame.h"
#include "render/film_grid.h"
#include "sh/lobe_lanes.h"
#include "sh/simd.h"

namespace lobe {
namespace {

constexpr uint32_t kPlaces = 256, kSlots = 1024;  // powers of two; about what a tile meets
constexpr int kMaxGrid = FilmGrid::kMaxPoints;

constexpr int kColumn = 4, kColumns = 16;

enum class Kind : uint32_t {
  kUnhandled,
  kLinear,  // radiance is linear in u and v
  kNodes,   // from the values of nodes
};

// What reading needs of an element, or of a whole side of a face without nodes.
struct alignas(64) Place {
  uint64_t key = ~uint64_t{0};
  uint32_t face_side = kNone;
  Kind kind = Kind::kUnhandled;
  float w0[3] = {0, 0, 0}, w1[3] = {0, 0, 0};  // factors of u, v, 1; w2 is the rest
  float linear[3][3] = {};                     // by channel, likewise
  float emission[3] = {0, 0, 0};
  uint32_t node[3] = {};              // visible ones
  uint8_t corner[3] = {}, count = 0;  // their corners
};

// A node's radiance in the points of the tile's grid.
struct alignas(64) Values {
  float at[3 * kLanes];
};

// World to a node's frame, bent to the horizon.
LOBE_SIMD_CLONES void ToLocal(const Frame& frame, float sign, const float* px, const float* py,
                              const float* pz, float* out) {
  const FloatLanes wx = sign * AsLanes(px), wy = sign * AsLanes(py), wz = sign * AsLanes(pz);
  const FloatLanes x = frame.x[0] * wx + frame.x[1] * wy + frame.x[2] * wz;
  const FloatLanes y = frame.y[0] * wx + frame.y[1] * wy + frame.y[2] * wz;
  const FloatLanes z = frame.z[0] * wx + frame.z[1] * wy + frame.z[2] * wz;
  const FloatLanes squared = x * x + y * y;
  FloatLanes length;
  for (int i = 0; i < kLanes; ++i) length[i] = std::sqrt(squared[i]);
  // Straight below has no horizon to go to: as BendToHorizon, to x.
  const FloatLanes one = FloatLanes{} + 1.0f, zero = {};
  const IntLanes below = Negative(z), aside = Different((UintLanes)squared, UintLanes{});
  const FloatLanes scale = Select(aside, 1.0f / length, zero);
  AsLanes(out) = Select(below, x * scale + Select(aside, zero, one), x);
  AsLanes(out + kLanes) = Select(below, y * scale, y);
  AsLanes(out + 2 * kLanes) = Select(below, zero, z);
}

// Lagrange's functions of n Chebyshev points: (1 + 2 sum_k T_k(s_i) T_k(s)) / n.
struct Lagrange {
  float factor[kMaxGrid][kMaxGrid][kMaxGrid];  // n - 1, i, k
  Lagrange() {
    for (int n = 1; n <= kMaxGrid; ++n) {
      for (int i = 0; i < n; ++i) {
        for (int k = 0; k < n; ++k) {
          const double t = std::cos(k * (2 * i + 1) * std::numbers::pi / (2 * n));
          factor[n - 1][i][k] = float((k == 0 ? 1 : 2) * t / n);
        }
      }
    }
  }
};
const Lagrange kLagrange;

}  // namespace

struct PacketLight::State {
  const Solution& solution;
  const ElementLocator& locator;
  const std::vector<uint8_t>& handled;
  const std::span<const uint8_t> except;
  LobeLanes lanes;
  FilmGrid grid;
  std::vector<Place> places{kPlaces};
  const Place none;
  const Place* last = &none;
  // Found last in a column of film kColumn pixels wide: the place above is looked at before one is looked up.
  const Place* above[kColumns];
  std::vector<Values> values{kSlots};
  std::vector<uint64_t> tags = std::vector<uint64_t>(kSlots, 0);  // tile and node
  std::vector<uint8_t> points = std::vector<uint8_t>(kSlots, 0);  // along an axis; 0: no grid serves
  uint64_t tile = 0;
  int points_of_degree[HemisphereBasis<float>::kMaxDegree + 1];
  double clamped = 0;
  Counts counts;

  State(const Solution& s, const ElementLocator& l, const std::vector<uint8_t>& h, std::span<const uint8_t> e)
      : solution(s), locator(l), handled(h), except(e), lanes(s.total.max_degree()) {
    Forget();
  }

  // A hit on the edge of two elements belongs to the one looked at first: that must not be one of another
  // tile, or bits would depend on which thread had which tile.
  void Forget() {
    last = &none;
    std::fill(above, above + kColumns, &none);
  }

  const Place& Find(uint32_t face_side, float u, float v);
  void Fill(const ElementLocator::Leaf& leaf, Place* place) const;
  void AddNode(uint32_t node, const float* local, float* out) const;
  uint32_t FindNode(uint32_t node);
  void ReadExactly(uint32_t node, const EyePacket& rays, float* out);
};

const Place& PacketLight::State::Find(uint32_t face_side, float u, float v) {
  ++counts.lookups;
  const Face& face = solution.scene.faces[face_side / 2];
  const bool here = handled[2 * face.material + face_side % 2];
  const ElementLocator::Leaf* leaf = here ? &locator.FindLeaf(face_side, u, v) : nullptr;
  const bool element = leaf && leaf->element != kNone;
  const uint64_t key = element ? leaf->element : uint64_t{1} << 32 | face_side;
  Place& place = places[(key ^ key >> 8) % kPlaces];
  if (place.key == key) return place;
  place = {};
  place.key = key;
  place.face_side = face_side;
  if (!here) return place;
  if (element && !except.empty() && except[leaf->element]) {
    std::copy_n(leaf->w0.data(), 3, place.w0);
    std::copy_n(leaf->w1.data(), 3, place.w1);
    return place;
  }
  place.kind = Kind::kLinear;
  const Material& material = solution.scene.materials[face.material];
  const bool front = Side(face_side % 2) == Side::kFront;
  if (!front && !material.double_sided) return place;  // black
  if (front || material.emits_behind()) std::copy_n(material.emission.data(), 3, place.emission);
  if (element) Fill(*leaf, &place);
  return place;
}

void PacketLight::State::Fill(const ElementLocator::Leaf& leaf, Place* place) const {
  std::copy_n(leaf.w0.data(), 3, place->w0);
  std::copy_n(leaf.w1.data(), 3, place->w1);
  const auto& corners = solution.mesh.elements[leaf.element];
  for (uint8_t k = 0; k < 3; ++k) {
    if (solution.hidden[corners[k]]) continue;
    place->node[place->count] = corners[k];
    place->corner[place->count++] = k;
  }
  if (place->count == 0) return;
  if (place->count < 3 || !solution.total.degrees(corners[0]).diffuse()) {
    place->kind = Kind::kNodes;
    return;
  }
  for (int k = 0; k < 3; ++k) {
    const Rgb radiance = solution.total.Radiance(corners[k], Vec3::UnitZ(), nullptr);
    for (int i = 0; i < 3; ++i) {
      const float w = k == 0   ? leaf.w0[i]
                      : k == 1 ? leaf.w1[i]
                               : (i == 2 ? 1.0f : 0.0f) - leaf.w0[i] - leaf.w1[i];
      for (int c = 0; c < 3; ++c) place->linear[c][i] += w * radiance[c];
    }
  }
}

void PacketLight::State::AddNode(uint32_t node, const float* local, float* out) const {
  const PartDegrees& d = solution.total.degrees(node);
  const float *x = local, *y = local + kLanes, *z = local + 2 * kLanes;
  if (d.base >= 0) lanes.Add(solution.total.base(node), d.base, x, y, z, out);
  if (d.gloss >= 0) lanes.Add(solution.total.gloss(node), d.gloss, x, y, z, out);
}

uint32_t PacketLight::State::FindNode(uint32_t node) {
  const uint32_t slot = (node ^ node >> 10) % kSlots;
  const uint64_t tag = tile << 32 | node;
  if (tags[slot] == tag) return slot;
  tags[slot] = tag;
  const int n = points_of_degree[std::max(0, solution.total.degrees(node).max_degree())];
  const Vec3& normal = solution.mesh.node_normal[node];
  const bool flat = solution.total.degrees(node).diffuse();
  points[slot] = n > 0 && (flat || grid.Above(normal)) ? uint8_t(n) : 0;
  if (points[slot] == 0) return slot;
  ++counts.grids;
  const FilmGrid::Directions& w = grid.directions(n);
  alignas(64) float local[3 * kLanes];
  ToLocal(Frame(normal), 1, w.x, w.y, w.z, local);
  values[slot] = {};
  AddNode(node, local, values[slot].at);
  return slot;
}

void PacketLight::State::ReadExactly(uint32_t node, const EyePacket& rays, float* out) {
  ++counts.exact_reads;
  alignas(64) float local[3 * kLanes];
  ToLocal(Frame(solution.mesh.node_normal[node]), -1, rays.x, rays.y, rays.z, local);
  std::fill_n(out, 3 * kLanes, 0.0f);
  AddNode(node, local, out);
}

namespace {

LOBE_INLINE void EvaluateLagrange(int n, const FloatLanes& s, FloatLanes* out) {
  const FloatLanes t2 = 2 * s * s - 1, t3 = (2 * t2 - 1) * s;
  for (int i = 0; i < n; ++i) {
    const float* f = kLagrange.factor[n - 1][i];
    out[i] = FloatLanes{} + f[0];
    if (n > 1) out[i] += f[1] * s;
    if (n > 2) out[i] += f[2] * t2;
    if (n > 3) out[i] += f[3] * t3;
  }
}

// The loop of PacketLight::Read. `State` is a parameter because it is private.
template <typename State>
LOBE_INLINE uint32_t ReadLanes(State& state, const EyePacket& rays, const PacketHits& hits, uint32_t lanes,
                               float* radiance) {
  const UintLanes face_side = AsLanes(hits.face_side);
  const FloatLanes u = AsLanes(hits.u), v = AsLanes(hits.v), zero = {};
  FloatLanes out[3] = {zero, zero, zero}, clamped = {};
  FloatLanes basis[kMaxGrid * kMaxGrid];
  int basis_points = 0;
  uint32_t left = lanes & SignBits(Different(face_side, UintLanes{} + kNone)), unhandled = 0;
  const Place* place = state.last;
  while (left != 0) {
    FloatLanes w[3];
    const auto inside = [&] {
      w[0] = place->w0[0] * u + place->w0[1] * v + place->w0[2];
      w[1] = place->w1[0] * u + place->w1[1] * v + place->w1[2];
      w[2] = 1 - w[0] - w[1];
      return left & ~SignBits(Different(face_side, UintLanes{} + place->face_side) | (IntLanes)w[0] |
                              (IntLanes)w[1] | (IntLanes)w[2]);
    };
    uint32_t taken = inside();
    if (taken == 0) {
      const int first = std::countr_zero(left);
      const Place*& above = state.above[uint32_t(int(rays.film_x[first])) / kColumn % kColumns];
      place = above;
      taken = inside();
      if ((taken >> first & 1) == 0) {
        place = above = &state.Find(hits.face_side[first], hits.u[first], hits.v[first]);
        taken = inside() | 1u << first;  // that one may lie a rounding error outside
      }
    }
    left &= ~taken;
    if (place->kind == Kind::kUnhandled) {
      unhandled |= taken;
      continue;
    }

    FloatLanes stored[3] = {zero, zero, zero};
    if (place->kind == Kind::kLinear) {
      for (int c = 0; c < 3; ++c) {
        stored[c] = place->linear[c][0] * u + place->linear[c][1] * v + place->linear[c][2];
      }
    } else {
      FloatLanes sum = zero;
      for (int k = 0; k < place->count; ++k) sum += w[place->corner[k]];
      for (int k = 0; k < place->count; ++k) {
        FloatLanes weight = w[place->corner[k]];
        if (place->count < 3) {
          const FloatLanes even = zero + 1.0f / float(place->count);
          weight = Select(Negative(1e-6f - sum), weight / sum, even);
        }
        const uint32_t slot = state.FindNode(place->node[k]);
        const int n = state.points[slot];
        if (n == 0) {
          alignas(64) float exact[3 * kLanes];
          state.ReadExactly(place->node[k], rays, exact);
          for (int c = 0; c < 3; ++c) stored[c] += weight * AsLanes(exact + c * kLanes);
          continue;
        }
        if (n != basis_points) {
          basis_points = n;
          FloatLanes along_x[kMaxGrid], along_y[kMaxGrid];
          const FilmGrid& grid = state.grid;
          EvaluateLagrange(n, (AsLanes(rays.film_x) - grid.centre_x()) * grid.scale_x(), along_x);
          EvaluateLagrange(n, (AsLanes(rays.film_y) - grid.centre_y()) * grid.scale_y(), along_y);
          for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) basis[j * n + i] = along_x[i] * along_y[j];
          }
        }
        const float* at = state.values[slot].at;
        FloatLanes value[3] = {zero, zero, zero};
        for (int g = 0; g < n * n; ++g) {
          for (int c = 0; c < 3; ++c) value[c] += at[c * kLanes + g] * basis[g];
        }
        for (int c = 0; c < 3; ++c) stored[c] += weight * value[c];
      }
    }
    const IntLanes here = LanesOfBits(taken);
    for (int c = 0; c < 3; ++c) {
      const FloatLanes shown = Select(Negative(stored[c]), zero, stored[c]);
      clamped += Select(here, shown - stored[c], zero);
      out[c] = Select(here, shown + place->emission[c], out[c]);
    }
  }
  state.last = place;
  for (int c = 0; c < 3; ++c) AsLanes(radiance + c * kLanes) = out[c];
  if (SignBits(-(IntLanes)clamped) != 0) {
    for (int i = 0; i < kLanes; ++i) state.clamped += clamped[i];
  }
  return unhandled;
}

}  // namespace

PacketLight::PacketLight(const Solution& solution, const ElementLocator& locator,
                         const std::vector<uint8_t>& handled, std::span<const uint8_t> except)
    : state_(std::make_unique<State>(solution, locator, handled, except)) {}
PacketLight::~PacketLight() = default;
PacketLight::PacketLight(PacketLight&&) noexcept = default;

void PacketLight::Start(const CameraView::Film& film, float x0, float y0, float x1, float y1) {
  ++state_->tile;
  state_->Forget();
  state_->grid.Start(film, x0, y0, x1, y1);
  for (int l = 0; l <= state_->lanes.l_max(); ++l) {
    state_->points_of_degree[l] = FilmGrid::Points(l, state_->grid.rho());
  }
}

LOBE_SIMD_CLONES uint32_t PacketLight::Read(const EyePacket& rays, const PacketHits& hits, uint32_t lanes,
                                            float* radiance) {
  return ReadLanes(*state_, rays, hits, lanes, radiance);
}

double PacketLight::TakeClamped() {
  const double out = state_->clamped;
  state_->clamped = 0;
  return out;
}

const PacketLight::Counts& PacketLight::counts() const { return state_->counts; }

}  // namespace lobe
