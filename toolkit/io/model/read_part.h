#pragma once

#include <string>
#include <string_view>

#include "taut/io/mesh/file_content.h"
#include "taut/io/text/read_options.h"

namespace taut {

/// Whether files of the format (".ply") hold one part.
bool is_part_format(std::string_view format);

/// @pre is_part_format(format) @throws as read_model()
FileContent read_content(std::string_view data, const std::string& name, std::string_view format,
                         const ReadOptions& options);

/// The part of a file, not connected yet; the name stands in messages.
/// @throws InvalidInput if there is nothing or its extent overflows, or the cage is not valid;
/// BackendError if OpenSubdiv does not take it
Part as_part(FileContent content, const std::string& name, const ReadOptions& options);

}  // namespace taut
