#pragma once

#include <atomic>
#include <stop_token>
#include <thread>

#include "exit_code.h"

namespace taut::tool {

/// Turns SIGINT and SIGTERM into a stop request while it lives.
///
/// The signals are blocked in all threads and taken by a thread of its own, which may therefore
/// call what a signal handler may not. What has not stopped shortly after the request, as it is in
/// a library or writes a large file, is ended by that thread; no file is left half-written.
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
  void wait_for_end() const;

  std::stop_source source_;
  std::atomic<int> signal_ = 0;
  std::atomic<bool> ending_ = false;
  std::thread watcher_;
};

}  // namespace taut::tool
