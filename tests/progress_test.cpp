// Steps of the exact hull and of cages report shares that rise to one.

#include "taut/core/progress.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "cages.h"
#include "models.h"
#include "taut/hull/precise_hull.h"
#include "taut/subdivision/limit_patches.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and cages

/// The shares that each step reports, from where it begins last.
class Shares {
 public:
  Progress progress() {
    Progress progress;
    progress.report = [this](std::string_view step, double share) {
      std::vector<double>& own = shares_[std::string(step)];
      EXPECT_TRUE(share >= 0 && share <= 1) << step << " " << share;
      if (!own.empty() && share < own.back()) {
        EXPECT_EQ(share, 0) << step << " falls from " << own.back();
        own.clear();
      }
      own.push_back(share);
    };
    return progress;
  }
  /// It rises to one, by way of other shares.
  void expect_rising(const std::string& step) const {
    ASSERT_TRUE(shares_.contains(step)) << step;
    const std::vector<double>& own = shares_.at(step);
    EXPECT_GE(std::set<double>(own.begin(), own.end()).size(), 3U) << step;
    EXPECT_EQ(own.back(), 1) << step;
  }

 private:
  std::map<std::string, std::vector<double>> shares_;
};

/// Keeps the shares that it is told.
struct Listener {
  Listener() {
    progress.report = [this](std::string_view step, double share) {
      steps.emplace_back(step);
      shares.push_back(share);
    };
  }
  Progress progress;
  std::vector<std::string> steps;
  std::vector<double> shares;
};

TEST(Progress, PartsAreSharesOfTheWhole) {
  Listener listener;
  const Progress part = listener.progress.part(0.5, 0.75);
  for (const double share : {0.0, 0.5, 1.0}) part.update("cull", share);
  EXPECT_EQ(listener.shares, (std::vector{0.5, 0.625, 0.75}));
  EXPECT_EQ(listener.steps, (std::vector<std::string>(3, "cull")));
}

TEST(Progress, SharesOfWorkFollowItsSizes) {
  Listener listener;
  WorkProgress work(listener.progress, "stitch", 8);
  for (const double size : {1, 5, 2, 1}) work.add(size);
  EXPECT_EQ(listener.shares, (std::vector{0.125, 0.75, 1.0, 1.0}));
  WorkProgress none(listener.progress, "stitch", 0);
  none.add(0);
  EXPECT_EQ(listener.shares.back(), 1);
}

TEST(Progress, OfAnExactHullRises) {
  Shares shares;
  precise_hull(make_scene(teapot()),
               {.relative = 1e-3, .threads = 1, .progress = shares.progress()});
  for (const char* step : {"cull", "trace", "stitch", "mesh"}) shares.expect_rising(step);
}

TEST(Progress, OfACageRises) {
  Shares shares;
  limit_patches(cube_cage(), {.progress = shares.progress()});
  shares.expect_rising("refine");
}

}  // namespace
}  // namespace taut
