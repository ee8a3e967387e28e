#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <boost/math/distributions/students_t.hpp>

#include "render/image.h"
#include "render/png.h"
#include "tests/support/significance.h"

namespace lobe::test {

/// Two independent pictures of one kind (c, d) against two of another (a, b): the difference of their means
/// in every 8 x 8 block over its standard error, channel by channel, unmasked pixels only.
///
/// Pixels of one picture are independent, so the errors come from c - d and a - b pixel by pixel: a
/// block's variance has as many degrees of freedom as it has pixels, and its score is about Student's t of
/// Welch and Satterthwaite's. Paths have long tails: a block that missed its rare bright samples is too dark
/// and thinks itself too certain. So its variance is the larger of its own and the mean of those around it.
class BlockZScores {
 public:
  double worst = 0;                                ///< largest score, as that of a normal variable
  double bound = 0;                                ///< Sidak's at 1 % among all blocks and channels
  int worst_x = 0, worst_y = 0;                    ///< its block
  int blocks = 0;                                  ///< those with 16 unmasked pixels or more
  double rms = 0;                                  ///< of all scores: about 1 if the errors are as stated
  double mean_error = 0, mean_standard_error = 0;  ///< of the whole picture, relative
  double relative_error = 0;  ///< typical standard error of a block, relative to the picture's mean

  BlockZScores(const Image& c, const Image& d, const Image& a, const Image& b, const Mask& mask)
      : across_((a.width + kSide - 1) / kSide), down_((a.height + kSide - 1) / kSide) {
    double total = 0, total_variance = 0, reference = 0, block_variance = 0, sum2 = 0;
    long pixels = 0, scores = 0;
    for (int channel = 0; channel < 3; ++channel) {
      blocks_.assign(size_t(across_) * down_, {});
      for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
          if (mask.set[size_t(y) * mask.width + x]) continue;
          Block& block = blocks_[size_t(y / kSide) * across_ + x / kSide];
          const double pc = c.at(x, y)[channel], pd = d.at(x, y)[channel], pa = a.at(x, y)[channel],
                       pb = b.at(x, y)[channel];
          block.off += 0.5 * (pc + pd - pa - pb);
          block.ours += 0.25 * (pc - pd) * (pc - pd);
          block.theirs += 0.25 * (pa - pb) * (pa - pb);
          block.count += 1;
          reference += 0.5 * (pa + pb);
          ++pixels;
        }
      }
      for (int y = 0; y < down_; ++y) {
        for (int x = 0; x < across_; ++x) {
          const Block& block = blocks_[size_t(y) * across_ + x];
          total += block.off;
          total_variance += block.ours + block.theirs;
          if (block.count < kLeastPixels) continue;
          const double z = Score(x, y);
          block_variance += (block.ours + block.theirs) / (block.count * block.count);
          sum2 += z * z;
          ++scores;
          if (z > worst) worst = z, worst_x = x, worst_y = y;
        }
      }
    }
    blocks = int(scores / 3);
    bound = SidakQuantile(0.01, double(scores));
    rms = std::sqrt(sum2 / double(scores));
    mean_error = total / reference;
    mean_standard_error = std::sqrt(3 * total_variance) / reference;  // channels may err together
    relative_error = std::sqrt(block_variance / double(scores)) / (reference / double(pixels));
  }

 private:
  static constexpr int kSide = 8;
  static constexpr double kLeastPixels = 16;
  struct Block {
    double off = 0, ours = 0, theirs = 0, count = 0;  // sums over pixels
  };

  double Score(int x, int y) const {
    const Block& block = blocks_[size_t(y) * across_ + x];
    double ours = 0, theirs = 0, count = 0;
    for (int v = std::max(y - 1, 0); v < std::min(y + 2, down_); ++v) {
      for (int u = std::max(x - 1, 0); u < std::min(x + 2, across_); ++u) {
        const Block& other = blocks_[size_t(v) * across_ + u];
        ours += other.ours;
        theirs += other.theirs;
        count += other.count;
      }
    }
    ours = std::max(block.ours, ours * block.count / count);
    theirs = std::max(block.theirs, theirs * block.count / count);
    const double variance = ours + theirs;
    const double freedom = variance * variance / (ours * ours + theirs * theirs) * block.count;
    // Through its tail to a normal score, so that one bound serves all blocks.
    const double tail = boost::math::cdf(
        boost::math::complement(boost::math::students_t(freedom), std::abs(block.off) / std::sqrt(variance)));
    return boost::math::quantile(boost::math::complement(boost::math::normal(), std::max(tail, 1e-300)));
  }

  int across_, down_;
  std::vector<Block> blocks_;
};

}  // namespace lobe::test
