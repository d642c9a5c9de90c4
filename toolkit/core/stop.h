#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include "taut/core/error.h"
#include "taut/core/limits.h"

namespace taut {

/// How a long operation learns that it should stop: because that is asked for, through the source
/// of a std::stop_token, or since a limit is met. Copies share their limits.
///
/// What is said to throw Cancelled throws LimitMet where a limit is met.
class Stop {
 public:
  /// Never.
  Stop() = default;
  /// When asked for; conversion is what is wanted.
  Stop(std::stop_token token) : token_(std::move(token)) {}  // NOLINT(google-explicit-constructor)
  /// When asked for or at these limits.
  Stop(std::stop_token token, std::shared_ptr<const Limits> limits)
      : token_(std::move(token)), limits_(std::move(limits)) {}

  /// Whether check() would throw.
  bool stop_requested() const {
    return token_.stop_requested() || (limits_ != nullptr && limits_->met());
  }
  /// @throws Cancelled if stopping was asked for, LimitMet if a limit is met
  void check() const {
    if (token_.stop_requested()) throw Cancelled();
    if (limits_ != nullptr && limits_->met()) throw LimitMet(limits_->text());
  }

  /// Whether there are limits of time or memory, met or not.
  bool has_limits() const { return limits_ != nullptr; }
  /// The same with limits of its own that these begin, and what is left of those it has.
  Stop within(std::optional<double> max_seconds, std::optional<std::size_t> max_memory) const {
    return {token_, limits_ == nullptr
                        ? std::make_shared<const Limits>(max_seconds, max_memory)
                        : std::make_shared<const Limits>(*limits_, max_seconds, max_memory)};
  }
  /// The same with limits of its own, a share of what is left of those it has.
  /// @pre has_limits()
  Stop within_share(double share) const {
    return {token_, std::make_shared<const Limits>(*limits_, share)};
  }
  /// Limits no longer count, for all that share them (Limits::lift).
  void lift_limits() const {
    if (limits_ != nullptr) limits_->lift();
  }

 private:
  std::stop_token token_;
  std::shared_ptr<const Limits> limits_;
};

}  // namespace taut
