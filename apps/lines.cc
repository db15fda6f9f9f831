// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/line_maps/line_map_error.h"
#include "lab/line_maps/line_map_figure.h"
#include "lab/line_maps/line_map_report.h"
#include "lab/line_maps/run_line_map.h"
#include "plumbline/base/error.h"
#include "plumbline/io/atomic_file.h"

#include "apps/command_line.h"
#include "apps/commands.h"
#include "apps/evaluate_outputs.h"
#include "apps/figure_file.h"
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <vector>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

CommandSyntax LinesSyntax() {
  return {
      "lines",
      "Compares the lines of a run with those of the known world that its sequence shows: "
      "lines.csv (and\nsurfaces.csv) in SEQUENCE with lines.obj in RUN.",
      {"SEQUENCE", "RUN"},
      {{"--lines", "FILE", "other lines of the run, .obj or .plb (lines.obj of RUN)"},
       {"--json", "FILE|-", "write the figures as JSON; -: to standard output, and nothing else"},
       {"--plot", "FILE", "draw true and estimated lines, .svg or .png"}}};
}

// Throws InputError unless the folder has the file.
void CheckHas(const fs::path& folder, const char* name, const char* purpose) {
  std::error_code error;
  if (fs::is_regular_file(folder / name, error)) return;
  throw InputError(folder.string() + ": expected " + name + purpose + ", found none");
}

}  // namespace

int LinesCommand(std::span<const std::string> arguments) {
  const CommandLine line(LinesSyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(LinesSyntax());
    return 0;
  }
  const fs::path sequence = line.Positional(0), run = line.Positional(1);
  const fs::path file = line.Value("--lines").value_or((run / "lines.obj").string());
  const EvaluateOutputs outputs = ReadOutputs(line, {});
  CheckOutputs(outputs, sequence, {file});
  CheckHas(sequence, "lines.csv", " with the true lines of the world");
  CheckHas(run, "trajectory.txt", " of the run whose lines are compared");
  const std::optional<RunLineMap> map = ReadRunLineMap(sequence, run, file);
  if (!map) {
    throw InputError(sequence.string() + ": expected ground truth of poses in " +
                     (run / "trajectory.txt").string() + ", found none");
  }
  LineMapErrorOptions options;
  options.viewers = map->viewers;
  const LineMapError error = CompareLineMaps(map->truth, map->lines, map->surfaces, options);
  const std::string json = LineMapJson(error, options);
  std::vector<FileContents> files;
  if (outputs.json) files.push_back({*outputs.json, json});
  if (outputs.plot) {
    const Figure figure = LineMapFigure(map->truth, map->lines, error, map->trajectory.poses);
    files.push_back({*outputs.plot, FigureBytes(*outputs.plot, figure)});
  }
  WriteOutputs(outputs, files);
  std::cout << (outputs.json_to_stdout ? json : LineMapTable(error, options));
  return 0;
}

}  // namespace plumbline
