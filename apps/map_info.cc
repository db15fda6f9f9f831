// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/io/atomic_file.h"
#include "plumbline/io/map_file/map_io.h"

#include "apps/command_line.h"
#include "apps/command_outputs.h"
#include "apps/map_commands.h"
#include "apps/map_summary.h"
#include <filesystem>
#include <iostream>
#include <span>
#include <string>

namespace plumbline {
namespace {

CommandSyntax MapInfoSyntax() {
  return {"map info",
          "Tells what is in a map file: version, camera, keyframes, points, lines, extent.",
          {"FILE"},
          {{"--json", "FILE", "write the figures as JSON"},
           {"--memory", "", "also tell what the map takes in memory, by kind of data"}}};
}

}  // namespace

int MapInfoCommand(std::span<const std::string> arguments) {
  const CommandLine line(MapInfoSyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(MapInfoSyntax());
    return 0;
  }
  const std::filesystem::path path = line.Positional(0);
  const auto json = line.Value("--json");
  const bool memory = line.Has("--memory");
  if (json) CheckOutput("--json", *json, {&path, 1}, {"JSON of map info", "{\n  \"file\": "});
  const SavedAtlas saved = LoadAtlas(path);
  if (json) {
    WriteFileAtomically(*json, MapInfoJson(line.Positional(0), saved, memory));
  }
  std::cout << MapInfoTable(line.Positional(0), saved, memory);
  return 0;
}

}  // namespace plumbline
