// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/paired_ratios.h"
#include "lab/experiments/paired_starts.h"
#include "lab/experiments/paper_comparison.h"
#include "lab/experiments/table.h"

#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

// Comparison of the variants with their references.
struct Comparisons {
  std::vector<PairedRatio> ratios;
  std::vector<PairedStarts> starts = {};  // of RunCommandKind::kStarts
};

struct PagePlot {
  std::string metric;
  std::string svg;
};

// The style sheet of all pages of experiments.
std::string_view TablePageStyle();

// A self-contained page, without scripts: the tables with the best of each sequence marked, the
// errors and the starts against a reference if there is one, the figures of a paper, the plots, a
// description of the variants, failed and missing runs.
std::string FormatPage(const Plan& plan,
                       const std::vector<ResultTable>& tables,
                       const std::vector<PagePlot>& plots,
                       const Comparisons& against_reference = {},
                       const PaperComparison& comparison = {});

}  // namespace plumbline
