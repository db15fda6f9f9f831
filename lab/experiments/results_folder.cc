// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/results_folder.h"

#include "lab/experiments/figure_list.h"
#include "plumbline/base/error.h"
#include "plumbline/base/input_file.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kResults = "results.json";

// Whether an experiment wrote the tables of a folder: its results.json begins as ours do.
bool HasResults(const fs::path& out) {
  const std::string list = FormatFigureList("", std::vector<FigureRow>(1));
  const std::string first_key = list.substr(0, list.find(':'));
  return FileBeginsWith(out / kResults, first_key) || FileBeginsWith(out / kResults, "[\n]") ||
         FileBeginsWith(out / kResults, "[\n\n]");
}

// The first plot by name; nullopt: there is none.
std::optional<fs::path> PlotIn(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> plots;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".svg") plots.push_back(entry.path());
  }
  if (plots.empty()) return std::nullopt;
  return *std::min_element(plots.begin(), plots.end());
}

// A file that the tables would replace.
std::optional<fs::path> FileInTheWay(const fs::path& out) {
  constexpr std::array kNames = {kResults,
                                 "table.md",
                                 "table.html",
                                 "timing.json",
                                 "timing.md",
                                 "ratios.json",
                                 "starts.csv",
                                 "gate.md"};
  for (const char* name : kNames) {
    std::error_code error;
    if (fs::exists(fs::symlink_status(out / name, error))) return out / name;
  }
  return PlotIn(out / "plots");
}

}  // namespace

void CheckResultsFolder(const fs::path& out) {
  if (HasResults(out)) return;
  const auto file = FileInTheWay(out);
  if (!file) return;
  throw InputError(file->string() +
                   ": not written by an earlier experiment, and this one would replace it; move it "
                   "away or choose another --out");
}

}  // namespace plumbline
