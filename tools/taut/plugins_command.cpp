#include <vector>

#include "command.h"
#include "input.h"
#include "taut/io/text/formats.h"
#include "text.h"

namespace taut::tool {
namespace {

ExitCode list_plugins(Console& console) {
  if (console.options().json) {
    Json list = Json::array();
    for (const Format& format : formats()) {
      list.push_back({{"extension", format.extension},
                      {"description", format.description},
                      {"reads_model", format.reads_model},
                      {"reads_mesh", format.reads_mesh},
                      {"writes_mesh", format.writes_mesh},
                      {"reads_hull", format.reads_hull},
                      {"writes_hull", format.writes_hull}});
    }
    console.print(
        text(Json{{"taut", TAUT_VERSION}, {"formats", list}, {"plugins", Json::array()}}));
    return ExitCode::done;
  }
  std::string table;
  for (const Format& format : formats()) {
    std::vector<std::string> uses;
    if (format.reads_model) uses.emplace_back("reads models");
    if (format.reads_mesh) uses.emplace_back("reads meshes");
    if (format.writes_mesh) uses.emplace_back("writes meshes");
    if (format.reads_hull) uses.emplace_back("reads hulls");
    if (format.writes_hull) uses.emplace_back("writes hulls");
    table += padded(format.extension, 12) + padded(joined(uses), 44) + format.description + "\n";
  }
  console.print(table + "no plugins\n");
  return ExitCode::done;
}

}  // namespace

Command add_plugins(CLI::App& parent) {
  Command command = add_command(parent, "plugins", "Lists the formats and plugins at hand",
                                "Examples:\n"
                                "  taut plugins\n"
                                "  taut plugins --json");
  command.run = list_plugins;
  return command;
}

}  // namespace taut::tool
