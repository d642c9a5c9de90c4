#include "taut/core/limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "taut/core/progress.h"

namespace taut {
namespace {

constexpr double moment = 1e-9;  ///< seconds, over before anything is done
constexpr double age = 1e6;
constexpr std::size_t mebibyte = std::size_t{1} << 20;

std::string text_of(const Limits& limits) { return limits.met() ? limits.text() : "none"; }

TEST(Limits, AreMetWhenTheyAreReached) {
  EXPECT_EQ(text_of({std::nullopt, std::nullopt}), "none");
  EXPECT_EQ(text_of({age, std::size_t{1} << 60}), "none");
  EXPECT_EQ(text_of({moment, std::nullopt}), "the limit of 1e-09 s was met");
  EXPECT_EQ(text_of({age, mebibyte}), "the limit of 1 MiB of memory was met");
  EXPECT_EQ(text_of({std::nullopt, 1025}), "the limit of 1025 bytes of memory was met");
  // Both are; the first one looked at is told.
  EXPECT_EQ(text_of({moment, 1}), "the limit of 1e-09 s was met");
}

TEST(Limits, ThatAreNoneAreRefused) {
  for (const double wrong : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(Limits(wrong, std::nullopt), InvalidInput) << wrong;
  }
  EXPECT_THROW(Limits(std::nullopt, 0), InvalidInput);
}

TEST(Limits, OfMemoryAreMetByWhatIsTaken) {
  const Limits limits(std::nullopt, resident_bytes() + 32 * mebibyte);
  EXPECT_EQ(text_of(limits), "none");
  const std::vector<char> taken(64 * mebibyte, 'x');
  EXPECT_EQ(std::memchr(taken.data(), 'y', taken.size()), nullptr);
  // A look just before may be the last for a while.
  while (!limits.met()) {
  }
  EXPECT_NE(limits.text().find("of memory was met"), std::string::npos);
}

TEST(Limits, ThatAreLiftedAreNotMet) {
  const Limits limits(moment, std::nullopt);
  EXPECT_TRUE(limits.met());
  limits.lift();
  EXPECT_FALSE(limits.met());
  EXPECT_EQ(text_of({limits, std::nullopt, std::nullopt}), "none");
  EXPECT_EQ(text_of({limits, 1.0}), "none");
}

TEST(Limits, WithinOthersAreTheLeast) {
  EXPECT_EQ(text_of({{age, std::nullopt}, moment, std::nullopt}), "the limit of 1e-09 s was met");
  EXPECT_EQ(text_of({{moment, std::nullopt}, age, std::nullopt}), "the limit of 1e-09 s was met");
  EXPECT_EQ(text_of({{std::nullopt, mebibyte}, std::nullopt, 2 * mebibyte}),
            "the limit of 1 MiB of memory was met");
  EXPECT_EQ(text_of({{std::nullopt, 2 * mebibyte}, age, mebibyte}),
            "the limit of 1 MiB of memory was met");
  // Of others that are met the rest is lifted apart.
  const Limits others(moment, std::nullopt);
  const Limits own(others, std::nullopt, std::nullopt);
  own.lift();
  EXPECT_TRUE(others.met());
}

TEST(Limits, SharesTellTheWhole) {
  EXPECT_EQ(text_of({{age, std::nullopt}, 0.5}), "none");
  EXPECT_EQ(text_of({{moment, std::nullopt}, 0.5}), "the limit of 1e-09 s was met");
  EXPECT_EQ(text_of({{age, mebibyte}, 0.5}), "the limit of 1 MiB of memory was met");
  const std::size_t now = resident_bytes();
  const Limits whole(std::nullopt, now + 128 * mebibyte);
  const Limits share(whole, 0.25);
  const std::vector<char> taken(64 * mebibyte, 'x');
  EXPECT_EQ(std::memchr(taken.data(), 'y', taken.size()), nullptr);
  EXPECT_TRUE(share.met());
  EXPECT_FALSE(whole.met());
}

TEST(Stop, IsAskedForOrComesFromLimits) {
  EXPECT_FALSE(Stop().stop_requested());
  EXPECT_NO_THROW(Stop().check());
  std::stop_source source;
  const Stop asked = source.get_token();
  const Stop limited = asked.within(moment, std::nullopt);
  EXPECT_FALSE(asked.stop_requested());
  EXPECT_TRUE(limited.stop_requested());
  EXPECT_THROW(limited.check(), LimitMet);
  EXPECT_NO_THROW(asked.within(age, std::nullopt).check());
  source.request_stop();
  EXPECT_THROW(asked.check(), Cancelled);
  // What is asked for comes first.
  EXPECT_THROW(limited.check(), Cancelled);
}

TEST(Stop, LimitsOfCopiesAreLiftedTogether) {
  Progress progress;
  progress.stop = Stop().within(moment, std::nullopt);
  const Progress copy = progress;
  EXPECT_THROW(copy.update("step", 0), LimitMet);
  const Stop own = progress.stop.within(std::nullopt, std::nullopt);
  own.lift_limits();
  EXPECT_THROW(copy.check(), LimitMet);
  progress.stop.lift_limits();
  EXPECT_NO_THROW(copy.check());
}

}  // namespace
}  // namespace taut
