#include "taut/core/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <thread>

namespace taut {

void parallel_for(std::size_t count, std::size_t grain, int threads,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t ranges = (count + grain - 1) / grain;
  const auto run = [&](std::size_t r) { body(r * grain, std::min(count, (r + 1) * grain)); };
  if (threads == 1 || ranges <= 1) {
    for (std::size_t r = 0; r < ranges; ++r) run(r);
    return;
  }
  // More threads than the machine has bring a warning from the library, and nothing else.
  const int most = tbb::info::default_concurrency();
  tbb::task_arena arena(threads > 0 ? std::min(threads, most) : most);
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, ranges, run); });
}

void parallel_for(std::size_t count, std::size_t grain, int threads,
                  const std::function<void(std::size_t begin, std::size_t end)>& body,
                  const std::function<void(std::size_t done)>& report) {
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<std::size_t> done = 0;
  parallel_for(count, grain, threads, [&](std::size_t begin, std::size_t end) {
    body(begin, end);
    const std::size_t now = done.fetch_add(end - begin) + (end - begin);
    if (std::this_thread::get_id() == caller) report(now);
  });
}

}  // namespace taut
