#include "interrupt.h"

#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include "taut/io/text/whole_file.h"

namespace taut::tool {
namespace {

/// What hears a request to stop needs less.
constexpr std::chrono::milliseconds patience(100);
static_assert(patience < std::chrono::seconds(1), "a timespec's nanoseconds are fewer");

sigset_t watched_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

/// Not through stdio, which others may hold, and only where it does not have to wait.
void tell_end() {
  pollfd ready = {STDERR_FILENO, POLLOUT, 0};
  if (poll(&ready, 1, 0) <= 0) return;
  // Over a progress bar.
  const bool terminal = isatty(STDERR_FILENO) == 1;
  const std::string_view text = terminal ? "\r\x1b[Ktaut: interrupted\n" : "taut: interrupted\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
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
      abandon_files();
      tell_end();
      std::_Exit(static_cast<int>(exit_code()));
    }
    const timespec time = {0, static_cast<long>(left.count())};
    sigtimedwait(&signals, nullptr, &time);  // the destructor's ends it; others change nothing
  }
}

}  // namespace taut::tool
