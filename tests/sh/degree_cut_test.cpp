#include "sh/degree_cut.h"

#include <gtest/gtest.h>

#include "sh/lobe.h"

namespace lobe {
namespace {

TEST(DegreeCutTest, IsChangeDegree) {
  for (const int from : {1, 2, 7, 20, 32}) {
    const Eigen::VectorXd lobe = Eigen::VectorXd::Random(CoefficientCount(from));
    const Eigen::VectorXf in = lobe.cast<float>();
    for (int to = 0; to < from; ++to) {
      Eigen::VectorXf out(CoefficientCount(to));
      DegreeCut(from, to).Apply(in.data(), out.data());
      const Eigen::VectorXd expected = ChangeDegree(in.cast<double>(), to);
      // Some hundred products of single precision.
      EXPECT_LT((out.cast<double>() - expected).cwiseAbs().maxCoeff(), 1e-5 * (1 + expected.norm()))
          << from << " to " << to;
    }
  }
}

TEST(DegreeCutTest, RefusesToRaiseADegree) {
  EXPECT_THROW(DegreeCut(4, 4), std::invalid_argument);
  EXPECT_THROW(DegreeCut(4, 5), std::invalid_argument);
  EXPECT_THROW(DegreeCut(4, -1), std::invalid_argument);
}

}  // namespace
}  // namespace lobe
