#include "interrupt.h"

#include <pthread.h>

#include <chrono>
#include <csignal>
#include <cstdlib>

namespace taut::tool {
namespace {

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
  using Clock = std::chrono::steady_clock;
  const sigset_t signals = watched_signals();
  Clock::time_point first;
  for (;;) {
    int signal = 0;
    if (sigwait(&signals, &signal) != 0) continue;
    if (ending_) return;
    if (signal_ == 0) {
      signal_ = signal;
      first = Clock::now();
      source_.request_stop();
    } else if (Clock::now() - first >= std::chrono::seconds(1)) {
      std::_Exit(static_cast<int>(exit_code_of(signal)));
    }
  }
}

}  // namespace taut::tool
