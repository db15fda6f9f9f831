// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/results_folder.h"

#include "lab/experiments/figure_list.h"
#include "plumbline/base/input_file.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kResults = "results.json";

// Returns true if an experiment wrote the tables of a folder, by the beginning of its results.json.
bool HasResults(const fs::path& out) {
  const std::string list = FormatFigureList("", std::vector<FigureRow>(1));
  const std::string first_key = list.substr(0, list.find(':'));
  return FileBeginsWith(out / kResults, first_key) || FileBeginsWith(out / kResults, "[\n]") ||
         FileBeginsWith(out / kResults, "[\n\n]");
}

// Returns true if the tables have a file of this name.
bool IsTable(const std::string& name) {
  constexpr std::array kNames = {kResults,
                                 "table.md",
                                 "table.html",
                                 "table.json",
                                 "timing.json",
                                 "timing_table.json",
                                 "timing.md",
                                 "ratios.json",
                                 "starts.csv",
                                 "gate.md"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

bool IsPlot(const std::string& name) { return fs::path(name).extension() == ".svg"; }

}  // namespace

void CheckResultsFolder(const fs::path& out) {
  if (HasResults(out)) return;
  RefuseForeignFiles(out, "experiment", IsTable);
  RefuseForeignFiles(out / "plots", "experiment", IsPlot);
}

}  // namespace plumbline
