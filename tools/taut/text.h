#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace taut::tool {

/// @name Numbers
/// Independent of the locale.
/// @{
/// `digits` significant digits, without trailing zeros; 17 digits round-trip.
std::string number(double value, int digits = 6);
std::string number(long value);
/// The whole text as a number; a leading '+' is allowed. None if it is no number; an infinity or
/// zero if it is one too large or too small for a double.
std::optional<double> parse_number(std::string_view text);
std::optional<int> parse_integer(std::string_view text);
/// @}

/// "1 face", "2 faces".
std::string counted(long count, std::string_view noun, std::string_view plural);

/// "a, b, c"
std::string joined(const std::vector<std::string>& words, std::string_view separator = ", ");

/// The text as one line without control characters, fit for a terminal.
std::string one_line(std::string_view text);

/// What the system says of the last error of a call of it (errno).
std::string system_reason();

/// The text padded with spaces on the right to the width.
std::string padded(std::string text, std::size_t width);

}  // namespace taut::tool
