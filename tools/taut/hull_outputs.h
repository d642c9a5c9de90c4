#pragma once

#include <string>
#include <vector>

#include "hull_arguments.h"
#include "output.h"
#include "taut/io/report/report.h"

namespace taut::tool {

/// Whether a format is that of the exact hull's document.
bool is_document(const std::string& format);

/// What became of the outputs.
struct Written {
  std::vector<std::string> files;     ///< those that were written, the layers of projects each
  std::vector<std::string> failures;  ///< a line for each output that was not
  bool any_hull = false;              ///< a hull was, standard output included
};

/// Writes all hulls that can be, and tells the report how they were rounded.
Written write_outputs(const HullArguments& arguments, const OutputPlaces& places, Input& input,
                      const Outcome& outcome, Report& report, Console& console);

/// Writes the report to its file, if it has one.
void write_report(const HullArguments& arguments, const OutputPlaces& places, const Report& report,
                  Written& written);

}  // namespace taut::tool
