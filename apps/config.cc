// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/options_io.h"
#include "plumbline/slam/options.h"
#include "plumbline/slam/preset.h"
#include "plumbline/slam/user_options.h"

#include "apps/command_line.h"
#include "apps/commands.h"
#include "apps/program_methods.h"
#include <iostream>
#include <span>
#include <string>

namespace plumbline {
namespace {

CommandSyntax ConfigSyntax() {
  return {"config",
          "Prints the options of a run that users set, and those that differ from their defaults, "
          "with\n"
          "values, units and ranges. The output is a valid config file.",
          {},
          {{"--all",
            "",
            "all options, also those of the methods, whose defaults are measured, and of the "
            "papers"},
           {"--preset", "NAME", "begin with the options of a paper: rippl, good-line-cutting"},
           {"--config", "FILE", "read options from a YAML file; may be repeated, later files win"},
           {"--set", "KEY=VALUE", "set one option, after all files; may be repeated"}}};
}

}  // namespace

int ConfigCommand(std::span<const std::string> arguments) {
  const CommandLine line(ConfigSyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(ConfigSyntax());
    return 0;
  }
  SlamOptions options;
  OptionTable table(options, ProgramMethods().added);
  if (const auto name = line.Value("--preset")) LoadPreset(*name, table);
  for (const std::string& file : line.Values("--config")) table.LoadFile(file);
  for (const std::string& setting : line.Values("--set")) table.Set(setting);
  if (line.Has("--all")) {
    std::cout << ListOptions(table);
    return 0;
  }
  SlamOptions unchanged;
  const OptionTable defaults(unchanged);
  std::cout << table.Dump([&](const OptionField& field) {
    return TierOf(field.key) == OptionTier::kUser ||
           OptionTable::ValueOf(field) != defaults.Value(field.key);
  });
  return 0;
}

}  // namespace plumbline
