#include "render/eye_rays.h"

#include <cmath>
#include <cstring>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace lobe {
namespace {

const Camera kCamera = LookAt({1, 2, 3}, {0.5f, 0, -1}, Vec3::UnitY(), 0.8f);
constexpr int kWidth = 21, kHeight = 13;

RenderOptions Options(int samples, PixelFilter filter) {
  RenderOptions o;
  o.width = kWidth;
  o.height = kHeight;
  o.samples_per_pixel = samples;
  o.filter = filter;
  return o;
}

TEST(EyeRaysTest, PacketsHoldEveryRayOfEveryPixelOnceBitForBit) {
  for (const PixelFilter filter : {PixelFilter::kBox, PixelFilter::kBlackmanHarris}) {
    for (const int samples : {1, 4, 9, 16, 36}) {
      const CameraView view(kCamera, kWidth, kHeight);
      const EyeRays eye_rays(view, Options(samples, filter));
      const int side = eye_rays.block_side(), pixels = side * side;
      EXPECT_EQ(eye_rays.packets_per_block() * kLanes, pixels * samples);
      for (const int bx : {0, 8, 16}) {
        EyePacket packet;
        for (int k = 0; k < eye_rays.packets_per_block(); ++k) {
          eye_rays.Packet(bx, 4, k, &packet);
          for (int i = 0; i < kLanes; ++i) {
            const int p = i % pixels, s = k * (kLanes / pixels) + i / pixels;
            std::vector<Ray> rays;
            eye_rays.Append(bx + p % side, 4 + p / side, &rays);
            ASSERT_EQ(rays.size(), size_t(samples));
            const Vec3 got(packet.x[i], packet.y[i], packet.z[i]);
            EXPECT_EQ(std::memcmp(got.data(), rays[s].direction.data(), sizeof got), 0);
            EXPECT_NEAR(got.norm(), 1, 3e-7);
            EXPECT_LT((view.EyeRay(packet.film_x[i], packet.film_y[i]).direction - got).norm(), 1e-6);
          }
        }
      }
    }
  }
}

TEST(EyeRaysTest, EveryStratumOfABoxHasOneSampleAndOffsetsAreEven) {
  const CameraView view(kCamera, kWidth, kHeight);
  double sum_x = 0, sum_y = 0, product = 0;
  int count = 0;
  for (const int samples : {1, 9, 16, 100}) {
    const EyeRays eye_rays(view, Options(samples, PixelFilter::kBox));
    const int strata = int(std::lround(std::sqrt(samples))), side = eye_rays.block_side();
    for (int y = 0; y + side <= kHeight; y += side) {
      for (int x = 0; x + side <= kWidth; x += side) {
        std::set<std::vector<int>> seen;
        EyePacket packet;
        for (int k = 0; k < eye_rays.packets_per_block(); ++k) {
          eye_rays.Packet(x, y, k, &packet);
          for (int i = 0; i < kLanes; ++i) {
            const float fx = packet.film_x[i], fy = packet.film_y[i];
            const int p = i % (side * side);
            EXPECT_EQ(int(fx), x + p % side);
            EXPECT_EQ(int(fy), y + p / side);
            seen.insert({int(fx * strata), int(fy * strata)});
            const double u = fx * strata - std::floor(fx * strata) - 0.5,
                         v = fy * strata - std::floor(fy * strata) - 0.5;
            sum_x += u;
            sum_y += v;
            product += u * v;
            ++count;
          }
        }
        EXPECT_EQ(seen.size(), size_t(side) * side * samples);
      }
    }
  }
  // Standard deviations: 1 / sqrt(12 n) of a mean, 1 / (12 sqrt(n)) of a mean product. Four of them.
  const double n = count;
  EXPECT_LT(std::abs(sum_x / n), 4 / std::sqrt(12 * n));
  EXPECT_LT(std::abs(sum_y / n), 4 / std::sqrt(12 * n));
  EXPECT_LT(std::abs(product / n), 4 / (12 * std::sqrt(n))) << "the two coordinates are independent";
}

TEST(EyeRaysTest, SeedsGiveOtherRays) {
  const CameraView view(kCamera, kWidth, kHeight);
  RenderOptions o = Options(4, PixelFilter::kBox);
  EyePacket a, b;
  EyeRays(view, o).Packet(4, 4, 0, &a);
  o.seed = 2;
  EyeRays(view, o).Packet(4, 4, 0, &b);
  for (int i = 0; i < kLanes; ++i) EXPECT_NE(a.film_x[i], b.film_x[i]);
}

}  // namespace
}  // namespace lobe
