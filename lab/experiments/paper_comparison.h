// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/plan.h"
#include "lab/experiments/printed_figures.h"
#include "lab/experiments/table.h"

#include <string>
#include <vector>

namespace plumbline {

// A printed table with our figures beside it, in the unit of our metric.
struct ComparedTable {
  std::string title;  // "ate [mm]: Lee and Hwang, ICCV 2019, Table 1, page 7"
  std::string note;   // may be empty
  std::string metric;
  std::vector<std::string> variants;
  struct Row {
    std::string sequence;
    std::vector<std::string> printed, ours;  // one for each variant; empty: no figures of that kind
    std::string runs;  // of ours: RunsText, by variant if they differ; or the command to call
  };
  // The rows of the paper first, with "-" and the command to fill them if the sequence is missing;
  // then our other sequences.
  std::vector<Row> rows;
};

struct PaperComparison {
  std::vector<ComparedTable> tables;
  std::vector<PrintedStatement> statements;
};

// Returns the printed figures of the plan's experiment beside those of its runs; empty if no paper
// is reproduced. A sequence that is a part of the paper's is named so: its figures are not those of
// the whole.
PaperComparison CompareWithPaper(const Plan& plan, const ResultTable& table);

// Headings of the columns of a table, and cells of a row.
std::vector<std::string> ComparisonHeader(const ComparedTable& table);
std::vector<std::string> ComparisonCells(const ComparedTable& table, const ComparedTable::Row& row);

// Sections for the documents of results.h; empty for none.
std::string FormatComparisonMarkdown(const PaperComparison& comparison);
std::string FormatComparisonHtml(const PaperComparison& comparison);

}  // namespace plumbline
