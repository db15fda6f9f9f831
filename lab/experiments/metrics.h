// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

enum class Better { kLower, kHigher, kNeither };

// A figure of a run.
struct Metric {
  std::string_view name;  // "ate"
  std::string_view unit;  // "mm"
  std::string_view help;  // "position error, RMSE after alignment"
  Better better = Better::kNeither;
  // Differs from run to run of the same bytes: times, memory, frames that were too late.
  bool timing = false;
  int digits = 0;  // behind the point in tables
};

// The metrics there are. A new one is a row of the table in metrics.cc.
std::span<const Metric> Metrics();

// nullptr for an unknown name.
const Metric* FindMetric(std::string_view name);

// What is known of one run.
struct RunFigures {
  std::map<std::string, double, std::less<>> values;        // by name of the metric
  std::map<std::string, std::string, std::less<>> reasons;  // why others have none
  // The bytes of trajectory.txt or starts.csv, to tell whether two runs are the same.
  std::string trajectory;
};

// The figures of a run from the files in its folder (summary.json; trajectory.txt or starts.csv);
// nullopt where summary.json is missing, not whole, or not the summary of a run or of starts: its
// version, frames and times, or the counts of its starts, are missing or cannot be; or the run was
// interrupted.
std::optional<RunFigures> ReadFigures(const std::filesystem::path& folder);

}  // namespace plumbline
