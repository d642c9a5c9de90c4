#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string_view>

#include "taut/core/stop.h"

namespace taut {

/// How a long operation tells where it stands and learns that it should stop.
///
/// The default does nothing and never stops. The callbacks are called from the thread that called
/// the operation only.
struct Progress {
  /// Called now and then with the step's name and the share done, in [0, 1].
  std::function<void(std::string_view step, double share)> report;
  /// Called with a warning: a code fit for scripts ("open-border") and a sentence for a person.
  std::function<void(std::string_view code, std::string_view text)> warn;
  /// Stopping is asked for through the source of its token, from any thread or a signal handler's
  /// helper; or it has limits.
  Stop stop;

  /// Tells the share of the step that is done. @throws as check()
  void update(std::string_view step, double share) const {
    check();
    if (report) report(step, share);
  }
  /// Tells a warning, if anyone listens.
  void warning(std::string_view code, std::string_view text) const {
    if (warn) warn(code, text);
  }
  /// For an operation that is a part of a step: its shares from 0 to 1 are the step's from `begin`
  /// to `end`.
  Progress part(double begin, double end) const {
    Progress part = *this;
    if (!report) return part;
    part.report = [whole = report, begin, end](std::string_view step, double share) {
      whole(step, begin + share * (end - begin));
    };
    return part;
  }
  /// @throws Cancelled if stopping was asked for, LimitMet if a limit is met
  void check() const { stop.check(); }
  /// The same at a few of the steps, by number, of what takes nanoseconds each.
  void check_rarely(std::size_t step) const {
    if (step % 4096 == 0) check();
  }
};

/// Tells the shares of a step that is made of pieces of work of different sizes, one after the
/// other.
class WorkProgress {
 public:
  /// `work`: of all pieces together. The progress must outlive it.
  WorkProgress(const Progress& progress, std::string_view step, double work)
      : progress_(progress), step_(step), work_(work) {}

  /// A piece of work is done. @throws as Progress::update()
  void add(double work) {
    done_ += work;
    progress_.update(step_, work_ > 0 ? std::min(done_ / work_, 1.0) : 1);
  }

 private:
  const Progress& progress_;
  std::string_view step_;
  double work_;
  double done_ = 0;
};

}  // namespace taut
