#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace taut::tool {

/// Shows on stderr how far a computation is: as a bar that is redrawn, or as plain lines.
class ProgressBar {
 public:
  enum class Mode { never, plain, bar };

  /// `choice` is "auto", "plain" or "never"; auto is a bar where stderr is a terminal, and nothing
  /// elsewhere or if `quiet`.
  ProgressBar(std::string_view choice, bool quiet);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// @param share in [0, 1]
  void update(std::string_view step, double share);
  /// Takes the bar away, so that something else can be written.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  Mode mode_;
  bool shown_ = false;
  std::string step_;
  int percent_ = -1;
  Clock::time_point next_;
};

}  // namespace taut::tool
