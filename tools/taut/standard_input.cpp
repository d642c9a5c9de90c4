#include "standard_input.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "taut/core/error.h"
#include "text.h"

namespace taut::tool {

std::size_t read_some(int descriptor, std::span<char> buffer, const std::string& name,
                      const Stop& stop) {
  for (;;) {
    stop.check();
    pollfd wait = {descriptor, POLLIN, 0};
    if (poll(&wait, 1, 25) == 0) continue;
    const ssize_t count = read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count < 0) {
      throw IoError(name + ": cannot be read: " + system_reason());
    }
    return static_cast<std::size_t>(count);
  }
}

std::string read_standard_input(const Stop& stop) {
  constexpr std::size_t most = std::size_t{1} << 31;
  std::string text;
  std::array<char, 65536> buffer;
  while (const std::size_t count = read_some(STDIN_FILENO, buffer, standard_input, stop)) {
    if (text.size() + count > most) {
      throw LimitExceeded(std::string(standard_input) + ": is larger than 2 GiB");
    }
    text.append(buffer.data(), count);
  }
  return text;
}

}  // namespace taut::tool
