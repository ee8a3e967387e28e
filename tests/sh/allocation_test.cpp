#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "sh/hemisphere_basis.h"
#include "sh/lobe.h"

namespace {
std::atomic<size_t> allocations{0};
}

// Every allocation of this program passes here, so that a test can count them.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace lobe {
namespace {

TEST(AllocationTest, EvaluatingTheBasisOrALobeNeverAllocates) {
  const HemisphereBasis<float> single(64);
  const HemisphereBasis<double> exact(1000);
  std::vector<float> a(single.size()), batch(size_t(20) * single.size()), x(20, 0.6f), y(20, 0.0f),
      z(20, 0.8f);
  std::vector<double> b(exact.size());
  const size_t before = allocations;
  single.Evaluate(0.6f, 0.0f, 0.8f, a.data());
  exact.Evaluate(0.6, 0.0, 0.8, b.data());
  single.EvaluateBatch(x.data(), y.data(), z.data(), 20, batch.data());
  const float dot = Dot(a.data(), batch.data(), single.size());
  EXPECT_EQ(allocations, before);
  EXPECT_NE(dot, 0);
  const std::vector<int> one(1);
  EXPECT_GT(allocations, before) << "the counter counts";
}

}  // namespace
}  // namespace lobe
