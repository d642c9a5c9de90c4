#pragma once

#include <cstddef>
#include <functional>

namespace taut {

/// Calls body(begin, end) on consecutive ranges that together are [0, count), on up to `threads`
/// threads (0: as many as the machine has). Ranges hold at most `grain` indices.
///
/// The split into ranges depends on count and grain alone, never on the number of threads, so a
/// body that writes to slot i only gives the same bits for any number of threads.
/// The first exception that a body throws is thrown here after all running ranges have ended.
void parallel_for(std::size_t count, std::size_t grain, int threads,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// The same. Tells how many of the indices are done, never fewer than before, after each range that
/// the calling thread has done itself; what is thrown then counts as thrown by a body.
void parallel_for(std::size_t count, std::size_t grain, int threads,
                  const std::function<void(std::size_t begin, std::size_t end)>& body,
                  const std::function<void(std::size_t done)>& report);

}  // namespace taut
