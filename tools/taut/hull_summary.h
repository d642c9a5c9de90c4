#pragma once

#include <string>
#include <vector>

#include "taut/io/report/report.h"

namespace taut::tool {

/// A report as a person reads it, with the files that were written.
std::string summary(const Report& report, const std::vector<std::string>& written);

}  // namespace taut::tool
