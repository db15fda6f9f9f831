// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/experiments/table.h"

#include <string>
#include <vector>

namespace plumbline {

struct PagePlot {
  std::string metric;
  std::string svg;
};

// One page that needs nothing else, not even scripts: the tables with the best of each sequence
// marked, the plots, what the variants are, what failed and what is missing.
std::string FormatPage(const Plan& plan,
                       const std::vector<ResultTable>& tables,
                       const std::vector<PagePlot>& plots);

}  // namespace plumbline
