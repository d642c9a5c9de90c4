#pragma once

#include "console.h"
#include "hull_arguments.h"
#include "taut/io/report/report.h"

namespace taut::tool {

/// The report of a hull that was found, but for what writing it adds. Measures the exact hull where
/// it is known; a limit that is met meanwhile is the outcome's. `tolerance`: in model units.
Report make_report(Input& input, Outcome& outcome, const HullArguments& arguments, double tolerance,
                   Console& console);

/// Gives it the times and warnings until now.
void bring_up_to_date(Report& report, const Outcome& outcome, const Console& console);

}  // namespace taut::tool
