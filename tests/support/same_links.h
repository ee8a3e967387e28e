#pragma once

#include <algorithm>

#include <gtest/gtest.h>

#include "solver/links.h"

namespace lobe::test {

/// Equal in every link and hop of `nodes` nodes.
inline void ExpectSameLinks(const Links& a, const Links& b, size_t nodes) {
  EXPECT_EQ(a.hidden(), b.hidden());
  EXPECT_EQ(a.rays(), b.rays());
  EXPECT_EQ(a.bytes(), b.bytes());
  for (uint32_t n = 0; n < nodes; ++n) {
    const auto x = a.of(n), y = b.of(n);
    ASSERT_TRUE(std::equal(x.begin(), x.end(), y.begin(), y.end()));
    for (const uint32_t link : x) {
      if (!Links::IsChain(link)) continue;
      const Links::Hop *p = a.chain(link), *q = b.chain(link);
      for (;; ++p, ++q) {
        ASSERT_EQ(p->node, q->node);
        ASSERT_EQ(p->direction, q->direction);
        ASSERT_TRUE((p->Throughput() == q->Throughput()).all());
        ASSERT_EQ(p->last, q->last);
        if (p->last) break;
      }
    }
  }
}

}  // namespace lobe::test
