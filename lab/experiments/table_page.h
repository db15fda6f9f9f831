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

// The variants against their references.
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

// One page that needs nothing else, not even scripts: the tables with the best of each sequence
// marked, the errors and the starts against a reference where there is one, what a paper has, the
// plots, what the variants are, what failed and what is missing.
std::string FormatPage(const Plan& plan,
                       const std::vector<ResultTable>& tables,
                       const std::vector<PagePlot>& plots,
                       const Comparisons& against_reference = {},
                       const PaperComparison& comparison = {});

}  // namespace plumbline
