#pragma once

#include <filesystem>
#include <string_view>

namespace taut {

/// Writes a file under a temporary name beside it and renames that, so that it appears whole or not
/// at all. @throws IoError
void write_whole_file(const std::filesystem::path& path, std::string_view content);

/// Ends the process at once, as std::_Exit(), but removes the files that are being written under
/// temporary names, here or by another function of Taut; from any thread, whatever others do.
[[noreturn]] void exit_without_output(int code);

}  // namespace taut
