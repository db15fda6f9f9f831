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
  // True if it differs between runs with the same bytes: times, memory, late frames.
  bool timing = false;
  int digits = 0;  // decimals in tables
};

// All metrics. A new one is a row of the table in metrics.cc.
std::span<const Metric> Metrics();

// nullptr for an unknown name.
const Metric* FindMetric(std::string_view name);

// Figures of one run.
struct RunFigures {
  std::map<std::string, double, std::less<>> values;        // by name of the metric
  std::map<std::string, std::string, std::less<>> reasons;  // reasons why others have none
  // The bytes of trajectory.txt or starts.csv, to detect equal runs.
  std::string trajectory;
};

// Returns the figures of a run from the files in its folder (summary.json; trajectory.txt or
// starts.csv); nullopt if summary.json is missing, incomplete, or not the summary of a run or of
// starts (its version, frames and times, or the counts of its starts, are missing or impossible),
// or if the run was interrupted.
std::optional<RunFigures> ReadFigures(const std::filesystem::path& folder);

}  // namespace plumbline
