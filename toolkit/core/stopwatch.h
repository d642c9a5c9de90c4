#pragma once

#include <chrono>
#include <utility>

namespace taut {

/// Tells the time since it was made.
class Stopwatch {
 public:
  /// Since it was made.
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// The seconds since the last lap, the first time since it was made.
  double lap() {
    const double now = seconds();
    return now - std::exchange(last_, now);
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double last_ = 0;
};

}  // namespace taut
