#pragma once

#include <atomic>
#include <stop_token>
#include <thread>

#include "exit_code.h"

namespace taut::tool {

/// Turns SIGINT and SIGTERM into a stop request while it lives.
///
/// The signals are blocked in all threads and taken by a thread of its own, which may therefore
/// call what a signal handler may not. A signal that comes again a second or more after the first
/// ends the process at once, whatever it is doing.
///
/// Construct it before any other thread starts: threads inherit the blocked signals.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return source_.get_token(); }
  /// What to exit with after a stop was requested.
  ExitCode exit_code() const;

 private:
  void watch();

  std::stop_source source_;
  std::atomic<int> signal_ = 0;
  std::atomic<bool> ending_ = false;
  std::thread watcher_;
};

}  // namespace taut::tool
