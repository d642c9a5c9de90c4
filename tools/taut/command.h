#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>

#include "console.h"
#include "exit_code.h"

namespace taut::tool {

/// One of Taut's commands: its place in the command line, and what it does once that is parsed.
struct Command {
  CLI::App* app = nullptr;
  std::shared_ptr<CommonOptions> common;
  /// @throws UsageError and all that the toolkit throws
  std::function<ExitCode(Console&)> run;
};

/// Adds a command; the caller adds its options and sets `run`.
inline Command add_command(CLI::App& parent, const std::string& name, const std::string& what,
                           const std::string& examples) {
  Command command;
  command.app = parent.add_subcommand(name, what)->group("Commands");
  command.app->footer(examples);
  command.common = std::make_shared<CommonOptions>();
  return command;
}

Command add_envelope(CLI::App& parent);
Command add_hull(CLI::App& parent);
Command add_info(CLI::App& parent);
Command add_support(CLI::App& parent);
Command add_contains(CLI::App& parent);
Command add_verify(CLI::App& parent);
Command add_plugins(CLI::App& parent);
/// `taut help COMMAND`, of the parent's commands.
Command add_help(CLI::App& parent);

}  // namespace taut::tool
