#include "brdf/measured_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "brdf/lobe_table.h"

namespace lobe {
namespace {

constexpr double kPi = std::numbers::pi;

// Edge of ring k of `rings`: 90 degrees (k / rings)^2.
double RingEdge(int k, int rings) { return 0.5 * kPi * k * k / (double(rings) * rings); }

// (1 - cos) / 2, in which area on the sphere is uniform.
double HalfVersine(double theta) {
  const double s = std::sin(0.5 * theta);
  return s * s;
}

// Index of the step of a running sum (last entry 1) that holds u, and u's place within that step.
std::pair<int, float> Pick(const float* sum, int count, float u) {
  const int i = std::min(int(std::upper_bound(sum, sum + count, u) - sum), count - 1);
  const float low = i > 0 ? sum[i - 1] : 0, step = sum[i] - low;
  return {i, step > 0 ? std::clamp((u - low) / step, 0.0f, 1.0f) : 0.5f};
}

// Turns `chances` into running sums that end at 1 and returns their sum.
double RunningSums(const std::vector<double>& chances, float* out) {
  double total = 0, sum = 0;
  for (const double c : chances) total += c;
  for (size_t i = 0; i < chances.size(); ++i) {
    sum += chances[i];
    out[i] = total > 0 ? float(sum / total) : float(i + 1) / float(chances.size());
  }
  out[chances.size() - 1] = 1;
  return total;
}

}  // namespace

int MeasuredSampler::AngleRange(float cos_o) {
  const float t = IncidenceSpline::ParameterOfCosine(std::clamp(cos_o, 0.0f, 1.0f));
  return std::min(int(t * kAngles), kAngles - 1);
}

void MeasuredSampler::Tabulate() const {
  ring_sum_.resize(size_t(kAngles) * kPolar);
  sector_sum_.resize(size_t(kAngles) * kPolar * kAzimuth);
  density_.resize(sector_sum_.size());
  constexpr int kSide = 3;  // points a cell and direction
  const auto tabulate_angle = [&](int angle) {
    const double cos_o = IncidenceSpline::CosineOfParameter((angle + 0.5) / kAngles);
    const Vec3d wo(std::sqrt(1 - cos_o * cos_o), 0, cos_o);
    std::vector<double> rings(kPolar), sectors(kAzimuth), cells(size_t(kPolar) * kAzimuth);
    for (int ring = 0; ring < kPolar; ++ring) {
      const double low = HalfVersine(RingEdge(ring, kPolar)), high = HalfVersine(RingEdge(ring + 1, kPolar));
      // Of both sides together: 2 pi (1 - cos) over kAzimuth.
      const double solid_angle = 4 * kPi * (high - low) / kAzimuth;
      for (int sector = 0; sector < kAzimuth; ++sector) {
        // Mean and largest value, half each: cells that the horizon cuts, or that a peak shares with little
        // else, are drawn too often rather than too seldom, so that weights stay small.
        double sum = 0, most = 0;
        for (int k = 0; k < kSide * kSide; ++k) {
          const double v = low + (high - low) * (k / kSide + 0.5) / kSide;
          const double phi = kPi * (sector + (k % kSide + 0.5) / kSide) / kAzimuth;
          const double sine = 2 * std::sqrt(v * (1 - v));
          const Vec3d h(sine * std::cos(phi), sine * std::sin(phi), 1 - 2 * v);
          const double cos_d = wo.dot(h);
          const Vec3d wi = 2 * cos_d * h - wo;
          if (!(cos_d > 0 && wi.z() > 0)) continue;
          const double value = data_->Value(wi, wo).mean() * wi.z() * 4 * cos_d;
          sum += value;
          most = std::max(most, value);
        }
        const double density = 0.5 * (sum / (kSide * kSide) + most);
        sectors[sector] = density * solid_angle;
        cells[size_t(ring) * kAzimuth + sector] = density;
      }
      rings[ring] = RunningSums(sectors, &sector_sum_[(size_t(angle) * kPolar + ring) * kAzimuth]);
    }
    const double total = RunningSums(rings, &ring_sum_[size_t(angle) * kPolar]);
    for (size_t i = 0; i < cells.size(); ++i) {
      // A surface black at this angle: half vectors uniform over ring numbers, which RunningSums does too.
      const int ring = int(i) / kAzimuth;
      const double area =
          4 * kPi * (HalfVersine(RingEdge(ring + 1, kPolar)) - HalfVersine(RingEdge(ring, kPolar)));
      density_[size_t(angle) * cells.size() + i] =
          float(total > 0 ? cells[i] / total : 1.0 / (kPolar * area));
    }
  };
  // Isolated, or a thread that waits for its angles would take up a task that waits for all of them.
  tbb::this_task_arena::isolate([&] { tbb::parallel_for(0, kAngles, tabulate_angle); });
}

Vec3 MeasuredSampler::Sample(const Vec3& wo, float u1, float u2, float u3) const {
  std::call_once(tabulated_, [this] { Tabulate(); });
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  if (u3 < kCosineShare) {
    const float r = std::sqrt(u1), phi = kTurn * u2;
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u1)};
  }
  const int angle = AngleRange(wo.z());
  const auto [ring, across] = Pick(&ring_sum_[size_t(angle) * kPolar], kPolar, u1);
  const bool other_side = u2 >= 0.5f;
  const auto [sector, along] = Pick(&sector_sum_[(size_t(angle) * kPolar + ring) * kAzimuth], kAzimuth,
                                    other_side ? 2 * u2 - 1 : 2 * u2);
  const float low = float(HalfVersine(RingEdge(ring, kPolar)));
  const float high = float(HalfVersine(RingEdge(ring + 1, kPolar)));
  const float v = low + (high - low) * across;
  const float phi = 0.5f * kTurn * (float(sector) + along) / kAzimuth * (other_side ? -1.0f : 1.0f);
  const float sine = 2 * std::sqrt(v * (1 - v));
  const float s = std::hypot(wo.x(), wo.y());
  const float cx = s > 0 ? wo.x() / s : 1, cy = s > 0 ? wo.y() / s : 0;  // wo's azimuth
  const float x = sine * std::cos(phi), y = sine * std::sin(phi);
  const Vec3 h(x * cx - y * cy, x * cy + y * cx, 1 - 2 * v);
  return (2 * wo.dot(h) * h - wo).normalized();
}

float MeasuredSampler::Pdf(const Vec3& wo, const Vec3& wi) const {
  std::call_once(tabulated_, [this] { Tabulate(); });
  constexpr float kPiF = std::numbers::pi_v<float>;
  const Vec3 sum = wo + wi;
  const float theta = std::atan2(std::hypot(sum.x(), sum.y()), sum.z());
  const int ring = std::min(int(std::sqrt(theta / (0.5f * kPiF)) * kPolar), kPolar - 1);
  const float s = std::hypot(wo.x(), wo.y());
  const float cx = s > 0 ? wo.x() / s : 1, cy = s > 0 ? wo.y() / s : 0;
  const float phi = std::atan2(std::abs(sum.y() * cx - sum.x() * cy), sum.x() * cx + sum.y() * cy);
  const int sector = std::min(int(phi / kPiF * kAzimuth), kAzimuth - 1);
  const float density = density_[(size_t(AngleRange(wo.z())) * kPolar + ring) * kAzimuth + sector];
  return kCosineShare * wi.z() / kPiF + (1 - kCosineShare) * density / (2 * sum.norm());  // 4 wo.h = 2 |sum|
}

}  // namespace lobe
