#include "taut/core/limits.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>
#include <utility>

#include "taut/core/error.h"

namespace taut {
namespace {

/// Seconds between looks at the memory, which take a few microseconds each.
constexpr double look_interval = 1e-3;

std::string text_of(double x) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}

/// In the largest unit that leaves no fraction.
std::string bytes_text(std::size_t bytes) {
  constexpr std::array<std::string_view, 5> units = {"bytes", "KiB", "MiB", "GiB", "TiB"};
  std::size_t unit = 0;
  for (; unit + 1 < units.size() && bytes % 1024 == 0; ++unit) bytes /= 1024;
  return std::to_string(bytes) + " " + std::string(units[unit]);
}

/// The smaller of two, of which none is no limit.
template <class T>
std::optional<T> least(const std::optional<T>& a, const std::optional<T>& b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

}  // namespace

std::size_t resident_bytes() {
  // The second number is that of pages held.
  std::ifstream file("/proc/self/statm");
  std::size_t size = 0, resident = 0;
  if (!(file >> size >> resident)) {
    throw BackendError("the system does not tell how much memory is in use, as a limit needs");
  }
  return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

Limits::Limits(std::optional<double> max_seconds, std::optional<std::size_t> max_memory)
    : max_seconds_(max_seconds),
      max_memory_(max_memory),
      stated_seconds_(max_seconds),
      stated_memory_(max_memory) {
  // Asked in a form that NaN fails.
  if (max_seconds && !(*max_seconds > 0 && std::isfinite(*max_seconds))) {
    throw InvalidInput("the limit of time must be positive and finite, not " +
                       text_of(*max_seconds) + " s");
  }
  if (max_memory && *max_memory == 0) throw InvalidInput("the limit of memory must be positive");
  if (max_memory) resident_bytes();
}

Limits::Limits(const Limits& others, std::optional<double> max_seconds,
               std::optional<std::size_t> max_memory)
    : Limits(max_seconds, max_memory) {
  if (others.state_ == State::lifted) return;
  std::optional<double> left;
  if (others.max_seconds_) left = *others.max_seconds_ - others.seconds();
  max_seconds_ = least(max_seconds_, left);
  if (max_seconds_ == left) stated_seconds_ = others.stated_seconds_;
  max_memory_ = least(max_memory_, others.max_memory_);
  if (max_memory_ == others.max_memory_) stated_memory_ = others.stated_memory_;
}

Limits::Limits(const Limits& others, double share) : Limits(others, std::nullopt, std::nullopt) {
  if (max_seconds_) *max_seconds_ *= share;
  if (!max_memory_) return;
  const std::size_t now = resident_bytes();
  if (now < *max_memory_) max_memory_ = now + std::size_t(share * double(*max_memory_ - now));
}

bool Limits::met() const {
  const State known = state_;
  if (known != State::within) return known != State::lifted;
  if (!max_seconds_ && !max_memory_) return false;
  const double now = seconds();
  if (max_seconds_ && now >= *max_seconds_) return met(State::out_of_time);
  if (!max_memory_) return false;
  double look = next_look_;
  // Of several threads one looks.
  if (now < look || !next_look_.compare_exchange_strong(look, now + look_interval)) return false;
  return resident_bytes() > *max_memory_ && met(State::out_of_memory);
}

/// The first limit that is met stays the one.
bool Limits::met(State state) const {
  State within = State::within;
  return state_.compare_exchange_strong(within, state) || within != State::lifted;
}

std::string Limits::text() const {
  if (state_ == State::out_of_memory) {
    return "the limit of " + bytes_text(stated_memory_.value_or(0)) + " of memory was met";
  }
  return "the limit of " + text_of(stated_seconds_.value_or(0)) + " s was met";
}

}  // namespace taut
