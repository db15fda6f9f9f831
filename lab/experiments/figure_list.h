// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace plumbline {

// One figure of an experiment, in the form of results.json. Without a value, `reason` is set.
struct FigureRow {
  std::string sequence, variant;
  std::optional<int> seed;
  std::string metric;
  std::optional<double> value;
  std::string unit;
  std::string reason = {};
};

// Description of a metric of a list, for the legend under its tables.
struct FigureMetric {
  std::string_view name, unit, help;
  int digits = 0;  // decimals in tables
};

// A JSON list, one figure a line: {"experiment", "sequence", "variant", "seed", "metric", "value",
// "unit"}, null for inapplicable entries; if value is null, "reason".
std::string FormatFigureList(const std::string& experiment, std::span<const FigureRow> rows);

}  // namespace plumbline
