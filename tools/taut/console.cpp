#include "console.h"

#include <sys/resource.h>

#include <cctype>
#include <cmath>
#include <cstdio>

#include "output.h"
#include "text.h"

namespace taut::tool {
namespace {

constexpr int max_threads = 4096;
constexpr double most_memory = 0x1p62;  ///< bytes

/// `Value`: an integer or an optional one.
template <class Value>
CLI::Option* add_integer_to(CLI::App& command, const std::string& name, Value& value, int lowest,
                            int highest, const std::string& description) {
  return command
      .add_option_function<std::string>(
          name,
          [&value, name, lowest, highest](const std::string& text) {
            const auto parsed = parse_integer(text);
            if (!parsed || *parsed < lowest || *parsed > highest) {
              throw CLI::ValidationError(name, text + " is no number from " + number(long(lowest)) +
                                                   " to " + number(long(highest)));
            }
            value = *parsed;
          },
          description)
      ->type_name("N");
}

}  // namespace

void add_common_options(CLI::App& command, CommonOptions& options) {
  const std::string group = "Common options";
  command.add_flag("--json", options.json, "Result as JSON on stdout")->group(group);
  command.add_flag("-q,--quiet", options.quiet, "No summary, warnings or progress")->group(group);
  command.add_flag("-v,--verbose", options.verbose, "Tell more on stderr")->group(group);
  add_integer(command, "--threads", options.threads, 0, max_threads,
              "Threads to use, 0 (default) for all; same result for any number")
      ->group(group);
  command
      .add_option("--progress", options.progress,
                  "On stderr; auto (default): a bar if that is a terminal; plain: lines")
      ->check(CLI::IsMember({"auto", "plain", "never"}).description(""))
      ->type_name("auto|plain|never")
      ->group(group);
  command.set_version_flag("--version", "taut " TAUT_VERSION)->group(group);
  command.set_help_flag("-h,--help", "Print this help and exit")->group(group);
}

CLI::Option* add_positive(CLI::App& command, const std::string& name, std::optional<double>& value,
                          const std::string& description) {
  return command.add_option_function<std::string>(
      name,
      [&value, name](const std::string& text) {
        const auto parsed = parse_number(text);
        if (!parsed || !(*parsed > 0) || !std::isfinite(*parsed)) {
          throw CLI::ValidationError(name, text + " is no positive number");
        }
        value = parsed;
      },
      description);
}

CLI::Option* add_memory(CLI::App& command, const std::string& name,
                        std::optional<std::size_t>& bytes, const std::string& description) {
  return command
      .add_option_function<std::string>(
          name,
          [&bytes, name](const std::string& text) {
            constexpr std::string_view units = "KMGT";
            const std::size_t unit =
                text.empty()
                    ? std::string_view::npos
                    : units.find(char(std::toupper(static_cast<unsigned char>(text.back()))));
            const bool has_unit = unit != std::string_view::npos;
            const auto parsed = parse_number(text.substr(0, text.size() - (has_unit ? 1 : 0)));
            const double amount =
                std::ldexp(parsed.value_or(0), has_unit ? 10 * (int(unit) + 1) : 0);
            if (!(amount >= 1 && amount < most_memory)) {
              throw CLI::ValidationError(name,
                                         text + " is no amount of memory, such as 500M or 2G");
            }
            bytes = static_cast<std::size_t>(amount);
          },
          description)
      ->type_name("M");
}

CLI::Option* add_resolution(CLI::App& command, std::optional<double>& value) {
  const std::string name = "--resolution";
  return command
      .add_option_function<std::string>(
          name,
          [&value, name](const std::string& text) {
            const auto parsed = parse_number(text);
            if (!parsed || !(*parsed >= 0 && *parsed <= 1)) {
              throw CLI::ValidationError(name, text + " is no number from 0 to 1");
            }
            value = parsed;
          },
          "What is nearer than this fraction of the diagonal may be taken for\none; 0: nothing but "
          "what rounding to doubles does. Default: from the\nmodel, by its size, the digits of its "
          "coordinates and its joins")
      ->type_name("R");
}

CLI::Option* add_integer(CLI::App& command, const std::string& name, int& value, int lowest,
                         int highest, const std::string& description) {
  return add_integer_to(command, name, value, lowest, highest, description);
}

CLI::Option* add_integer(CLI::App& command, const std::string& name, std::optional<int>& value,
                         int lowest, int highest, const std::string& description) {
  return add_integer_to(command, name, value, lowest, highest, description);
}

Progress Console::progress() {
  Progress progress;
  progress.report = [this](std::string_view step, double share) { bar_.update(step, share); };
  progress.warn = [this](std::string_view code, std::string_view text) { warn(code, text); };
  progress.stop = stop_;
  return progress;
}

void Console::limit(std::optional<double> max_seconds, std::optional<std::size_t> max_memory) {
  if (max_seconds || max_memory) stop_ = stop_.within(max_seconds, max_memory);
}

void Console::warn(std::string_view code, std::string_view text) {
  warnings_.push_back({std::string(code), std::string(text)});
  if (!options_.quiet) message("taut: warning: " + one_line(text));
}

void Console::note(std::string_view text) {
  if (options_.verbose) message("taut: " + one_line(text));
}

void Console::print(std::string_view text) {
  bar_.clear();
  write_stdout(text);
}

void Console::message(const std::string& line) {
  bar_.clear();
  std::fputs((line + "\n").c_str(), stderr);
}

long peak_bytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return usage.ru_maxrss * 1024;  // Linux counts in kilobytes
}

}  // namespace taut::tool
