#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

namespace taut {

/// The memory of this process that is in main memory now (its resident set), in bytes.
/// @throws BackendError where the system does not tell
std::size_t resident_bytes();

/// Limits of time and memory of an operation. They are looked at where stopping is (stop.h): a
/// limit is met a fraction of a second late, and memory may be above it by what was taken since.
///
/// Memory is that of the whole process (resident_bytes). Safe to call concurrently.
class Limits {
 public:
  /// Seconds from now, and bytes; none: no limit. @throws InvalidInput unless they are positive and
  /// the seconds finite, BackendError where bytes are limited and the system does not tell them
  Limits(std::optional<double> max_seconds, std::optional<std::size_t> max_memory);
  /// Those of `others` that are left, from now on, and these: whichever are met first.
  Limits(const Limits& others, std::optional<double> max_seconds,
         std::optional<std::size_t> max_memory);
  /// A share, in (0, 1], of what is left of the time and of the memory of others.
  Limits(const Limits& others, double share);
  Limits& operator=(const Limits&) = delete;

  /// Whether one is met, or was at an earlier look, unless they are lifted.
  bool met() const;
  /// The limit that was met, as "the limit of 2.5 s was met".
  std::string text() const;
  /// None is met any more, so that what was found until then can be finished.
  void lift() const { state_ = State::lifted; }

 private:
  using Clock = std::chrono::steady_clock;
  enum class State : unsigned char { within, out_of_time, out_of_memory, lifted };

  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  bool met(State state) const;

  Clock::time_point start_ = Clock::now();
  std::optional<double> max_seconds_;  ///< since the start; that of a part may be negative
  std::optional<std::size_t> max_memory_;
  /// What the text tells, of which these may be a part.
  std::optional<double> stated_seconds_;
  std::optional<std::size_t> stated_memory_;
  mutable std::atomic<State> state_ = State::within;
  mutable std::atomic<double> next_look_ = 0;  ///< at the memory, in seconds since the start
};

}  // namespace taut
