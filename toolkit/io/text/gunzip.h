#pragma once

#include <string>
#include <string_view>

#include "taut/core/progress.h"

namespace taut {

/// Whether the data begins as a gzipped file does.
bool is_gzipped(std::string_view data);

/// What the gzipped data holds, that of all its members; `name` is the file's for messages.
/// @pre is_gzipped(data) @throws IoError if it is damaged or cut off, LimitExceeded above
/// max_file_bytes, Cancelled, LimitMet
std::string gunzipped(const std::string& name, std::string_view data,
                      const Progress& progress = {});

}  // namespace taut
