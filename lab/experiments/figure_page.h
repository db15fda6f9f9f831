// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/figure_list.h"
#include "lab/experiments/table_page.h"

#include <span>
#include <string>

namespace plumbline {

// The figures as tables: one for each first part of the sequences' names (before /), with a row for
// each sequence and variant and a column for each metric, in the order of their first figures.
// Seeds are not distinguished. Every metric must be among `metrics`.
std::string FormatFigureMarkdown(const std::string& title,
                                 const std::string& help,
                                 std::span<const FigureRow> rows,
                                 std::span<const FigureMetric> metrics);

// A self-contained HTML page: the tables of FormatFigureMarkdown, the same figures as printed in a
// paper, and the plots.
std::string FormatFigurePage(const std::string& title,
                             const std::string& help,
                             std::span<const FigureRow> rows,
                             std::span<const FigureMetric> metrics,
                             std::span<const PagePlot> plots,
                             const PaperComparison& comparison = {});

}  // namespace plumbline
