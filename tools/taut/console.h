#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "progress_bar.h"
#include "taut/core/progress.h"
#include "taut/core/stopwatch.h"
#include "taut/io/report/report.h"
#include "text.h"

namespace taut::tool {

/// The options that every command has.
struct CommonOptions {
  bool json = false;
  bool quiet = false;
  bool verbose = false;
  int threads = 0;
  std::string progress = "auto";
};

/// Adds them to a command, with its --version.
void add_common_options(CLI::App& command, CommonOptions& options);

/// Adds an option whose value must be a positive finite number.
CLI::Option* add_positive(CLI::App& command, const std::string& name, std::optional<double>& value,
                          const std::string& description);

/// Adds an option whose value is an amount of memory: bytes, or a number and K, M, G or T for
/// powers of 1024 of them.
CLI::Option* add_memory(CLI::App& command, const std::string& name,
                        std::optional<std::size_t>& bytes, const std::string& description);

/// Adds the option --resolution, a fraction of the diagonal.
CLI::Option* add_resolution(CLI::App& command, std::optional<double>& value);

/// Adds an option whose value must be an integer in [lowest, highest].
CLI::Option* add_integer(CLI::App& command, const std::string& name, int& value, int lowest,
                         int highest, const std::string& description);

/// The same of one that has no value unless it is given.
CLI::Option* add_integer(CLI::App& command, const std::string& name, std::optional<int>& value,
                         int lowest, int highest, const std::string& description);

/// One run of a command: its common options, what it says, and whether it should stop.
class Console {
 public:
  Console(const CommonOptions& options, std::stop_token stop)
      : options_(options), stop_(std::move(stop)), bar_(options.progress, options.quiet) {}

  const CommonOptions& options() const { return options_; }
  /// For the toolkit's operations; the console must outlive it.
  Progress progress();
  /// Those begun from now on stop at these limits, of time from now.
  void limit(std::optional<double> max_seconds, std::optional<std::size_t> max_memory);
  /// A limit that is met no longer counts: what is there is finished.
  void lift_limits() { stop_.lift_limits(); }

  /// Keeps the warning for reports, and shows it unless --quiet.
  void warn(std::string_view code, std::string_view text);
  const std::vector<Warning>& warnings() const { return warnings_; }
  /// Shows a line on stderr with -v.
  void note(std::string_view text);
  /// Shows one of several failures, of which the last is thrown.
  void error(std::string_view text) { message("taut: " + one_line(text)); }
  /// Writes results to stdout. @throws IoError
  void print(std::string_view text);
  /// Takes the progress bar away.
  void clear() { bar_.clear(); }

  /// Since the console began.
  double seconds() const { return watch_.seconds(); }

 private:
  void message(const std::string& line);

  CommonOptions options_;
  Stop stop_;
  ProgressBar bar_;
  std::vector<Warning> warnings_;
  Stopwatch watch_;
};

/// The largest memory that the process has held.
long peak_bytes();

}  // namespace taut::tool
