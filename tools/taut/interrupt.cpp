#include "interrupt.h"

#include <pthread.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>

#include "taut/io/whole_file.h"

namespace taut::tool {
namespace {

/// What hears a request to stop needs less.
constexpr std::chrono::milliseconds patience(100);

sigset_t watched_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

ExitCode exit_code_of(int signal) {
  return signal == SIGTERM ? ExitCode::terminated : ExitCode::interrupted;
}

}  // namespace

Interrupt::Interrupt() {
  const sigset_t signals = watched_signals();
  // A shell starts background jobs with SIGINT ignored, and an ignored signal may not be waited
  // for.
  std::signal(SIGINT, SIG_DFL);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::thread([this] { watch(); });
}

Interrupt::~Interrupt() {
  ending_ = true;
  pthread_kill(watcher_.native_handle(), SIGINT);  // blocked there: it only ends the wait
  watcher_.join();
}

ExitCode Interrupt::exit_code() const { return exit_code_of(signal_); }

void Interrupt::watch() {
  const sigset_t signals = watched_signals();
  int signal = 0;
  while (sigwait(&signals, &signal) != 0) {
  }
  if (ending_) return;
  signal_ = signal;
  source_.request_stop();
  wait_for_end();
}

/// Ends the process unless it comes to its end by itself.
void Interrupt::wait_for_end() const {
  using Clock = std::chrono::steady_clock;
  const sigset_t signals = watched_signals();
  const Clock::time_point last = Clock::now() + patience;
  while (!ending_) {
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(last - Clock::now());
    if (left.count() <= 0) {
      std::fputs("taut: interrupted\n", stderr);
      exit_without_output(static_cast<int>(exit_code()));
    }
    const timespec time = {0, static_cast<long>(left.count())};
    sigtimedwait(&signals, nullptr, &time);  // the destructor's ends it; others change nothing
  }
}

}  // namespace taut::tool
