// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/table_page.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// One figure of an experiment, in the form of results.json. Where there is no value, `reason` says
// why.
struct FigureRow {
  std::string sequence, variant;
  std::optional<int> seed;
  std::string metric;
  std::optional<double> value;
  std::string unit;
  std::string reason = {};
};

// A JSON list, one figure a line: {"experiment", "sequence", "variant", "seed", "metric", "value",
// "unit"}, null for what does not apply; where value is null, "reason".
std::string FormatFigureList(const std::string& experiment, std::span<const FigureRow> rows);

// What a metric of a list is, for the legend under its tables.
struct FigureMetric {
  std::string_view name, unit, help;
  int digits = 0;  // behind the point in tables
};

// The figures as tables: one for each first part of the sequences' names (before /), with a row for
// each sequence and variant and a column for each metric, in the order of their first figures.
// Seeds are not told apart. Every metric must be among `metrics`.
std::string FormatFigureMarkdown(const std::string& title,
                                 const std::string& help,
                                 std::span<const FigureRow> rows,
                                 std::span<const FigureMetric> metrics);

// A page of HTML that needs no other file: the tables of FormatFigureMarkdown, what a paper prints
// of the same figures, and the plots.
std::string FormatFigurePage(const std::string& title,
                             const std::string& help,
                             std::span<const FigureRow> rows,
                             std::span<const FigureMetric> metrics,
                             std::span<const PagePlot> plots,
                             const PaperComparison& comparison = {});

}  // namespace plumbline
