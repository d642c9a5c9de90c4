#pragma once

#include <filesystem>
#include <string_view>

namespace taut {

/// Writes a file under a temporary name beside it and renames that, so that it appears whole or not
/// at all. @throws IoError
void write_whole_file(const std::filesystem::path& path, std::string_view content);

/// Removes the files that stand under temporary names, of this function and others of Taut, and
/// lets none be published any more: for a process that is to end at once. From any thread, whatever
/// others do; they wait where they would open or publish a file. Does nothing if a folder does not
/// answer for a second.
void abandon_files();

}  // namespace taut
