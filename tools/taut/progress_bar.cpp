#include "progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "text.h"

namespace taut::tool {
namespace {

/// What ends sooner than this shows no bar, and a bar of the same step is redrawn no more often.
constexpr std::chrono::milliseconds pause(100);
/// Plain lines come no closer than this many percent.
constexpr int plain_stride = 10;

ProgressBar::Mode mode_of(std::string_view choice, bool quiet) {
  if (choice == "plain") return ProgressBar::Mode::plain;
  const bool visible = choice == "auto" && !quiet && isatty(STDERR_FILENO) == 1;
  return visible ? ProgressBar::Mode::bar : ProgressBar::Mode::never;
}

std::string bar(std::string_view step, int percent) {
  constexpr int width = 30;
  const int done = percent * width / 100;
  return "\r" + padded(std::string(step), 8) + " [" + std::string(std::size_t(done), '#') +
         std::string(std::size_t(width - done), ' ') + "] " + number(long(percent)) + " %\x1b[K";
}

}  // namespace

ProgressBar::ProgressBar(std::string_view choice, bool quiet)
    : mode_(mode_of(choice, quiet)), next_(Clock::now() + pause) {}

void ProgressBar::update(std::string_view step, double share) {
  if (mode_ == Mode::never) return;
  // A share that is no number counts as none done.
  const int percent = share > 0 ? int(100 * std::min(share, 1.0)) : 0;
  const bool new_step = step != step_;
  if (!new_step && percent == percent_) return;
  std::string text;
  if (mode_ == Mode::plain) {
    if (!new_step && percent < percent_ + plain_stride) return;
    text = one_line(step) + " " + number(long(percent)) + " %\n";
  } else {
    const Clock::time_point now = Clock::now();
    if (now < next_ && !(new_step && shown_)) return;
    next_ = now + pause;
    shown_ = true;
    text = bar(one_line(step), percent);
  }
  step_ = step;
  percent_ = percent;
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (!shown_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace taut::tool
