// The command taut: parses the command line, runs one of the commands and turns what is thrown
// into one line on stderr and an exit code.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "command.h"
#include "console.h"
#include "exit_code.h"
#include "interrupt.h"
#include "output.h"
#include "text.h"

namespace taut::tool {
namespace {

/// Help that begins with what a command does and examples of it (kept as the command's footer).
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() {
    column_width(32);
    label("Positionals", "Arguments");
    label("SUBCOMMAND", "COMMAND");
  }

  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    return make_description(app) + make_footer(app) + "\n" + make_usage(app, std::move(name)) +
           make_positionals(app) + make_groups(app, mode) + make_subcommands(app, mode);
  }

  std::string make_description(const CLI::App* app) const override {
    return app->get_description() + "\n\n";
  }

  /// What stands behind an option's names: just the kind of value.
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string value =
        option->get_option_text().empty() ? option->get_type_name() : option->get_option_text();
    return value.empty() ? "" : " " + value;
  }
};

ExitCode fail(ExitCode code, const std::string& text) {
  std::fputs(("taut: " + one_line(text) + "\n").c_str(), stderr);
  return code;
}

/// Says what went wrong; `cancelled` is the code where that is a Cancelled.
/// @pre called while an exception is handled
ExitCode fail_with_current_exception(ExitCode cancelled) {
  try {
    throw;
  } catch (const CheckFailed& error) {
    return fail(ExitCode::check_failed, error.what());
  } catch (const UsageError& error) {
    return fail(ExitCode::wrong_usage, error.what());
  } catch (const IoError& error) {
    return fail(ExitCode::io_error, error.what());
  } catch (const BackendError& error) {
    return fail(ExitCode::io_error, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(ExitCode::io_error, error.what());
  } catch (const InvalidInput& error) {
    return fail(ExitCode::invalid_input, error.what());
  } catch (const NotConverged& error) {
    return fail(ExitCode::not_converged, error.what());
  } catch (const Cancelled&) {
    return fail(cancelled, "interrupted");
  } catch (const LimitExceeded& error) {
    return fail(ExitCode::limit_exceeded, error.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::limit_exceeded, "out of memory");
  } catch (const std::length_error&) {
    return fail(ExitCode::limit_exceeded, "out of memory");
  } catch (const std::system_error& error) {
    return fail(ExitCode::limit_exceeded, error.what());
  } catch (const std::exception& error) {
    return fail(ExitCode::internal_error, std::string("internal error: ") + error.what());
  } catch (...) {
    return fail(ExitCode::internal_error, "internal error");
  }
}

/// The command line of all commands.
class CommandLine {
 public:
  CommandLine() {
    app_.formatter(std::make_shared<HelpFormatter>());
    app_.footer(
        "Examples:\n"
        "  taut hull teapot.bpt -o hull.ply            the convex hull as a mesh\n"
        "  taut info teapot.bpt                        what a file holds\n"
        "  taut verify hull.ply teapot.bpt             is this mesh its hull?\n"
        "  taut hull --help                            more on a command; also: taut help hull");
    app_.set_help_flag("-h,--help", "Print this help and exit");
    app_.set_version_flag("--version", "taut " TAUT_VERSION);
    app_.require_subcommand(1);
    commands_ = {add_hull(app_),     add_info(app_),   add_support(app_), add_contains(app_),
                 add_envelope(app_), add_verify(app_), add_plugins(app_), add_help(app_)};
    // Last, so that help shows them last.
    for (const Command& command : commands_) add_common_options(*command.app, *command.common);
  }

  ExitCode run(int argc, const char* const* argv) {
    try {
      check_command(argc, argv);
      app_.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
      write_stdout(app_.help());
      return ExitCode::done;
    } catch (const CLI::CallForVersion&) {
      write_stdout("taut " TAUT_VERSION "\n");
      return ExitCode::done;
    } catch (const CLI::ParseError& error) {
      throw UsageError(std::string(error.what()) + hint());
    }
    const auto command = std::find_if(commands_.begin(), commands_.end(),
                                      [](const Command& c) { return c.app->parsed(); });
    const Interrupt interrupt;
    try {
      Console console(*command->common, interrupt.token());
      return command->run(console);
    } catch (...) {
      return fail_with_current_exception(interrupt.exit_code());
    }
  }

 private:
  /// @throws UsageError if the first argument names no command
  void check_command(int argc, const char* const* argv) const {
    const std::string first = argc > 1 ? argv[1] : "";
    if (first.starts_with("-")) return;
    std::vector<std::string> names;
    for (const Command& command : commands_) {
      names.push_back(command.app->get_name());
      if (names.back() == first) return;
    }
    const std::string fault = first.empty() ? "no command" : "there is no command '" + first + "'";
    throw UsageError(fault + "; commands are " + joined(names) + "; see taut --help");
  }

  /// Where to read on after a mistake.
  std::string hint() const {
    const auto parsed = app_.get_subcommands();
    return "; see taut " + (parsed.empty() ? "" : parsed.front()->get_name() + " ") + "--help";
  }

  CLI::App app_{"Taut computes convex hulls of freeform models", "taut"};
  std::vector<Command> commands_;
};

}  // namespace
}  // namespace taut::tool

int main(int argc, char** argv) {
  using taut::tool::ExitCode;
  try {
    return static_cast<int>(taut::tool::CommandLine().run(argc, argv));
  } catch (...) {
    return static_cast<int>(taut::tool::fail_with_current_exception(ExitCode::interrupted));
  }
}
