// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"

#include "apps/commands.h"
#include "apps/map_commands.h"
#include <array>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

namespace plumbline {
namespace {

struct MapCommandRow {
  std::string_view name;
  int (*run)(std::span<const std::string> arguments);
  std::string_view help;
};

constexpr std::array kCommands = {
    MapCommandRow{"info", MapInfoCommand, "what is in a map file"},
    MapCommandRow{"export", MapExportCommand, "a map in the form of another program"},
    MapCommandRow{"merge", MapMergeCommand, "two maps of the same camera as one"},
    MapCommandRow{"view", MapViewCommand, "a map in the browser"},
};

void PrintHelp(std::ostream& out) {
  out << "plumbline map COMMAND [arguments]\nWorks on maps that were saved (map.plb of a run).\n\n";
  for (const MapCommandRow& command : kCommands) {
    out << fmt::format("  {:<12}{}\n", command.name, command.help);
  }
  out << "\nplumbline map COMMAND --help tells more.\n";
}

const MapCommandRow& FindCommand(const std::string& name) {
  std::vector<std::string> names;
  for (const MapCommandRow& command : kCommands) {
    if (command.name == name) return command;
    names.emplace_back(command.name);
  }
  const std::optional<std::string> nearest = NearestName(name, names);
  throw InputError("map: unknown command '" + name + "'" +
                   (nearest ? "; did you mean '" + *nearest + "'?" : "; see plumbline map --help"));
}

}  // namespace

int MapCommand(std::span<const std::string> arguments) {
  if (arguments.empty()) throw InputError("map: expected a command; see plumbline map --help");
  const std::string& name = arguments.front();
  if (name == "--help" || name == "-h") {
    PrintHelp(std::cout);
    return 0;
  }
  return FindCommand(name).run(arguments.subspan(1));
}

}  // namespace plumbline
