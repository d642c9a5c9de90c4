#include <algorithm>
#include <string>
#include <vector>

#include "command.h"
#include "text.h"

namespace taut::tool {
namespace {

ExitCode print_help(const CLI::App& parent, const std::string& name, Console& console) {
  if (name.empty()) {
    // Its own help() is that of the command at work, this one.
    console.print(
        parent.get_formatter()->make_help(&parent, parent.get_name(), CLI::AppFormatMode::Normal));
    return ExitCode::done;
  }
  std::vector<std::string> names;
  for (const CLI::App* command : parent.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
    if (names.back() != name) continue;
    console.print(command->help(parent.get_name()));
    return ExitCode::done;
  }
  throw UsageError("there is no command '" + name + "'; commands are " + joined(names));
}

}  // namespace

Command add_help(CLI::App& parent) {
  Command command = add_command(parent, "help", "Tells how a command is used",
                                "Examples:\n"
                                "  taut help           the commands\n"
                                "  taut help hull      the options of one");
  const auto name = std::make_shared<std::string>();
  command.app->add_option("COMMAND", *name, "Of which; default: of all")->option_text("NAME");
  command.run = [name, &parent](Console& console) { return print_help(parent, *name, console); };
  return command;
}

}  // namespace taut::tool
