#include "taut/core/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "taut/core/error.h"

namespace taut {
namespace {

TEST(ParallelFor, TellsHowManyAreDone) {
  for (const int threads : {1, 2, 0}) {
    std::vector<int> seen(1000, 0);
    std::vector<std::size_t> told;
    parallel_for(
        seen.size(), 7, threads,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k) ++seen[k];
        },
        [&](std::size_t done) { told.push_back(done); });
    EXPECT_EQ(seen, std::vector<int>(1000, 1));
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    if (threads != 1) continue;
    ASSERT_EQ(told.size(), 143U);
    EXPECT_EQ(told.back(), seen.size());
  }
}

TEST(ParallelFor, PassesOnWhatTheListenerThrows) {
  for (const int threads : {1, 2}) {
    EXPECT_THROW(parallel_for(
                     100, 1, threads, [](std::size_t, std::size_t) {},
                     [](std::size_t) { throw Cancelled(); }),
                 Cancelled);
  }
}

}  // namespace
}  // namespace taut
