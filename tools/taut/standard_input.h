#pragma once

#include <span>
#include <string>

#include "taut/core/stop.h"

namespace taut::tool {

/// What the streams are called in messages.
inline constexpr const char* standard_input = "standard input";
inline constexpr const char* standard_output = "standard output";

/// Reads what is there, at least a byte, from a file, terminal or pipe; wakes up now and then to
/// see whether it should stop. Returns the number of bytes, 0 at the end.
/// @throws IoError with the name, Cancelled
std::size_t read_some(int descriptor, std::span<char> buffer, const std::string& name,
                      const Stop& stop);

/// All of standard input. @throws as read_some(), LimitExceeded beyond 2 GiB
std::string read_standard_input(const Stop& stop);

}  // namespace taut::tool
